#include "planner/characterise/beam.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "planner/measured/bisect.hpp"
#include "planner/tables/smooth.hpp"

namespace drapeplan {
namespace {

constexpr int kSteps = 400;  // along the strip

/// Slope angle, moment, x, y along the strip.
using Along = std::array<double, 4>;

Along operator+(const Along& a, const Along& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}
Along operator*(double factor, const Along& a) {
  return {factor * a[0], factor * a[1], factor * a[2], factor * a[3]};
}

/// One classical fourth-order Runge-Kutta step along the strip, from the tip inwards.
/// @param from_tip  where it starts [m].
Along step_inwards(const BendingLaw& law, double load, double from_tip, double step, const Along& at) {
  const auto rate = [&](double s, const Along& a) -> Along {
    return {-law(a[1]), load * s * std::cos(a[0]), -std::cos(a[0]), std::sin(a[0])};
  };
  const Along a = rate(from_tip, at), b = rate(from_tip + step / 2, at + step / 2 * a),
              c = rate(from_tip + step / 2, at + step / 2 * b), d = rate(from_tip + step, at + step * c);
  return at + step / 6 * (a + 2.0 * b + 2.0 * c + d);
}

/// The strip with this slope angle at its tip.
/// @param clamp_angle  that it has at the other end, its smallest one.
StripAtRest integrate(const BendingLaw& law, double length, double load, double tip_angle,
                      double& clamp_angle) {
  const double step = length / kSteps;
  StripAtRest strip;
  Along at{tip_angle, 0, 0, 0};
  clamp_angle = tip_angle;
  for (int k = 0; k <= kSteps; ++k) {
    strip.places.emplace_back(at[2], at[3]);
    strip.curvature.push_back(law(at[1]));
    strip.moment.push_back(at[1]);
    clamp_angle = std::min(clamp_angle, at[0]);  // a strip that turns back is bent too much all the same
    at = step_inwards(law, load, k * step, step, at);
  }
  const Eigen::Vector2d clamp = strip.places.back();
  for (Eigen::Vector2d& place : strip.places) place -= clamp;
  std::reverse(strip.places.begin(), strip.places.end());
  std::reverse(strip.curvature.begin(), strip.curvature.end());
  std::reverse(strip.moment.begin(), strip.moment.end());
  return strip;
}

/// Length and drop of a linear strip in its own unit of length, (D / load)^(1/3), in which a slope angle at the tip
/// alone tells all the rest: where the strip is horizontal, there is its clamp. Infinite beyond `kLongest`.
struct OwnUnits {
  double length = 0, drop = 0;
};
constexpr double kLongest = 10;  // in that unit: hangs down straight, a tip of 1e-9 rad off the vertical
OwnUnits linear_strip(double tip_angle) {
  const BendingLaw law = linear_bending(1);
  const double step = std::cbrt(6 * tip_angle) / kSteps;  // no strip with this angle is shorter
  Along at{tip_angle, 0, 0, 0};
  double from_tip = 0;
  for (;; from_tip += step) {
    if (from_tip > kLongest) return {std::numeric_limits<double>::infinity(), 0};
    const Along next = step_inwards(law, 1, from_tip, step, at);
    if (next[0] <= 0) break;
    at = next;
  }
  const double last = bisect(0, step, [&](double part) { return step_inwards(law, 1, from_tip, part, at)[0] <= 0; });
  return {from_tip + last, step_inwards(law, 1, from_tip, last, at)[3]};
}

/// Share of each knot in a piecewise linear function at `at`; the end's beyond the ends. @param knots  increasing.
Eigen::VectorXd shares_at(const std::vector<double>& knots, double at) {
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(Eigen::Index(knots.size()));
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, at);
  const auto k = Eigen::Index(above - knots.begin());
  const double low = *(above - 1), share = std::clamp((at - low) / (*above - low), 0.0, 1.0);
  shares[k - 1] = 1 - share;
  shares[k] = share;
  return shares;
}

/// Integral over the strain from 0 to `end` of stress and of stress times strain, of a piecewise linear curve.
std::array<double, 2> integrals(const Curve& curve, double end) {
  std::array<double, 2> sums{0, 0};
  const auto add = [&](double from, double to) {
    if (!(to > from)) return;
    const double a = curve(from), b = curve(to), width = to - from;
    sums[0] += width * (a + b) / 2;
    sums[1] += width * (a * from + b * to + 4 * curve((from + to) / 2) * (from + to) / 2) / 6;
  };
  for (size_t k = 0; k + 1 < curve.strain.size(); ++k)
    add(std::min(curve.strain[k], end), std::min(curve.strain[k + 1], end));
  add(std::min(curve.strain.back(), end), end);
  return sums;
}

}  // namespace

BendingLaw linear_bending(double stiffness) {
  return {{0, 1}, {0, 1 / stiffness}};
}

StripAtRest strip_at_rest(const BendingLaw& law, double length, double load) {
  double angle = 0;  // at the clamp
  const double tip_angle = bisect(0, 0.5 * std::numbers::pi, [&](double at_tip) {
    integrate(law, length, load, at_tip, angle);
    return angle >= 0;
  });
  return integrate(law, length, load, tip_angle, angle);
}

double stiffness_of(double tip, double length, double load) {
  if (!(tip > 0 && tip < length))
    throw std::invalid_argument("stiffness_of: the drop must lie between 0 and the length");
  const OwnUnits strip = linear_strip(bisect(0, 0.5 * std::numbers::pi, [&](double tip_angle) {
    const OwnUnits tried = linear_strip(tip_angle);
    return tried.length > kLongest || tried.drop / tried.length >= tip / length;
  }));
  if (strip.length > kLongest)
    throw std::invalid_argument("stiffness_of: a strip that drops so far hangs down straight");
  return load * std::pow(length / strip.length, 3);
}

BendingLaw bending_law_of_profile(const std::vector<Eigen::Vector2d>& places, double load, int pieces) {
  const size_t count = places.size();
  if (pieces < 2 || count < 2 * size_t(pieces) + 1)
    throw std::invalid_argument("bending_law_of_profile: needs two places for each piece of the law, two pieces");
  // Moments at the places, of the weight of the chords beyond them.
  std::vector<double> along{0}, moment(count, 0);
  for (size_t k = 1; k < count; ++k) along.push_back(along.back() + (places[k] - places[k - 1]).norm());
  for (size_t k = count - 1; k-- > 0;) {
    const double beyond = load * (along.back() - along[k + 1]), chord = places[k + 1].x() - places[k].x();
    moment[k] = moment[k + 1] + chord * (beyond + 0.5 * load * (along[k + 1] - along[k]));
    if (!(moment[k] > moment[k + 1]))
      throw std::invalid_argument("bending_law_of_profile: the strip turns back on itself");
  }
  const std::vector<double> rising(moment.rbegin(), moment.rend());
  std::vector<double> from_tip, knots;
  for (size_t k = count; k-- > 0;) from_tip.push_back(along.back() - along[k]);
  for (int k = 0; k <= pieces; ++k) knots.push_back(value_between(from_tip, rising, along.back() * k / pieces));
  // Curvatures at the knots: their second integral along the strip is that of the chords' angles, downwards.
  const auto chords = Eigen::Index(count) - 1;
  Eigen::MatrixXd sags = Eigen::MatrixXd::Zero(chords, pieces + 1);
  Eigen::VectorXd measured(chords), angle = Eigen::VectorXd::Zero(pieces + 1), sag = angle;
  double sum = 0;
  for (Eigen::Index k = 0; k < chords; ++k) {
    const Eigen::Vector2d chord = places[size_t(k) + 1] - places[size_t(k)];
    const double step = chord.norm(), here = moment[size_t(k)], next = moment[size_t(k) + 1];
    const Eigen::VectorXd start = shares_at(knots, here), middle = shares_at(knots, 0.5 * (here + next)),
                          end = shares_at(knots, next);
    sag += step * angle + step * step * (start + 2 * middle) / 6;
    angle += step * (start + 4 * middle + end) / 6;
    sum += step * std::atan2(-chord.y(), chord.x());
    sags.row(k) = sag.transpose();
    measured[k] = sum;
  }
  const Eigen::VectorXd solved = sags.rightCols(pieces).colPivHouseholderQr().solve(measured);
  std::vector<double> curvature{0};
  for (const double value : solved) curvature.push_back(std::max(value, 0.0));
  return {knots, not_decreasing(curvature, std::vector<double>(curvature.size(), 1))};
}

double section_moment(const Curve& tension, const Curve& compression, double thickness, double curvature) {
  if (!(curvature > 0)) return 0;
  const double spread = curvature * thickness;  // of strains, from the inside to the outside
  const auto outside = [&](double tensile) { return integrals(tension, tensile); };
  const double tensile = bisect(0, spread, [&](double strain) {
    return outside(strain)[0] >= integrals(compression, spread - strain)[0];
  });
  return (outside(tensile)[1] + integrals(compression, spread - tensile)[1]) / (curvature * curvature);
}

BendingLaw section_bending(const Curve& tension, const Curve& compression, double thickness) {
  constexpr int kPoints = 500;
  constexpr double kLargestStrain = 0.1;
  BendingLaw law{{0}, {0}};
  for (int k = 1; k <= kPoints; ++k) {
    const double curvature = kLargestStrain / thickness * std::pow(double(k) / kPoints, 3);
    const double moment = section_moment(tension, compression, thickness, curvature);
    if (!(moment > law.strain.back())) continue;
    law.strain.push_back(moment);
    law.stress.push_back(curvature);
  }
  return law;
}

}  // namespace drapeplan
