#include "planner/tables/curve_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/tables/smooth.hpp"
#include "planner/tables/test_table.hpp"

namespace drapeplan {
namespace {

constexpr size_t kFewestRows = 2;        // beside the origin, which may be one of them
constexpr size_t kMostPoints = 100;      // a table that people wrote; more are records of a machine
constexpr size_t kFewestToSmooth = 24;   // three rows for each of the fewest knots
constexpr size_t kFewestKnots = 8, kMostKnots = 64;
constexpr size_t kRowsPerKnot = 3;
constexpr double kBackwards = 0.02;      // of the largest strain: noise of a strain or crosshead
constexpr double kStressAtRest = 0.05;   // of the largest stress: noise of a force
constexpr double kFall = 0.05;           // of the largest stress, of the smoothed curve: more than its noise
constexpr double kBetter = 0.97;         // twice the knots are worth it if they miss this share or less
constexpr double kGoodEnough = 1e-3;     // of the largest stress
constexpr double kLargestResidual = 0.2; // of the largest stress: beyond it rows are no points of one curve

/// What is read and looked at.
class CurveReader {
 public:
  CurveReader(const std::filesystem::path& file, Dimension abscissa) : file_(file), abscissa_(abscissa) {}

  CurveReading read(const CurveColumns& columns) {
    const TestQuantity x = abscissa_ == Dimension::angle ? TestQuantity::angle : TestQuantity::strain;
    x_name_ = quantity_name(x);
    TableReading table = read_test_table(
        file_, {{x, true, columns.strain}, {TestQuantity::stress, true, columns.stress}}, kFewestRows);
    reading_.errors = std::move(table.errors);
    if (!reading_.errors.empty()) return std::move(reading_);
    strain_ = table.table[x];
    stress_ = table.table[TestQuantity::stress];
    lines_ = std::move(table.table.lines);
    reading_.fit.rows = strain_.size();
    if (!has_signs() || !in_order() || !from_rest()) return std::move(reading_);
    if (strain_.size() <= kMostPoints && first_not_growing() == strain_.size())
      take_as_is();
    else if (strain_.size() < kFewestToSmooth)
      refuse(first_not_growing());
    else
      smooth();
    return std::move(reading_);
  }

 private:
  bool fail(size_t row, const std::string& column, std::string message) {
    reading_.errors.push_back({file_.string(), lines_[row], column, std::move(message)});
    return false;
  }

  [[nodiscard]] std::string x_text(double strain) const {
    return abscissa_ == Dimension::angle ? fmt::format("{:.4g} deg", strain * 180 / std::numbers::pi)
                                         : fmt::format("{:.4g} %", 1e2 * strain);
  }
  static std::string y_text(double stress) { return fmt::format("{:.4g} MPa", 1e-6 * stress); }

  bool has_signs() {
    largest_ = *std::max_element(stress_.begin(), stress_.end());
    reach_ = *std::max_element(strain_.begin(), strain_.end());
    const auto lowest = std::min_element(strain_.begin(), strain_.end());
    if (*lowest < -kBackwards * std::max(reach_, 0.0) || !(reach_ > 0))
      return fail(size_t(lowest - strain_.begin()), x_name_,
                  fmt::format("{} at its lowest; a curve is given in magnitudes, from rest", x_text(*lowest)));
    return largest_ > 0 || fail(0, "stress", "is nowhere above zero");
  }

  bool in_order() {
    double farthest = strain_.front();
    for (size_t k = 1; k < strain_.size(); ++k) {
      farthest = std::max(farthest, strain_[k]);
      if (strain_[k] < farthest - kBackwards * reach_)
        return fail(k, x_name_,
                    fmt::format("goes back from {} to {}: rows are not in their order, hold several curves, or go on "
                                "while the specimen is unloaded",
                                x_text(farthest), x_text(strain_[k])));
    }
    return true;
  }

  bool from_rest() {
    if (strain_.front() > 0 || std::abs(stress_.front()) <= kStressAtRest * largest_) return true;
    return fail(0, "stress",
                fmt::format("is {} at no strain; a curve starts at rest: take the preload away",
                            y_text(stress_.front())));
  }

  /// The first row that a curve cannot have after the one before it; as many as there are rows if there is none.
  [[nodiscard]] size_t first_not_growing() const {
    for (size_t k = 0; k < strain_.size(); ++k) {
      const bool rest = k == 0 && strain_[k] == 0 && stress_[k] == 0;
      const double strain = k == 0 ? 0 : strain_[k - 1], stress = k == 0 ? 0 : stress_[k - 1];
      if (!rest && !(strain_[k] > strain && stress_[k] >= stress)) return k;
    }
    return strain_.size();
  }

  void refuse(size_t row) {
    const double strain = row == 0 ? 0 : strain_[row - 1], stress = row == 0 ? 0 : stress_[row - 1];
    const std::string rule =
        fmt::format("; with fewer than {} rows nothing is smoothed", kFewestToSmooth);
    if (!(strain_[row] > strain))
      fail(row, x_name_,
           fmt::format("does not grow from {} to {}{}", x_text(strain), x_text(strain_[row]), rule));
    else
      fail(row, "stress", fmt::format("falls from {} to {}{}", y_text(stress), y_text(stress_[row]), rule));
  }

  void take_as_is() {
    Curve& curve = reading_.curve;
    if (strain_.front() > 0) {
      curve.strain.push_back(0);
      curve.stress.push_back(0);
    }
    curve.strain.insert(curve.strain.end(), strain_.begin(), strain_.end());
    curve.stress.insert(curve.stress.end(), stress_.begin(), stress_.end());
  }

  /// The curve at so many knots; `falls` is by how much it would fall if it might, and before which strain most.
  Curve curve_at(size_t knots, double& falls, double& where) const {
    std::vector<double> places;
    for (size_t k = 0; k <= knots; ++k) places.push_back(reach_ * double(k) / double(knots));
    const std::vector<double> free = fit_at_knots(strain_, stress_, places, 0);
    double highest = 0, at = 0;
    falls = 0;
    for (size_t k = 0; k <= knots; ++k) {
      if (free[k] > highest) highest = free[k], at = places[k];
      if (highest - free[k] > falls) falls = highest - free[k], where = at;
    }
    std::vector<double> values = not_decreasing(free, std::vector<double>(free.size(), 1));
    for (double& value : values) value = std::max(value, 0.0);
    values.front() = 0;
    return {std::move(places), std::move(values)};
  }

  [[nodiscard]] double residual_of(const Curve& curve) const {
    return rms_miss(strain_, stress_, [&curve](double at) { return curve(std::max(at, 0.0)); }) / largest_;
  }

  /// What the rows scatter about the curve: its residual, without what its free values alone take off.
  [[nodiscard]] double scatter_of(double residual, size_t knots) const {
    return residual / std::sqrt(1 - double(knots) / double(strain_.size()));
  }

  void smooth() {
    const size_t most = std::clamp(strain_.size() / kRowsPerKnot, kFewestKnots, kMostKnots);
    double falls = 0, where = 0;
    size_t knots = kFewestKnots;
    Curve curve = curve_at(knots, falls, where);
    const double coarse_fall = falls, coarse_where = where;
    double residual = residual_of(curve);
    while (residual > kGoodEnough && 2 * knots <= most) {
      Curve finer = curve_at(2 * knots, falls, where);
      const double misses = residual_of(finer);
      if (!(scatter_of(misses, 2 * knots) <= kBetter * scatter_of(residual, knots))) break;
      knots *= 2;
      curve = std::move(finer);
      residual = misses;
    }
    if (coarse_fall > kFall * largest_) return refuse_fall(coarse_fall, coarse_where);
    if (residual > kLargestResidual) {
      fail(0, "stress",
           fmt::format("no curve fits: the best one misses the rows by {:.0f} % of the largest stress (r.m.s.); are "
                       "columns swapped, or are there several specimens?",
                       1e2 * residual));
      return;
    }
    reading_.curve = std::move(curve);
    reading_.fit.knots = knots;
    reading_.fit.residual = residual;
  }

  void refuse_fall(double falls, double where) {
    size_t row = 0;
    while (row + 1 < strain_.size() && strain_[row] < where) ++row;
    fail(row, "stress",
         fmt::format("falls by {} beyond {}: a curve must not fall; end the table where the specimen fails",
                     y_text(falls), x_text(where)));
  }

  const std::filesystem::path& file_;
  Dimension abscissa_;
  std::string x_name_;
  std::vector<double> strain_, stress_;
  std::vector<int> lines_;
  double largest_ = 0, reach_ = 0;  ///< largest stress and strain
  CurveReading reading_;
};

}  // namespace

CurveReading read_curve(const std::filesystem::path& file, Dimension abscissa, const CurveColumns& columns) {
  return CurveReader(file, abscissa).read(columns);
}

std::string fit_text(const std::string& file, const CurveFit& fit) {
  if (fit.knots == 0) return fmt::format("{}: {} rows, taken as they are", file, fit.rows);
  return fmt::format("{}: {} rows, smoothed to {} knots; it misses them by {:.2g} % of the largest stress (r.m.s.)",
                     file, fit.rows, fit.knots, 1e2 * fit.residual);
}

}  // namespace drapeplan
