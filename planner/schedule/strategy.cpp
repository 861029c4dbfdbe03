#include "planner/schedule/strategy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace drapeplan {
namespace {

constexpr double kTicksPerSecond =
    1e4;  // times of knots are multiples of 0.1 ms, finer than a controller's cycle
constexpr double kTicksPerMetre = 1e6;  // heights are multiples of 1 um

double round_time(double t) {
  return std::round(t * kTicksPerSecond) / kTicksPerSecond;
}
double round_time_up(double t) {
  return std::ceil(t * kTicksPerSecond - 1e-6) / kTicksPerSecond;
}
double round_height(double z) {
  return std::round(z * kTicksPerMetre) / kTicksPerMetre;
}

Eigen::Vector2d rounded(const Eigen::Vector2d& place) {
  return {round_height(place.x()), round_height(place.y())};
}

double distance_in_spacings(const WaveParameters& wave, const Eigen::Vector2d& place, double spacing) {
  const Eigen::Vector2d apart = (place - wave.start) / spacing;
  const double chebyshev = apart.lpNorm<Eigen::Infinity>();
  if (wave.distance == WaveDistance::rings) return std::round(chebyshev);
  return (1 - wave.roundness) * chebyshev + wave.roundness * apart.norm();
}

/// Largest velocity of a joint [m/s]: a change of velocity is spread over the blend time, and is at most from
/// one direction to the other.
double largest_velocity(const RigOptions& rig) {
  if (!rig.max_acceleration) return rig.max_velocity;
  return std::min(rig.max_velocity, 0.5 * *rig.max_acceleration * rig.blend_time);
}

/// Where a gripper is at the end of the preshape, over its target [m].
double preshape_height(const SequenceFrame& frame, const Stroke& stroke) {
  return std::max(stroke.height, -frame.options.overtravel);
}

double preshape_duration(const SequenceFrame& frame, const Strokes& strokes) {
  double slowest = 0;  // its velocity if the preshape took one second [m/s]
  for (size_t g = 0; g < frame.target_z.size(); ++g) {
    const double way = std::abs(frame.start_z() - frame.target_z[g] - preshape_height(frame, strokes[g]));
    slowest = std::max(slowest, way / (1 - strokes[g].leave));
  }
  for (size_t g = 0; g < frame.target_xy.size(); ++g)
    slowest = std::max(slowest, (frame.target_xy[g] - frame.start_xy[g]).norm());
  return round_time_up(std::max(frame.options.preshape_duration, slowest / largest_velocity(frame.rig)));
}

/// Shortest time of a stroke [s]: its faster half at the largest velocity.
double fastest_stroke(const SequenceFrame& frame, const Stroke& stroke) {
  const double way = preshape_height(frame, stroke) + frame.options.overtravel;
  return 2 * std::max(stroke.bend, 1 - stroke.bend) * way / largest_velocity(frame.rig);
}

/// A knot at the same time as the one before replaces it; times stay strictly increasing.
void add_knot(std::vector<Knot>& path, double time, double z) {
  const double t = round_time(time);
  if (!path.empty() && t <= path.back().time) {
    path.back().z = z;
  } else {
    path.push_back({t, z});
  }
}

}  // namespace

double SequenceFrame::start_z() const {
  double highest = target_z.empty() ? 0 : target_z.front();
  for (const double z : target_z) highest = std::max(highest, z);
  return highest + options.preshape_height;
}

Strokes uniform_strokes(const SequenceFrame& frame) {
  return {frame.target_z.size(),
          Stroke{.duration = frame.options.uniform_duration, .height = frame.options.preshape_height}};
}

WaveParameters baseline_wave(const SequenceFrame& frame) {
  const ScheduleOptions& o = frame.options;
  WaveParameters wave;
  wave.start = o.wave_start;
  wave.delay = o.wave_delay + (o.wave_delay_from == DelayFrom::end ? o.wave_duration : 0);
  wave.duration = o.wave_duration;
  wave.preshape_height = o.preshape_height;
  return wave;
}

Strokes wave_strokes(const SequenceFrame& frame) {
  return wave_strokes(frame, baseline_wave(frame));
}

Strokes wave_strokes(const SequenceFrame& frame, const WaveParameters& wave) {
  Strokes strokes;
  for (int g = 0; g < int(frame.target_z.size()); ++g) {
    const double distance = distance_in_spacings(wave, frame.rig.place(g), frame.rig.spacing);
    strokes.push_back(
        {.start = wave.delay * distance, .duration = wave.duration, .height = wave.preshape_height});
  }
  shift_to_gauge(strokes);
  return strokes;
}

void shift_to_gauge(Strokes& strokes) {
  double first = std::numeric_limits<double>::infinity();
  for (const Stroke& stroke : strokes) first = std::min(first, stroke.start);
  for (Stroke& stroke : strokes) stroke.start -= first;
}

Schedule to_schedule(const SequenceFrame& frame, const Strokes& strokes) {
  const double top = round_height(frame.start_z()), preshaped = preshape_duration(frame, strokes);
  std::vector<double> start, end;
  double last = preshaped;
  for (const Stroke& stroke : strokes) {
    start.push_back(round_time(preshaped + stroke.start));
    end.push_back(start.back() + round_time_up(std::max(stroke.duration, fastest_stroke(frame, stroke))));
    if (preshape_height(frame, stroke) > -frame.options.overtravel) last = std::max(last, end.back());
  }
  Schedule schedule;
  schedule.blend_time = frame.rig.blend_time;
  for (size_t g = 0; g < strokes.size(); ++g) {
    const double above = preshape_height(frame, strokes[g]), way = above + frame.options.overtravel;
    const double high = round_height(frame.target_z[g] + above);
    const double low = round_height(frame.target_z[g] - frame.options.overtravel);
    std::vector<Knot> path;
    add_knot(path, 0, top);
    add_knot(path, strokes[g].leave * preshaped, top);
    add_knot(path, preshaped, high);
    if (way > 0) {
      add_knot(path, start[g], high);
      if (strokes[g].bend != 0.5)
        add_knot(path, 0.5 * (start[g] + end[g]),
                 round_height(frame.target_z[g] + above - strokes[g].bend * way));
      add_knot(path, end[g], low);
    }
    add_knot(path, last + frame.options.settle, low);
    schedule.paths.push_back(std::move(path));
  }
  for (size_t g = 0; g < frame.target_xy.size(); ++g) {
    schedule.plane_paths.push_back(
        {{0, rounded(frame.start_xy[g])}, {preshaped, rounded(frame.target_xy[g])}});
  }
  if (frame.rig.release_time)
    schedule.release.assign(schedule.paths.size(), round_time(last + *frame.rig.release_time));
  let_go_pressed(frame.press, schedule);
  return schedule;
}

void let_go_pressed(const std::optional<PressOptions>& press, Schedule& schedule) {
  if (!press || press->pads == PressOptions::Pads::held) return;
  const double full = round_time(press_times(press->load, &schedule, schedule.duration()).full);
  schedule.release.resize(schedule.paths.size());
  for (auto& time : schedule.release) time = std::min(time.value_or(full), full);
}

bool nearly_equal(const Schedule& a, const Schedule& b) {
  constexpr double kTime = 0.05, kHeight = 0.001;  // [s], [m]
  for (size_t g = 0; g < a.paths.size(); ++g) {
    if (a.paths[g].size() != b.paths[g].size()) return false;
    for (size_t k = 0; k < a.paths[g].size(); ++k) {
      if (std::abs(a.paths[g][k].time - b.paths[g][k].time) > kTime) return false;
      if (std::abs(a.paths[g][k].z - b.paths[g][k].z) > kHeight) return false;
    }
  }
  return true;
}

std::string stretched(const SequenceFrame& frame, const Strokes& strokes) {
  const double preshaped = preshape_duration(frame, strokes), longest = largest_velocity(frame.rig);
  double fastest = 0;  // of those that are stretched [s]
  int count = 0;
  for (const Stroke& stroke : strokes) {
    const double least = fastest_stroke(frame, stroke);
    if (!(stroke.duration < least - 1 / kTicksPerSecond)) continue;
    fastest = std::max(fastest, least);
    ++count;
  }
  std::string text;
  if (preshaped > frame.options.preshape_duration + 1 / kTicksPerSecond) {
    text = fmt::format("the preshape takes {:.3f} s instead of {:.3f} s", preshaped,
                       frame.options.preshape_duration);
  }
  if (count > 0) {
    text +=
        fmt::format("{}{} strokes take {:.3f} s instead of less", text.empty() ? "" : "; ", count, fastest);
  }
  if (text.empty()) return text;
  return text + fmt::format(" at the largest velocity of {:.3f} m/s", longest);
}

}  // namespace drapeplan
