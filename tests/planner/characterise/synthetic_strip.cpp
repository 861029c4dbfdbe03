#include "tests/planner/characterise/synthetic_strip.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include <Eigen/Geometry>

#include "planner/characterise/beam.hpp"
#include "planner/measured/smooth.hpp"

namespace drapeplan::test {
namespace {

constexpr double kFirstTime = 0.4;  // [s]
constexpr int kRates = 16;          // at which strips are computed, from rest to the fastest curve

/// The compression curve at one rate.
Curve curve_at(const Fabric& fabric, double rate) {
  Curve curve = fabric.compression.slowest();
  for (size_t k = 0; k < curve.strain.size(); ++k)
    curve.stress[k] = fabric.compression(curve.strain[k], rate, fabric.rate_floor);
  return curve;
}

/// The strip with the slope of transverse shear, V / (5/6 G t), beside that of bending.
std::vector<Eigen::Vector2d> with_shear(const StripAtRest& strip, const Fabric& fabric, double length, double load) {
  constexpr double kShearCorrection = 5.0 / 6;
  const double stiffness = kShearCorrection * fabric.transverse_shear_modulus * fabric.thickness;
  std::vector<Eigen::Vector2d> places{{0, 0}};
  const size_t chords = strip.places.size() - 1;
  for (size_t k = 0; k < chords; ++k) {
    const Eigen::Vector2d chord = strip.places[k + 1] - strip.places[k];
    const double beyond = length * (double(chords - k) - 0.5) / double(chords);
    const double shear_force = load * beyond * chord.x() / chord.norm();
    places.push_back(places.back() + Eigen::Rotation2Dd(-shear_force / stiffness) * chord);
  }
  return places;
}

}  // namespace

std::vector<CreepingStrip> creeping_strip(const Fabric& truth, double length, double gravity,
                                          const std::vector<double>& times) {
  const double load = gravity * truth.areal_density;
  const double fastest = std::log1p(truth.compression.rates.back() / truth.rate_floor);
  const auto rate_of = [&](double x) { return truth.rate_floor * std::expm1(x); };
  // Strips over x = log(1 + rate / floor), in which the law is piecewise linear.
  std::vector<double> x, strain;
  std::vector<std::vector<Eigen::Vector2d>> shapes;
  for (int k = 0; k < kRates; ++k) {
    x.push_back(fastest * k / (kRates - 1));
    const BendingLaw law =
        section_bending(truth.tension.slowest(), curve_at(truth, rate_of(x.back())), truth.thickness);
    const StripAtRest strip = strip_at_rest(law, length, load);
    strain.push_back(0.5 * truth.thickness * strip.curvature.front());
    shapes.push_back(with_shear(strip, truth, length, load));
  }
  const MonotoneCubic strain_of(x, strain);
  // x over time: from the fastest curve on, strain grows with the rate that it has.
  std::vector<double> clock{kFirstTime}, place{fastest};
  constexpr double kShare = 0.998;  // of x that a step leaves
  while (clock.back() < times.back()) {
    const double next = kShare * place.back(), middle = 0.5 * (place.back() + next);
    clock.push_back(clock.back() + (strain_of(next) - strain_of(place.back())) / rate_of(middle));
    place.push_back(next);
  }
  std::vector<CreepingStrip> result;
  for (const double time : times) {
    const double at = value_between(clock, place, time);
    const auto k = size_t(std::min(at / x[1], kRates - 2.0));
    const double share = at / x[1] - double(k);
    CreepingStrip strip{time, shapes[k]};
    for (size_t n = 0; n < strip.places.size(); ++n)
      strip.places[n] += share * (shapes[k + 1][n] - shapes[k][n]);
    result.push_back(std::move(strip));
  }
  return result;
}

void write_picture(const std::filesystem::path& file, const CreepingStrip& strip, double scale, double depth,
                   std::mt19937_64& bits) {
  constexpr double kDark = 40, kBright = 210, kNoise = 15;  // grey levels; noise is +- that much
  constexpr double kSeen = 0.5e-3;                          // [m]
  constexpr int kMargin = 30, kSpecks = 20, kSpeck = 4;     // [pixels]
  const int width = int(strip.places.back().x() / scale) + 3 * kMargin, height = int(depth / scale) + 2 * kMargin;
  std::vector<double> levels(size_t(width) * size_t(height), kDark);
  const auto even = [&bits] { return double(bits() >> 11) * 0x1p-53; };
  const auto brighten = [&](int column, int row, double share) {
    if (column < 0 || row < 0 || column >= width || row >= height) return;
    double& level = levels[size_t(row) * size_t(width) + size_t(column)];
    level = std::max(level, kDark + std::clamp(share, 0.0, 1.0) * (kBright - kDark));
  };
  const double half = 0.5 * kSeen / scale;
  const auto pixel = [&](size_t k) {
    return Eigen::Vector2d(kMargin + strip.places[k].x() / scale, kMargin - strip.places[k].y() / scale);
  };
  for (size_t k = 0; k + 1 < strip.places.size(); ++k) {
    const Eigen::Vector2d a = pixel(k), b = pixel(k + 1), along = (b - a).normalized();
    const int reach = int(half + (b - a).norm()) + 2;
    for (int row = int(a.y()) - reach; row <= int(a.y()) + reach; ++row) {
      for (int column = std::max(kMargin, int(a.x()) - reach); column <= int(a.x()) + reach; ++column) {
        const Eigen::Vector2d from = Eigen::Vector2d(column, row) - a;
        const double place = std::clamp(from.dot(along), 0.0, (b - a).norm());
        brighten(column, row, half + 0.5 - (from - place * along).norm());
      }
    }
  }
  for (int k = 0; k < kSpecks; ++k) {
    const int column = int(even() * width), row = int(even() * height);
    for (int n = 0; n < kSpeck * kSpeck; ++n) brighten(column + n % kSpeck, row + n / kSpeck, 1);
  }
  std::string text = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 255\n";
  for (const double level : levels) text += char(std::uint8_t(level + kNoise * (2 * even() - 1)));
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace drapeplan::test
