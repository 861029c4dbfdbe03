#include "planner/characterise/tension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mapping/error.hpp"
#include "planner/base/statistics.hpp"

namespace drapeplan {
namespace {

/// Knots of a curve, denser at small strains, where it bends: at the square of equal steps.
std::vector<double> knots_to(double end, int count) {
  std::vector<double> knots;
  for (int k = 0; k <= count; ++k) knots.push_back(end * std::pow(double(k) / count, 2));
  return knots;
}

/// Standard deviation of what scatters from row to row, by second differences; the median, since a curve may jump.
double noise_of(const std::vector<double>& values) {
  std::vector<double> bends;
  for (size_t k = 2; k < values.size(); ++k) bends.push_back(std::abs(values[k] - 2 * values[k - 1] + values[k - 2]));
  if (bends.empty()) return 0;
  constexpr double kMedian = 0.6745;  // of a normal distribution's magnitude, in standard deviations
  return median(std::move(bends)) / (kMedian * std::sqrt(6.0));
}

/// displacement = begin + c force^(1/p), by least squares, for the power p from 1 to 3 that fits best.
struct Beginning {
  double begin = 0, rms = std::numeric_limits<double>::infinity();  ///< [m], of what it misses [m]
};
Beginning fit_beginning(const std::vector<double>& way, const std::vector<double>& force, double from, double to) {
  constexpr int kPowers = 41, kFewest = 8;  // rows
  constexpr double kLowestPower = 1, kHighestPower = 3;
  Beginning best;
  for (int k = 0; k < kPowers; ++k) {
    const double power = kLowestPower + (kHighestPower - kLowestPower) * k / (kPowers - 1);
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (size_t p = 0; p < way.size() && force[p] <= to; ++p) {
      if (force[p] < from) continue;
      const double x = std::pow(force[p] / to, 1 / power), y = way[p] - way.front();
      n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
    }
    const double spread = sxx - sx * sx / n;
    if (n < kFewest || !(spread > 0)) return best;
    const double slope = (sxy - sx * sy / n) / spread;
    const double missed = std::sqrt(std::max(0.0, syy - sy * sy / n - slope * slope * spread) / n);
    if (missed < best.rms) best = {way.front() + (sy - slope * sx) / n, missed};
  }
  return best;
}

/// Displacement at which the force begins, from forces between the noise and the largest share of the whole force
/// over which one power fits as well as over the smallest.
double begin_of_force(const std::vector<double>& way, const std::vector<double>& force) {
  constexpr double kFrom = 0.001, kTo[] = {0.01, 0.02, 0.05, 0.1};  // of the largest force
  constexpr double kNoises = 5, kAsWell = 1.5;                      // standard deviations; times the r.m.s. miss
  const double largest = *std::max_element(force.begin(), force.end());
  const double from = std::max(kFrom * largest, kNoises * noise_of(force));
  Beginning best;
  for (const double to : kTo) {
    const Beginning wider = fit_beginning(way, force, from, to * largest);
    if (std::isfinite(best.rms) && wider.rms > kAsWell * best.rms) break;
    if (std::isfinite(wider.rms)) best = {wider.begin, std::min(best.rms, wider.rms)};
  }
  return std::isfinite(best.rms) ? best.begin : way.front();
}

/// The rows up to the largest force: what follows is a specimen that fails, or a machine that turns back.
size_t rows_to_the_largest(const std::vector<double>& force) {
  return size_t(std::max_element(force.begin(), force.end()) - force.begin()) + 1;
}

StrainPoints points_of(const StripTest& test, const MonotoneCubic* machine, double thickness) {
  const std::vector<double>& force = test.table[TestQuantity::force];
  const size_t rows = rows_to_the_largest(force);
  if (!(force[rows - 1] > 0)) throw NotFinished(test.file + ": the specimen carries no force");
  std::vector<double> way(test.table[TestQuantity::displacement].begin(),
                          test.table[TestQuantity::displacement].begin() + std::ptrdiff_t(rows));
  for (size_t k = 0; machine != nullptr && k < rows; ++k) way[k] -= (*machine)(std::max(force[k], 0.0));
  const double begin = begin_of_force(way, {force.begin(), force.begin() + std::ptrdiff_t(rows)});
  StrainPoints points{test.file, test.rate / test.height, {}, {}};
  for (size_t k = 0; k < rows; ++k) {
    if (way[k] < begin) continue;
    points.strain.push_back((way[k] - begin) / test.height);
    points.stress.push_back(force[k] / (test.width * thickness));
  }
  constexpr double kInOrder = 0.9;  // of the largest displacement, which belongs to the largest force
  const double reach = *std::max_element(way.begin(), way.end()) - begin;
  if (points.strain.size() < kFewestTestRows || !(reach > 0) || way.back() - begin < kInOrder * reach)
    throw WrongInput(
        fmt::format("{}: nothing is left of the curve without its toe{}", test.file,
                    machine == nullptr ? "" : " and what the machine moved: is `compliance` of this machine?"));
  return points;
}

/// The curve of all specimens of one rate, and how far they are from it.
void fit_curve(TensionLaw& law) {
  constexpr int kKnots = 40;
  std::vector<double> strain, stress;
  law.valid_to = std::numeric_limits<double>::infinity();
  for (const StrainPoints& one : law.specimens) {
    if (one.rate != law.rate) continue;
    strain.insert(strain.end(), one.strain.begin(), one.strain.end());
    stress.insert(stress.end(), one.stress.begin(), one.stress.end());
    law.valid_to = std::min(law.valid_to, *std::max_element(one.strain.begin(), one.strain.end()));
  }
  const std::vector<double> knots = knots_to(law.valid_to, kKnots);
  std::vector<double> values = fit_at_knots(strain, stress, knots, 0);
  for (double& value : values) value = std::max(value, 0.0);
  law.curve = {knots, not_decreasing(values, std::vector<double>(values.size(), 1))};
  std::vector<double> inside, missed;
  for (size_t k = 0; k < strain.size(); ++k) {
    if (strain[k] <= law.valid_to) inside.push_back(strain[k]), missed.push_back(stress[k]);
  }
  law.band = rms_miss(inside, missed, law.curve) / law.curve.stress.back();
}

}  // namespace

MonotoneCubic machine_displacement(const std::vector<ComplianceTest>& tests) {
  constexpr int kKnots = 12;
  std::vector<double> force, way;
  double largest = std::numeric_limits<double>::infinity();
  for (const ComplianceTest& test : tests) {
    const std::vector<double>& own = test.table[TestQuantity::force];
    const size_t rows = rows_to_the_largest(own);
    const double begin = test.table[TestQuantity::displacement].front();
    largest = std::min(largest, own[rows - 1]);
    for (size_t k = 0; k < rows; ++k) {
      force.push_back(own[k]);
      way.push_back(test.table[TestQuantity::displacement][k] - begin);
    }
  }
  if (!(largest > 0)) throw NotFinished(tests.front().file + ": the specimen carries no force");
  const std::vector<double> knots = knots_to(largest, kKnots);
  return {knots, not_decreasing(fit_at_knots(force, way, knots, 0), std::vector<double>(knots.size(), 1))};
}

TensionLaw tension_law(const std::vector<StripTest>& tests, const std::vector<ComplianceTest>& compliance,
                       double thickness) {
  TensionLaw law;
  std::optional<MonotoneCubic> machine;
  if (!compliance.empty()) machine.emplace(machine_displacement(compliance));
  for (const StripTest& test : tests) {
    law.specimens.push_back(points_of(test, machine ? &*machine : nullptr, thickness));
    law.rate = std::max(law.rate, law.specimens.back().rate);
  }
  fit_curve(law);
  return law;
}

}  // namespace drapeplan
