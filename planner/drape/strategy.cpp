#include "planner/drape/strategy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drapeplan {
namespace {

constexpr double kTicksPerSecond =
    1e4;  // times of knots are multiples of 0.1 ms, finer than a controller's cycle
constexpr double kTicksPerMetre = 1e6;  // heights are multiples of 1 um
constexpr double kLowestPreshape =
    0.25;  // of the frame's height: below it the ply touches the mold in the preshape
constexpr double kStrokeFactor = 4;  // largest change of all durations together around a base

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

double unit(double x) {
  return std::clamp(x, 0.0, 1.0);
}
double linear(double x, double low, double high) {
  return low + unit(x) * (high - low);
}
double logarithmic(double x, double low, double high) {
  return low * std::pow(high / low, unit(x));
}
double inverse_linear(double value, double low, double high) {
  return high > low ? unit((value - low) / (high - low)) : 0;
}
double inverse_logarithmic(double value, double low, double high) {
  return high > low ? unit(std::log(value / low) / std::log(high / low)) : 0;
}

/// Half the size of the grid plus one spacing: the wave's start point stays within [m].
Eigen::Vector2d reach_of_start(const RigOptions& rig) {
  return 0.5 * rig.spacing * Eigen::Vector2d(rig.columns + 1, rig.rows + 1);
}

double distance_in_spacings(const WaveParameters& wave, const Eigen::Vector2d& place, double spacing) {
  const Eigen::Vector2d apart = (place - wave.start) / spacing;
  const double chebyshev = apart.lpNorm<Eigen::Infinity>();
  if (wave.distance == WaveDistance::rings) return std::round(chebyshev);
  return (1 - wave.roundness) * chebyshev + wave.roundness * apart.norm();
}

void shift_to_gauge(Strokes& strokes) {
  if (strokes.start.empty()) return;
  const double first = *std::min_element(strokes.start.begin(), strokes.start.end());
  for (double& start : strokes.start) start -= first;
}

double preshape_duration(const SequenceFrame& frame, double preshape_height) {
  double drop = 0;  // or the longest way in-plane
  for (const double z : frame.target_z) drop = std::max(drop, frame.start_z() - z - preshape_height);
  for (size_t g = 0; g < frame.target_xy.size(); ++g)
    drop = std::max(drop, (frame.target_xy[g] - frame.start_xy[g]).norm());
  return round_time_up(std::max(frame.options.preshape_duration, drop / frame.rig.max_velocity));
}

double fastest_stroke(const SequenceFrame& frame, double preshape_height) {
  return (preshape_height + frame.options.overtravel) / frame.rig.max_velocity;
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
  const size_t n = frame.target_z.size();
  return {std::vector<double>(n, 0.0), std::vector<double>(n, frame.options.uniform_duration),
          frame.options.preshape_height};
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
  strokes.preshape_height = wave.preshape_height;
  for (int g = 0; g < int(frame.target_z.size()); ++g) {
    strokes.start.push_back(wave.delay * distance_in_spacings(wave, frame.rig.place(g), frame.rig.spacing));
    strokes.duration.push_back(wave.duration);
  }
  shift_to_gauge(strokes);
  return strokes;
}

Schedule to_schedule(const SequenceFrame& frame, const Strokes& strokes) {
  const double top = frame.start_z();
  const double height = std::min(strokes.preshape_height, frame.options.preshape_height);
  const double preshaped = preshape_duration(frame, height);
  std::vector<double> start, end;
  double last = 0;
  for (size_t g = 0; g < frame.target_z.size(); ++g) {
    const double stroke = std::max(strokes.duration[g], fastest_stroke(frame, height));
    start.push_back(round_time(preshaped + strokes.start[g]));
    end.push_back(start.back() + round_time_up(stroke));
    last = std::max(last, end.back());
  }
  Schedule schedule;
  schedule.blend_time = frame.rig.blend_time;
  for (size_t g = 0; g < frame.target_z.size(); ++g) {
    const double target = frame.target_z[g];
    std::vector<Knot> path;
    add_knot(path, 0, round_height(top));
    add_knot(path, preshaped, round_height(target + height));
    add_knot(path, start[g], round_height(target + height));
    add_knot(path, end[g], round_height(target - frame.options.overtravel));
    add_knot(path, last + frame.options.settle, round_height(target - frame.options.overtravel));
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

std::string stretched(const SequenceFrame& frame, const Strokes& strokes) {
  const double height = std::min(strokes.preshape_height, frame.options.preshape_height);
  const double preshaped = preshape_duration(frame, height);
  const double fastest = fastest_stroke(frame, height);
  const auto count = std::count_if(strokes.duration.begin(), strokes.duration.end(),
                                   [&](double d) { return d < fastest - 1 / kTicksPerSecond; });
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
  return text + fmt::format(" at the largest velocity of {:.3f} m/s", frame.rig.max_velocity);
}

WaveFamily::WaveFamily(SequenceFrame frame) : frame_(std::move(frame)) {
  const int along = std::max({frame_.rig.columns, frame_.rig.rows, 2});
  longest_delay_ = std::max(0.0, frame_.longest_sequence - frame_.shortest_stroke) / (along - 1);
}

Strokes WaveFamily::decode(const Eigen::VectorXd& x) const {
  const Eigen::Vector2d reach = reach_of_start(frame_.rig);
  WaveParameters wave;
  wave.start = {linear(x[0], -reach[0], reach[0]), linear(x[1], -reach[1], reach[1])};
  wave.delay = longest_delay_ * unit(x[2]) * unit(x[2]);
  wave.duration = logarithmic(x[3], frame_.shortest_stroke, frame_.longest_sequence);
  wave.preshape_height = frame_.options.preshape_height * logarithmic(x[4], kLowestPreshape, 1);
  wave.distance = WaveDistance::blended;
  wave.roundness = unit(x[5]);
  Strokes strokes = wave_strokes(frame_, wave);
  const double last = *std::max_element(strokes.start.begin(), strokes.start.end());
  const double room = frame_.longest_sequence - wave.duration;
  if (last > room) {
    for (double& start : strokes.start) start *= room / last;
  }
  return strokes;
}

Eigen::VectorXd WaveFamily::encode(const WaveParameters& wave) const {
  const Eigen::Vector2d reach = reach_of_start(frame_.rig);
  Eigen::VectorXd x(kDimension);
  x << inverse_linear(wave.start[0], -reach[0], reach[0]), inverse_linear(wave.start[1], -reach[1], reach[1]),
      std::sqrt(inverse_linear(wave.delay, 0, longest_delay_)),
      inverse_logarithmic(wave.duration, frame_.shortest_stroke, frame_.longest_sequence),
      inverse_logarithmic(wave.preshape_height / frame_.options.preshape_height, kLowestPreshape, 1),
      wave.distance == WaveDistance::rings ? 0 : unit(wave.roundness);
  return x;
}

GripperFamily::GripperFamily(SequenceFrame frame, Strokes base)
    : frame_(std::move(frame)), base_(std::move(base)) {}

int GripperFamily::dimension() const {
  return int(base_.start.size()) + 1;
}

Strokes GripperFamily::decode(const Eigen::VectorXd& x) const {
  const auto n = Eigen::Index(base_.start.size());
  Strokes strokes = base_;
  for (Eigen::Index g = 0; g < n; ++g) {
    double& duration = strokes.duration[size_t(g)];
    duration *= logarithmic(x[n], 1 / kStrokeFactor, kStrokeFactor);
    duration = std::clamp(duration, frame_.shortest_stroke, frame_.longest_sequence);
    strokes.start[size_t(g)] = std::min(linear(x[g], 0, frame_.longest_sequence - frame_.shortest_stroke),
                                        frame_.longest_sequence - duration);
  }
  shift_to_gauge(strokes);
  return strokes;
}

Eigen::VectorXd GripperFamily::encode_base() const {
  const auto n = Eigen::Index(base_.start.size());
  Eigen::VectorXd x(dimension());
  for (Eigen::Index g = 0; g < n; ++g)
    x[g] = inverse_linear(base_.start[size_t(g)], 0, frame_.longest_sequence - frame_.shortest_stroke);
  x[n] = 0.5;  // the logarithmic middle: a factor of 1
  return x;
}

}  // namespace drapeplan
