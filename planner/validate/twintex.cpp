// Bias extension and picture frame of a woven glass: each law from the one test against the other test.
#include "planner/validate/twintex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "mapping/error.hpp"
#include "planner/characterise/shear.hpp"
#include "planner/characterise/verify.hpp"
#include "planner/tables/smooth.hpp"
#include "planner/report/charts.hpp"
#include "planner/validate/validate.hpp"

namespace drapeplan {
namespace {

using namespace twintex;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPerMm = 1e-3;      // N/m to N/mm
constexpr double kForceShare = 0.1;  // of a measured force
constexpr double kValidTo = 30;      // of angles from the crosshead [deg]
constexpr const char* kFig28 = "Cao and others 2008, Fig. 28, HKUST";
constexpr const char* kFig36 = "Cao and others 2008, Fig. 36";
constexpr const char* kFig40 = "Cao and others 2008, Fig. 40, HKUST 115 x 230 mm";

TestTable table_of(const std::vector<double>& way, const std::vector<double>& force) {
  TestTable table;
  table.columns[TestQuantity::displacement] = way;
  table.columns[TestQuantity::force] = force;
  for (size_t k = 0; k < way.size(); ++k) table.lines.push_back(int(k) + 1);
  return table;
}

StripTest bias_test() {
  std::vector<double> way;
  for (const double mm : kBiasWay) way.push_back(1e-3 * mm);
  return {"Fig. 40", kBiasWidth, kBiasHeight,
          kBiasRate, {},         table_of(way, {kBiasForce.begin(), kBiasForce.end()})};
}

ShearLaw bias_law() {
  return bias_extension_law({bias_test()}, {.thickness = kThickness});
}

/// The law of one laboratory's frame. Its forces are normalised, F / (2 cos(pi/4 - g/2)) over the side: here
/// those of a frame of 1 m, filled by the fabric. Between the angles that are published a monotone curve is
/// taken, at every degree.
ShearLaw frame_law(const Laboratory& laboratory) {
  std::vector<double> angle{0}, normalised{0};
  for (size_t k = 0; k < kFrameAngle.size() && std::isfinite(laboratory.force[k]); ++k) {
    angle.push_back(kFrameAngle[k]);
    normalised.push_back(laboratory.force[k] / kPerMm);
  }
  const MonotoneCubic curve(angle, normalised);
  std::vector<double> way, force;
  for (double degrees = 0; degrees <= angle.back(); degrees += 1) {
    const double opening = 2 * std::cos(std::numbers::pi / 4 - degrees * kDegree / 2);
    way.push_back(opening - std::numbers::sqrt2);
    force.push_back(curve(degrees) * opening);
  }
  return picture_frame_law({{laboratory.name, 1, {}, kBiasRate, {}, table_of(way, force)}},
                           {.thickness = kThickness});
}

/// Shear force per length F_sh, as benchmarks print it [N/mm].
double shear_force(const ShearLaw& law, double degrees) {
  return kPerMm * kThickness * law.table.slowest()(degrees * kDegree) / std::cos(degrees * kDegree);
}

/// What a law means for the strip of Fig. 40, by the balance of power [N]. @param mm  displacement.
double predicted_force(const ShearLaw& law, double mm) {
  const double angle = bias_angle(1e-3 * mm, kBiasHeight - kBiasWidth);
  const auto c = [&](double at) { return kThickness * law.table.slowest()(at); };
  return bias_force(c(angle), c(angle / 2), angle, kBiasHeight, kBiasWidth);
}

/// Standard deviation of a figure over the laboratories whose frames reach the angle.
double spread(double degrees, const std::function<double(const ShearLaw&)>& figure) {
  double sum = 0, squares = 0;
  int count = 0;
  for (const Laboratory& laboratory : kFrames) {
    const ShearLaw law = frame_law(laboratory);
    if (law.measured_to < degrees * kDegree * (1 - 1e-9)) continue;
    const double value = figure(law);
    sum += value, squares += value * value, ++count;
  }
  return std::sqrt(std::max(squares - sum * sum / count, 0.0) / (count - 1));
}

/// A row of a law from the one test beside the other test. @param degrees  shear angle there.
ValidationRow across_tests(std::string what, std::string unit, double degrees, double reference, double ours,
                           double tolerance, std::string source) {
  ValidationRow row{std::move(what),
                    std::move(unit),
                    reference,
                    ours,
                    tolerance,
                    std::move(source),
                    "the standard deviation of 7 laboratories' frames"};
  constexpr double kFrom = 20;  // [deg]
  row.judged = degrees >= kFrom;
  if (!row.judged)
    row.why = "below 20 deg HKUST's frame resists far less than its strip, and frames scatter 25-fold";
  return row;
}

/// Fibres that stretch by 0.02 % at most under the forces of the test: the paper gives no modulus.
Fabric fabric_of(const ShearLaw& law) {
  constexpr double kModulus = 1e9;     // of fibres, over the whole thickness [Pa]
  constexpr double kTransverse = 1e6;  // nothing bends here [Pa]
  Fabric fabric;
  fabric.thickness = kThickness;
  fabric.areal_density = kArealDensity;
  fabric.tension = Curve{{0, 0.01}, {0, 0.01 * kModulus}};
  fabric.compression = fabric.tension;
  fabric.shear = law.table;
  fabric.transverse_shear_modulus = kTransverse;
  return fabric;
}

PulledStrip simulated(const ShearLaw& law, double width, double height, double to_mm) {
  PulledStrip strip =
      pull_strip({"", width, height, kBiasRate, {}, {}}, fabric_of(law), true, 1e-3 * to_mm, 1);
  if (!strip.failure.empty()) throw NotFinished(strip.failure);
  return strip;
}

/// Value of a simulated history at a displacement.
double at_mm(const std::vector<Eigen::Vector2d>& history, double mm) {
  return curve_through(history)(1e-3 * mm);
}

std::vector<Eigen::Vector2d> in_units(const std::vector<Eigen::Vector2d>& history, double y_unit) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& point : history) points.emplace_back(1e3 * point.x(), y_unit * point.y());
  return points;
}

template <size_t N>
std::vector<Eigen::Vector2d> points_of(const std::array<double, N>& x, const std::array<double, N>& y) {
  std::vector<Eigen::Vector2d> points;
  for (size_t k = 0; k < N; ++k) points.emplace_back(x[k], y[k]);
  return points;
}

/// The bias test to its law, and the law against the picture frame.
Findings compare_laws() {
  constexpr double kLawShare = 0.15;
  const ShearLaw law = bias_law();
  Findings result;
  for (size_t k = 0; k < kBiasAngle.size(); ++k)
    result.rows.push_back(within_share(
        fmt::format("law from bias extension: shear force at {} deg", kBiasAngle[k]), "N/mm", kBiasShear[k],
        shear_force(law, kBiasAngle[k]), kLawShare, "Cao and others 2008, Eq. 18 on Fig. 40"));
  Chart chart{.title = "Picture frames of seven laboratories, and the law from bias extension",
              .x_label = "shear angle [deg]",
              .y_label = "shear force per length [N/mm]",
              .series = {},
              .side_legend = true};
  for (size_t k = 0; k < kBiasAngle.size(); ++k) {
    const double degrees = kFrameAngle[k];
    result.rows.push_back(
        across_tests(fmt::format("law from bias extension: force of the picture frame at {} deg", degrees),
                     "N/mm", degrees, kFrames[0].force[k], shear_force(law, degrees),
                     spread(degrees, [&](const ShearLaw& of) { return shear_force(of, degrees); }), kFig28));
  }
  for (const Laboratory& laboratory : kFrames)
    chart.series.push_back(
        {.name = laboratory.name, .points = points_of(kFrameAngle, laboratory.force), .marks = true});
  ChartSeries ours{.name = "bias extension", .points = {}};
  for (double degrees = 0; degrees <= law.measured_to / kDegree; degrees += 1)
    ours.points.emplace_back(degrees, shear_force(law, degrees));
  chart.series.push_back(std::move(ours));
  result.figures.push_back(
      {"Twintex: normalised shear force of the picture frames (Fig. 28) and the law that comes "
       "from HKUST's bias extension (Fig. 40).",
       line_chart(chart)});
  return result;
}

/// Displacements of the test up to the angle to which its kinematics hold [mm].
std::vector<size_t> compared_points() {
  std::vector<size_t> points;
  constexpr double kFirst = 5;  // [mm]: before, the clamps still gain speed
  for (size_t k = 0; k < kBiasWay.size(); ++k) {
    const double angle = bias_angle(1e-3 * kBiasWay[k], kBiasHeight - kBiasWidth);
    if (kBiasWay[k] >= kFirst && angle <= kValidTo * kDegree) points.push_back(k);
  }
  return points;
}

ReportFigure force_figure(const std::string& from, const PulledStrip& strip) {
  Chart chart{.title = "Bias extension with the law from " + from,
              .x_label = "displacement [mm]",
              .y_label = "force [N]",
              .series = {}};
  ChartSeries measured{.name = "measured", .points = {}, .dots = true};
  for (size_t k = 0; k < kBiasWay.size() && kBiasWay[k] <= 30; ++k)
    measured.points.emplace_back(kBiasWay[k], kBiasForce[k]);
  chart.series = {measured, {.name = "simulated", .points = in_units(strip.force, 1)}};
  return {
      fmt::format("Twintex, 115 x 230 mm: force of HKUST (Fig. 40), and of the strip simulated with the law "
                  "from {}.",
                  from),
      line_chart(chart)};
}

constexpr double kPulled = 30;  // [mm]

Findings compare_strip_of_bias_law() {
  const PulledStrip strip = simulated(bias_law(), kBiasWidth, kBiasHeight, kPulled);
  Findings result;
  for (const size_t k : compared_points())
    result.rows.push_back(within_share(
        fmt::format("strip simulated with the law from bias extension: force at {} mm", kBiasWay[k]), "N",
        kBiasForce[k], at_mm(strip.force, kBiasWay[k]), kForceShare, kFig40));
  constexpr double kWhere = 25;  // [mm]
  ValidationRow other{fmt::format("the same, force at {} mm in another figure", kWhere),
                      "N",
                      kOtherForceAt25,
                      at_mm(strip.force, kWhere),
                      0,
                      "Cao and others 2008, Fig. 38",
                      "none"};
  other.judged = false;
  other.why = "the paper has two forces for one test";
  result.rows.push_back(std::move(other));
  result.figures.push_back(force_figure("bias extension", strip));
  return result;
}

Findings compare_strip_of_frame_law() {
  const PulledStrip strip = simulated(frame_law(kFrames[0]), kBiasWidth, kBiasHeight, kPulled);
  Findings result;
  for (const size_t k : compared_points()) {
    const double mm = kBiasWay[k], degrees = bias_angle(1e-3 * mm, kBiasHeight - kBiasWidth) / kDegree;
    result.rows.push_back(
        across_tests(fmt::format("strip simulated with the law from the picture frame: force at {} mm", mm),
                     "N", degrees, kBiasForce[k], at_mm(strip.force, mm),
                     spread(degrees, [&](const ShearLaw& law) { return predicted_force(law, mm); }), kFig40));
  }
  result.figures.push_back(force_figure("HKUST's picture frame", strip));
  return result;
}

Findings compare_angles() {
  constexpr double kTo = 80;            // [mm]
  constexpr double kFormula = 0.01;     // [deg]: figures have two decimals
  constexpr double kAngleShare = 0.01;  // as for other fabrics, tests/verification/bias_extension_test.cpp
  const PulledStrip strip = simulated(frame_law(kFrames[0]), kAngleWidth, kAngleHeight, kTo);
  Findings result;
  for (size_t k = 0; k < kTheoryAngle.size(); ++k) {
    const double mm = 10 * double(k + 1);
    result.rows.push_back({fmt::format("angle from the crosshead at {} mm", mm), "deg", kTheoryAngle[k],
                           bias_angle(1e-3 * mm, kAngleHeight - kAngleWidth) / kDegree, kFormula, kFig36,
                           ""});
  }
  for (size_t k = 0; k < kTheoryAngle.size() && 10 * double(k + 1) < kTo; ++k) {
    const double mm = 10 * double(k + 1);
    result.rows.push_back(within_share(fmt::format("simulated strip, angle in the middle at {} mm", mm),
                                       "deg", kTheoryAngle[k], at_mm(strip.angle, mm) / kDegree, kAngleShare,
                                       std::string(kFig36) + ", theory"));
  }
  for (size_t k = 0; k < kHandWay.size() && kHandWay[k] < kTo; ++k) {
    ValidationRow row{fmt::format("simulated strip, angle in the middle at {} mm", kHandWay[k]),
                      "deg",
                      kHandAngle[k],
                      at_mm(strip.angle, kHandWay[k]) / kDegree,
                      0,
                      std::string(kFig36) + ", measured by hand",
                      "none"};
    row.judged = false;
    row.why = "the paper does not say how exact its protractor is";
    result.rows.push_back(std::move(row));
  }
  Chart chart{.title = "Shear angle in the middle of a bias-extension strip",
              .x_label = "displacement [mm]",
              .y_label = "shear angle [deg]",
              .series = {}};
  chart.series = {{.name = "measured by hand", .points = points_of(kHandWay, kHandAngle), .dots = true},
                  {.name = "simulated", .points = in_units(strip.angle, 1 / kDegree)}};
  result.figures.push_back(
      {"Twintex, 150 x 450 mm (Fig. 36). Beyond 30 degrees the fabric slips and bends: an angle "
       "from the crosshead is too large there.",
       line_chart(chart)});
  return result;
}

}  // namespace

void add_twintex_comparisons(std::vector<Comparison>& comparisons) {
  const auto add = [&](std::string name, std::function<Findings()> compare) {
    comparisons.push_back({"Twintex", std::move(name), std::move(compare)});
  };
  add("laws", compare_laws);
  add("strip with the law from bias extension", compare_strip_of_bias_law);
  add("strip with the law from the picture frame", compare_strip_of_frame_law);
  add("angle in the middle of a strip", compare_angles);
}

}  // namespace drapeplan
