#include "planner/schedule/families.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

namespace drapeplan {
namespace {

/// Of the frame's preshape height: a wave that comes lower touches the mold in the preshape.
constexpr double kLowestPreshape = 0.25;
/// Share of a stroke's way after half of its time: from nearly waiting to nearly down.
constexpr double kLeastBend = 0.1;
/// Share of the preshape: a gripper that leaves later would have to hurry.
constexpr double kLatestLeave = 0.5;
constexpr int kSmoothDegree = 3;

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

double legendre(int degree, double x) {
  switch (degree) {
    case 0:
      return 1;
    case 1:
      return x;
    case 2:
      return 0.5 * (3 * x * x - 1);
    default:
      return 0.5 * (5 * x * x - 3) * x;
  }
}

/// Index from 0 to count - 1 as a coordinate from -1 to 1; 0 if there is one only.
double centred(int index, int count) {
  return count > 1 ? 2.0 * index / (count - 1) - 1 : 0;
}

/// One column per number; a line of grippers has no polynomial of more degrees than it has grippers.
Eigen::MatrixXd basis_of(const RigOptions& rig, Spread spread) {
  if (spread == Spread::each) return Eigen::MatrixXd::Identity(rig.count(), rig.count());
  std::vector<Eigen::VectorXd> columns;
  for (int i = 0; i <= std::min(kSmoothDegree, rig.columns - 1); ++i) {
    for (int j = 0; j <= std::min(kSmoothDegree - i, rig.rows - 1); ++j) {
      Eigen::VectorXd column(rig.count());
      for (int g = 0; g < rig.count(); ++g) {
        column[g] = legendre(i, centred(g % rig.columns, rig.columns)) *
                    legendre(j, centred(g / rig.columns, rig.rows));
      }
      columns.push_back(std::move(column));
    }
  }
  Eigen::MatrixXd basis(rig.count(), Eigen::Index(columns.size()));
  for (size_t k = 0; k < columns.size(); ++k) basis.col(Eigen::Index(k)) = columns[k];
  return basis;
}

}  // namespace

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
  double last = 0;
  for (const Stroke& stroke : strokes) last = std::max(last, stroke.start);
  const double room = std::max(frame_.longest_sequence - wave.duration, 0.0);
  if (last > room && last > 0) {
    for (Stroke& stroke : strokes) stroke.start *= room / last;
  }
  return strokes;
}

Eigen::VectorXd WaveFamily::encode(const WaveParameters& wave) const {
  const Eigen::Vector2d reach = reach_of_start(frame_.rig);
  const double highest = frame_.options.preshape_height;
  const double share = highest > 0 ? wave.preshape_height / highest : 1;
  Eigen::VectorXd x(kDimension);
  x << inverse_linear(wave.start[0], -reach[0], reach[0]), inverse_linear(wave.start[1], -reach[1], reach[1]),
      std::sqrt(inverse_linear(wave.delay, 0, longest_delay_)),
      inverse_logarithmic(wave.duration, frame_.shortest_stroke, frame_.longest_sequence),
      inverse_logarithmic(share, kLowestPreshape, 1),
      wave.distance == WaveDistance::rings ? 0 : unit(wave.roundness);
  return x;
}

std::vector<Eigen::VectorXd> WaveFamily::spread() const {
  const Eigen::Vector2d corner =
      0.5 * frame_.rig.spacing * Eigen::Vector2d(frame_.rig.columns - 1, frame_.rig.rows - 1);
  std::vector<Eigen::VectorXd> members;
  const auto add = [&](double u, double v, double delay_factor) {
    WaveParameters wave = baseline_wave(frame_);
    wave.start = Eigen::Vector2d(u * corner[0], v * corner[1]);
    wave.delay *= delay_factor;
    members.push_back(encode(wave));
  };
  for (const double v : {-1.0, 1.0}) {
    for (const double u : {-1.0, 1.0}) add(u, v, 1);
  }
  for (const double side : {-1.0, 1.0}) add(side, 0, 1);
  for (const double side : {-1.0, 1.0}) add(0, side, 1);
  add(0, 0, 3);  // the next group starts when the one before is nearly down
  return members;
}

StrokeFamily::StrokeFamily(SequenceFrame frame, const StrokeSpreads& spreads) : frame_(std::move(frame)) {
  const ScheduleOptions& o = frame_.options;
  const auto add = [&](double Stroke::*value, std::optional<Spread> spread, double low, double high) {
    if (!spread) return;
    const Eigen::MatrixXd basis = basis_of(frame_.rig, *spread);
    const bool each = *spread == Spread::each;
    parts_.push_back(
        {value, low, high, basis, each ? basis : basis.completeOrthogonalDecomposition().pseudoInverse()});
    dimension_ += int(parts_.back().basis.cols());
  };
  add(&Stroke::start, spreads.start, 0, std::max(0.0, frame_.longest_sequence - frame_.shortest_stroke));
  add(&Stroke::height, spreads.height, -o.overtravel, 2 * o.preshape_height + o.overtravel);
  add(&Stroke::bend, spreads.bend, kLeastBend, 1 - kLeastBend);
  add(&Stroke::leave, spreads.leave, 0, kLatestLeave);
}

Strokes StrokeFamily::decode(const Eigen::VectorXd& x) const {
  const double duration = logarithmic(x[dimension_ - 1], frame_.shortest_stroke, frame_.longest_sequence);
  Strokes strokes(frame_.target_z.size(),
                  Stroke{.duration = duration, .height = frame_.options.preshape_height});
  Eigen::Index first = 0;
  for (const Part& part : parts_) {
    const Eigen::VectorXd own = x.segment(first, part.basis.cols()).unaryExpr(&unit);
    const Eigen::VectorXd values = (part.basis * (own.array() - 0.5).matrix()).array() + 0.5;
    for (size_t g = 0; g < strokes.size(); ++g)
      strokes[g].*part.value = linear(values[Eigen::Index(g)], part.low, part.high);
    first += part.basis.cols();
  }
  for (Stroke& stroke : strokes) stroke.start = std::min(stroke.start, frame_.longest_sequence - duration);
  shift_to_gauge(strokes);
  return strokes;
}

Eigen::VectorXd StrokeFamily::encode(const Strokes& strokes) const {
  Eigen::VectorXd x(dimension_);
  Eigen::Index first = 0;
  for (const Part& part : parts_) {
    Eigen::VectorXd values(part.basis.rows());
    for (size_t g = 0; g < strokes.size(); ++g)
      values[Eigen::Index(g)] = inverse_linear(strokes[g].*part.value, part.low, part.high) - 0.5;
    const Eigen::VectorXd own = (part.inverse * values).array() + 0.5;
    x.segment(first, own.size()) = own.unaryExpr(&unit);
    first += own.size();
  }
  double mean = 0;
  for (const Stroke& stroke : strokes) mean += std::log(stroke.duration) / double(strokes.size());
  x[dimension_ - 1] = inverse_logarithmic(std::exp(mean), frame_.shortest_stroke, frame_.longest_sequence);
  return x;
}

Eigen::VectorXd even_point(int k, Eigen::Index dimension) {
  double g = 2;
  for (int round = 0; round < 60; ++round) g = std::pow(1 + g, 1.0 / double(dimension + 1));
  Eigen::VectorXd x(dimension);
  for (Eigen::Index d = 0; d < dimension; ++d) {
    const double whole = 0.5 + k * std::pow(g, -double(d + 1));
    x[d] = whole - std::floor(whole);
  }
  return x;
}

std::vector<Schedule> spread_schedules(const SequenceFrame& frame, int count) {
  constexpr double kReach = 0.5;  // of the box of strokes, around the baseline wave
  const Strokes wave = wave_strokes(frame);
  std::vector<Schedule> result{to_schedule(frame, uniform_strokes(frame)), to_schedule(frame, wave)};
  const WaveFamily waves(frame);
  const StrokeFamily strokes(frame, {});
  const Eigen::VectorXd middle = strokes.encode(wave);
  for (int k = 1; int(result.size()) < count; ++k) {
    result.push_back(to_schedule(frame, waves.decode(even_point(k, WaveFamily::kDimension))));
    const Eigen::VectorXd spread = even_point(k, strokes.dimension()).array() - 0.5;
    result.push_back(to_schedule(frame, strokes.decode(middle + kReach * spread)));
  }
  result.resize(std::min(result.size(), size_t(std::max(count, 0))));
  return result;
}

}  // namespace drapeplan
