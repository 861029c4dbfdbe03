// Numerical settings of a drape whose file names none: from the sizes of its rig, its mold and its schedule.
#include <algorithm>
#include <cmath>

#include "planner/case/fields.hpp"

namespace drapeplan {
namespace {

/// Cells along the radius of a pad. Where pads begin and end decides over gaps, so meshes are told apart by
/// this number (tests/bench/study.md).
constexpr int kScreenCells = 1, kSearchCells = 2, kReportCells = 3;
/// Cells are a little longer than their share of the radius: three of equal area reach to 1.005 of it.
constexpr double kCellSlack = 1.01;
/// A pad that is much smaller than the ply between pads gives no size to its cells: at most so many to a
/// spacing, for one cell along the radius.
constexpr double kCellsPerSpacing = 8;
/// A cell turns at most by this much over the mold, for one cell along the radius [rad].
constexpr double kTurn = 0.25;

constexpr double kLeastCell = 1e-4, kLargestCell = 1;  // [m], as `fem.mesh_size` allows

/// A stroke takes at least so many times what the ply needs to fall through its height: then what inertia
/// changes is a few percent of a gap (tests/bench/study.md).
constexpr double kFalls = 2.5;
constexpr double kLargestTimeScaling = 8;
constexpr double kSearchHaste =
    1.5;  ///< of the cheaper fidelities over `report`; twice would throw a light ply
constexpr double kStandardGravity = 9.81;  // [m/s^2], where the case has none
constexpr double kReportFibreMass = 2, kSearchFibreMass = 3;

/// Smallest radius of curvature of the mold where the ply may come to lie [m]; infinite for a plane.
double smallest_radius(const Case& c) {
  constexpr int kSamples = 25;  // in each direction
  const double reach = 0.5 * std::hypot(c.ply.width, c.ply.height);
  const Eigen::Vector2d lower = (c.ply.position.array() - reach).max(c.mold->extent().lower.array());
  const Eigen::Vector2d upper = (c.ply.position.array() + reach).min(c.mold->extent().upper.array());
  double largest = 0;
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const Eigen::Array2d share(i % kSamples, i / kSamples);
    const Eigen::Vector2d at = lower.array() + (upper - lower).array() * share / (kSamples - 1);
    const Jet jet = c.mold->jet(at.x(), at.y());
    const double slope = 1 + jet.zx * jet.zx + jet.zy * jet.zy;
    const double mean =
        ((1 + jet.zy * jet.zy) * jet.zxx - 2 * jet.zx * jet.zy * jet.zxy + (1 + jet.zx * jet.zx) * jet.zyy) /
        (2 * std::pow(slope, 1.5));
    const double product = (jet.zxx * jet.zyy - jet.zxy * jet.zxy) / (slope * slope);
    const double curvature = std::abs(mean) + std::sqrt(std::max(mean * mean - product, 0.0));
    if (std::isfinite(curvature))
      largest = std::max(largest, curvature);  // beyond a sphere's equator it is not
  }
  return 1 / largest;
}

/// To three digits, so that files and tables can show what is used.
double rounded(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

}  // namespace

std::map<std::string, FemOptions> fidelities_from_sizes(const Case& c) {
  const RigOptions& rig = *c.grippers;
  const double coarsest =
      std::min(std::max(rig.pad_radius, rig.spacing / kCellsPerSpacing), kTurn * smallest_radius(c));
  const double stroke = std::min(c.schedule.uniform_duration, c.schedule.wave_duration);
  FemOptions report;
  report.rates = false;
  report.fibre_mass_scaling = kReportFibreMass;
  // Gravity acts on the unscaled mass.
  const double fall =
      std::sqrt(2 * c.schedule.preshape_height * report.mass_scaling / c.gravity.value_or(kStandardGravity));
  report.time_scaling =
      fall > 0 ? rounded(std::clamp(stroke / (kFalls * fall), 1.0, kLargestTimeScaling)) : 1;
  const auto with = [&](int cells, double time_scaling, double fibre_mass_scaling) {
    FemOptions options = report;
    options.mesh_size = std::clamp(rounded(kCellSlack * coarsest / cells), kLeastCell, kLargestCell);
    options.time_scaling = time_scaling;
    options.fibre_mass_scaling = fibre_mass_scaling;
    return options;
  };
  const double fast = rounded(kSearchHaste * report.time_scaling);
  return {{"screen", with(kScreenCells, fast, kSearchFibreMass)},
          {"search", with(kSearchCells, fast, kSearchFibreMass)},
          {"report", with(kReportCells, report.time_scaling, kReportFibreMass)}};
}

}  // namespace drapeplan
