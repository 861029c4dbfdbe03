#include "planner/measured/strip_shape.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/measured/bisect.hpp"

namespace drapeplan {
namespace {

/// Arc length from the clamp to x; Simpson's rule.
double arc(const StripShape& shape, double x) {
  constexpr int kParts = 200;
  const auto along = [&](int k) { return std::hypot(1.0, shape.slope(x * k / kParts)); };
  double sum = along(0) + along(kParts);
  for (int k = 1; k < kParts; ++k) sum += (k % 2 == 1 ? 4 : 2) * along(k);
  return sum * x / kParts / 3;
}

}  // namespace

double StripShape::height(double x) const {
  const auto& a = coefficients;
  return x * (a[0] + x * (a[1] + x * (a[2] + x * a[3])));
}

double StripShape::slope(double x) const {
  const auto& a = coefficients;
  return a[0] + x * (2 * a[1] + x * (3 * a[2] + x * 4 * a[3]));
}

double StripShape::curvature(double x) const {
  const auto& a = coefficients;
  const double second = 2 * a[1] + x * (6 * a[2] + x * 12 * a[3]);
  return second / std::pow(1 + slope(x) * slope(x), 1.5);
}

double StripShape::length() const {
  return arc(*this, end);
}

double StripShape::place(double share) const {
  const double wanted = share * length();
  return bisect(0, end, [&](double x) { return arc(*this, x) >= wanted; });
}

StripShape strip_shape(const std::vector<Eigen::Vector2d>& line, double time) {
  Eigen::MatrixXd powers(Eigen::Index(line.size()), 4);
  Eigen::VectorXd heights(Eigen::Index(line.size()));
  const double end = line.back().x();
  for (Eigen::Index k = 0; k < heights.size(); ++k) {
    const double x = line[size_t(k)].x() / end;  // scaled, so that the columns are alike
    powers.row(k) << x, x * x, x * x * x, x * x * x * x;
    heights[k] = line[size_t(k)].y();
  }
  Eigen::Vector4d a = powers.colPivHouseholderQr().solve(heights);
  for (int k = 0; k < 4; ++k) a[k] /= std::pow(end, k + 1);
  return {time, a, end};
}

double outer_strain(const StripShape& shape, double share_of_length, double thickness) {
  return -0.5 * thickness * shape.curvature(shape.place(share_of_length));
}

double DoublePowerLaw::operator()(double t) const {
  return a * std::pow(t, b) + c * std::pow(t, d);
}

double DoublePowerLaw::rate(double t) const {
  return a * b * std::pow(t, b - 1) + c * d * std::pow(t, d - 1);
}

DoublePowerLaw fit_double_power(const std::vector<double>& time, const std::vector<double>& value) {
  const auto try_powers = [&](double b, double d, DoublePowerLaw& law) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (size_t k = 0; k < time.size(); ++k) {
      const double weight = 1 / std::max(std::abs(value[k]), 1e-12);
      const Eigen::Vector2d row = weight * Eigen::Vector2d(std::pow(time[k], b), std::pow(time[k], d));
      normal += row * row.transpose();
      right += row * (weight * value[k]);
    }
    const Eigen::Vector2d factors = normal.fullPivLu().solve(right);
    law = {factors[0], b, factors[1], d};
    double missed = 0;
    for (size_t k = 0; k < time.size(); ++k) missed += std::pow(law(time[k]) / value[k] - 1, 2);
    return std::isfinite(missed) ? missed : std::numeric_limits<double>::infinity();
  };
  constexpr int kGrid = 24, kRefinements = 14;
  constexpr double kNarrower = 0.6;  // slowly: the valley of good pairs is narrow and oblique
  double low = -1, high = 1.5, width = high - low;
  double best = std::numeric_limits<double>::infinity(), at_b = 0.25, at_d = 0.25;
  DoublePowerLaw law;
  for (int round = 0; round <= kRefinements; ++round) {
    const double b0 = round == 0 ? low : at_b - width / 2, d0 = round == 0 ? low : at_d - width / 2;
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; j <= kGrid; ++j) {
        const double b = b0 + width * i / kGrid, d = d0 + width * j / kGrid;
        if (!(d > b + 1e-6)) continue;
        DoublePowerLaw candidate;
        const double missed = try_powers(b, d, candidate);
        if (missed < best) best = missed, law = candidate;
      }
    }
    at_b = law.b, at_d = law.d;
    width *= kNarrower;
  }
  return law;
}

double transverse_shear_modulus(double root_slope, double length, double load, double thickness) {
  constexpr double kShearCorrection = 5.0 / 6;
  return load * length / (kShearCorrection * thickness * std::abs(root_slope));
}

}  // namespace drapeplan
