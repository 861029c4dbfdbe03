#include "planner/measured/test_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace drapeplan {
namespace {

/// How far what moves may seem to go back, of its whole way: more than noise.
constexpr double kCrossheadNoise = 0.02, kTipNoise = 0.2;
constexpr double kAbove = 0.05;  // of a strip's length, above its clamp: more than noise

double range(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

class Checks {
 public:
  Checks(const TestTable& table, const std::string& file) : table_(table), file_(file) {}

  /// @return false, so that checks that need this one can be left out.
  bool fail(size_t row, TestQuantity quantity, std::string message) {
    errors.push_back({file_, table_.lines[row], quantity_name(quantity), std::move(message)});
    return false;
  }

  /// Times increase, and so does, but for noise, what moves. @param noise  that is possible, of the whole way.
  bool in_order(TestQuantity moves, double noise) {
    const std::vector<double>& way = table_[moves];
    const double back = noise * range(way);
    for (size_t k = 1; k < table_.rows(); ++k) {
      if (table_.has(TestQuantity::time) && !(table_[TestQuantity::time][k] > table_[TestQuantity::time][k - 1]))
        return fail(k, TestQuantity::time, "does not increase: rows are not in their order, or columns are swapped");
      if (way[k] < way[k - 1] - back)
        return fail(k, moves,
                    fmt::format("jumps back from {:.4g} to {:.4g} mm: rows are not in their order, or the "
                                "columns are swapped",
                                1e3 * way[k - 1], 1e3 * way[k]));
    }
    if (!table_.has(TestQuantity::time)) return true;
    const double seconds = table_[TestQuantity::time].back() - table_[TestQuantity::time].front();
    return seconds <= kLongestTest || fail(table_.rows() - 1, TestQuantity::time,
                                           fmt::format("{:.3g} s after the first row: the wrong unit?", seconds));
  }

  /// The crosshead goes as fast as stated, and no further than the specimen allows.
  bool moves_as_stated(const MachineLimits& limits) {
    const std::vector<double>& way = table_[TestQuantity::displacement];
    const size_t last = table_.rows() - 1;
    if (range(way) > limits.way)
      return fail(last, TestQuantity::displacement,
                  fmt::format("grows by {:.4g} mm, but this specimen allows {:.4g} mm: the wrong unit, size or column",
                              1e3 * range(way), 1e3 * limits.way));
    if (!(way.back() > way.front()))
      return fail(last, TestQuantity::displacement, "is no larger in the end than in the beginning");
    if (limits.rate <= 0 || !table_.has(TestQuantity::time)) return true;
    const double seconds = table_[TestQuantity::time].back() - table_[TestQuantity::time].front();
    const double measured = (way.back() - way.front()) / seconds;
    constexpr double kRateTolerance = 0.2;
    return std::abs(measured - limits.rate) <= kRateTolerance * limits.rate ||
           fail(last, TestQuantity::displacement,
                fmt::format("grows by {:.3g} mm/min, but the test's rate is {:.3g} mm/min: the wrong unit, rate or "
                            "column",
                            6e4 * measured, 6e4 * limits.rate));
  }

  /// The largest force is one that the specimen can have borne, and it is not there from the start.
  bool pulls(const MachineLimits& limits) {
    const std::vector<double>& force = table_[TestQuantity::force];
    const auto largest = size_t(std::max_element(force.begin(), force.end()) - force.begin());
    if (!(force[largest] > limits.least_force))
      return fail(largest, TestQuantity::force,
                  fmt::format("{:.3g} N is the largest one, but {:.2g} N is no force of a test: the wrong sign, unit "
                              "or column? Pulling forces are > 0",
                              force[largest], limits.least_force));
    if (force[largest] > limits.most_force)
      return fail(largest, TestQuantity::force,
                  fmt::format("{:.3g} N is more than this specimen bears, {:.2g} N: the wrong unit or column",
                              force[largest], limits.most_force));
    return !limits.rises || largest + 1 >= kFewestTestRows ||
           fail(largest, TestQuantity::force,
                fmt::format("{:.3g} N is the largest one: no curve lies before it; the record must start with the "
                            "unloaded specimen",
                            force[largest]));
  }

  /// A single row far above both neighbours is no force of the specimen.
  bool has_no_spike() {
    const std::vector<double>& force = table_[TestQuantity::force];
    constexpr double kSpike = 0.1;   // of the largest force
    constexpr double kOthers = 3;    // times the largest step between other rows
    const double largest = *std::max_element(force.begin(), force.end());
    for (size_t k = 1; k + 1 < force.size(); ++k) {
      const double height = force[k] - std::max(force[k - 1], force[k + 1]);
      if (!(height > kSpike * largest)) continue;
      double others = 0;
      for (size_t j = 1; j < force.size(); ++j) {
        if (j != k && j != k + 1) others = std::max(others, std::abs(force[j] - force[j - 1]));
      }
      if (height > kOthers * others)
        return fail(k, TestQuantity::force,
                    fmt::format("{:.4g} N lies far above the rows before and after it, {:.4g} and {:.4g} N: a "
                                "disturbance? Take this row away",
                                force[k], force[k - 1], force[k + 1]));
    }
    return true;
  }

  /// A force that falls at once, and rises again, is a specimen that slipped.
  bool has_not_slipped() {
    const std::vector<double>&way = table_[TestQuantity::displacement], &force = table_[TestQuantity::force];
    constexpr double kFall = 0.1;      // of the largest force
    constexpr double kAtOnce = 0.005;  // of the whole way
    const double largest = *std::max_element(force.begin(), force.end()), at_once = kAtOnce * range(way);
    std::vector<double> after(force);  // largest force from each row on
    for (size_t k = force.size() - 1; k-- > 0;) after[k] = std::max(after[k], after[k + 1]);
    size_t first = 0;
    for (size_t k = 0; k < table_.rows(); ++k) {
      while (way[k] - way[first] > at_once) ++first;
      const double before =
          *std::max_element(force.begin() + std::ptrdiff_t(first), force.begin() + std::ptrdiff_t(k) + 1);
      if (before - force[k] < kFall * largest) continue;
      if (after[k] < before) return true;  // it never rises again: the specimen failed, or the test was over
      return fail(k, TestQuantity::force,
                  fmt::format("falls from {:.4g} to {:.4g} N at once, at {:.4g} mm, and rises again: did the "
                              "specimen slip in its clamps?",
                              before, force[k], 1e3 * way[k]));
    }
    return true;
  }

  /// Deflections between the clamp's height and the strip's length, and a last one that can be seen.
  bool hangs(double length) {
    const std::vector<double>& drop = table_[TestQuantity::deflection];
    for (size_t k = 0; k < drop.size(); ++k) {
      if (drop[k] >= length)
        return fail(k, TestQuantity::deflection,
                    fmt::format("{:.4g} mm is deeper than the strip is long, {:.4g} mm: the wrong unit, column or "
                                "length",
                                1e3 * drop[k], 1e3 * length));
      if (drop[k] < -kAbove * length)
        return fail(k, TestQuantity::deflection,
                    fmt::format("{:.4g} mm lies above the clamp; deflections are > 0 downwards", 1e3 * drop[k]));
    }
    return drop.back() >= kLeastDrop * length ||
           fail(drop.size() - 1, TestQuantity::deflection,
                fmt::format("{:.3g} mm is less than {:g} % of the strip's length: too little to be measured",
                            1e3 * drop.back(), 1e2 * kLeastDrop));
  }

  std::vector<InputError> errors;

 private:
  const TestTable& table_;
  const std::string& file_;
};

}  // namespace

std::vector<InputError> machine_faults(const TestTable& table, const std::string& file, const MachineLimits& limits) {
  Checks checks(table, file);
  const bool good = checks.in_order(TestQuantity::displacement, kCrossheadNoise) && checks.moves_as_stated(limits) &&
                    checks.pulls(limits) && checks.has_no_spike() && checks.has_not_slipped();
  if (good) return {};
  return std::move(checks.errors);
}

std::vector<InputError> drop_faults(const TestTable& table, const std::string& file, double length) {
  Checks checks(table, file);
  if (!checks.hangs(length) || !checks.in_order(TestQuantity::deflection, kTipNoise)) return std::move(checks.errors);
  const std::vector<double>&time = table[TestQuantity::time], &drop = table[TestQuantity::deflection];
  constexpr double kHalfway = 0.4;  // of the way, after half of the time: what creeps is further than this
  size_t half = 0;
  while (time[half] - time.front() < 0.5 * (time.back() - time.front())) ++half;
  if (drop[half] - drop.front() < kHalfway * (drop.back() - drop.front()))
    checks.fail(half, TestQuantity::deflection,
                "grows ever faster, but a strip comes down ever more slowly: are the columns swapped?");
  return std::move(checks.errors);
}

std::vector<InputError> profile_faults(const TestTable& table, const std::string& file, double length) {
  Checks checks(table, file);
  const std::vector<double>&x = table[TestQuantity::distance], &down = table[TestQuantity::deflection];
  double along = 0;
  for (size_t k = 1; k < table.rows(); ++k) {
    along += std::hypot(x[k] - x[k - 1], down[k] - down[k - 1]);
    if (x[k] > x[k - 1]) continue;
    checks.fail(k, TestQuantity::distance,
                "does not increase: places are not in their order from the clamp to the tip, or so near each other "
                "that errors put them out of it");
    return std::move(checks.errors);
  }
  if (std::abs(along - length) > kLengthTolerance * length)
    checks.fail(table.rows() - 1, TestQuantity::distance,
                fmt::format("the strip is {:.4g} mm long up to this place, not {:.4g} mm: the wrong unit, column or "
                            "length; the first place is the clamp, the last one the tip",
                            1e3 * along, 1e3 * length));
  else
    checks.hangs(length);
  return std::move(checks.errors);
}

}  // namespace drapeplan
