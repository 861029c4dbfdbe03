#include "planner/stress/exact.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace drapeplan {
namespace {

constexpr int kHalvings = 200;

/// Where a growing function crosses zero.
template <class Function>
double crossing(const Function& f, double low, double high) {
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// Slope at the tip of an elastica over its length, and the drop.
std::array<double, 2> shoot(double beta, double root_slope) {
  constexpr int kSteps = 4000;
  const double h = 1.0 / kSteps;
  using Point = std::array<double, 3>;  // angle, its derivative, drop
  const auto rate = [beta](double s, const Point& q) {
    return Point{q[1], -beta * (1 - s) * std::cos(q[0]), std::sin(q[0])};
  };
  const auto along = [](const Point& q, double step, const Point& k) {
    return Point{q[0] + step * k[0], q[1] + step * k[1], q[2] + step * k[2]};
  };
  Point y{0, root_slope, 0};
  for (int n = 0; n < kSteps; ++n) {
    const double s = n * h;
    const Point k1 = rate(s, y), k2 = rate(s + h / 2, along(y, h / 2, k1));
    const Point k3 = rate(s + h / 2, along(y, h / 2, k2)), k4 = rate(s + h, along(y, h, k3));
    for (size_t k = 0; k < 3; ++k) y[k] += h / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
  }
  return {y[1], y[2]};
}

}  // namespace

HingedSag hinged_sag(const HingedStrip& strip) {
  constexpr int kTerms = 99;
  struct Series {
    double sag = 0, stretch = 0;
  };
  const auto series = [&strip](double tension) {
    Series sum;
    for (int n = 1; n <= kTerms; n += 2) {
      const double wave = n * std::numbers::pi / strip.length, wave2 = wave * wave;
      const double bending = strip.bending / (1 + strip.bending * wave2 / strip.transverse);
      const double a = 4 * strip.load / (n * std::numbers::pi) / (bending * wave2 * wave2 + tension * wave2);
      sum.sag += (n % 4 == 1 ? a : -a);
      sum.stretch += 0.25 * a * a * wave2;
    }
    return sum;
  };
  const double tension = crossing([&](double t) { return t - strip.stretch * series(t).stretch; },
                                  1e-12 * strip.stretch, strip.stretch);
  return {series(tension).sag, tension};
}

double elastica_drop(double beta) {
  const double slope = crossing([beta](double root) { return shoot(beta, root)[0]; }, 0, beta);
  return shoot(beta, slope)[1];
}

double trellis_angle(const Curve& shear, double force) {
  return crossing([&](double angle) { return shear(angle) - force * std::cos(angle); }, 0,
                  0.5 * std::numbers::pi);
}

}  // namespace drapeplan
