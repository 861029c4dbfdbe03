// Strips whose bending is not linear: a softening one of another program, and two moduli.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/characterise/beam.hpp"
#include "planner/report/charts.hpp"
#include "planner/validate/shell_problems.hpp"
#include "planner/validate/softening_strip.hpp"
#include "planner/validate/validate.hpp"

namespace drapeplan {
namespace {

using softening_strip::kPlaces;
using softening_strip::Place;

constexpr double kShare = 0.01;  // of the reference
constexpr const char* kBendstiff = "bendstiff (github.com/phbroberg/bendstiff)";
constexpr const char* kTwoModuli = "t^3/12 4 Et Ec/(sqrt Et + sqrt Ec)^2 (Timoshenko)";

/// Law of the strip, from the tip, where nothing bends, to the clamp.
BendingLaw softening_law() {
  BendingLaw law;
  for (size_t k = kPlaces.size(); k-- > 0;) {
    law.strain.push_back(kPlaces[k].moment);
    law.stress.push_back(kPlaces[k].curvature);
  }
  return law;
}

/// Its law in, its shape out.
Findings compare_softening_strip() {
  const StripAtRest strip = strip_at_rest(softening_law(), softening_strip::kLength, softening_strip::kLoad);
  const Place &clamp = kPlaces.front(), &tip = kPlaces.back();
  const Eigen::Vector2d ours = strip.places.back();
  Findings result{
      {within_share("softening strip, from its law: tip, along", "m", tip.x, ours.x(), kShare, kBendstiff),
       within_share("softening strip, from its law: tip, down", "m", -tip.y, -ours.y(), kShare, kBendstiff),
       within_share("softening strip, from its law: moment at the clamp", "N", clamp.moment,
                    strip.moment.front(), kShare, kBendstiff)}};
  Chart chart{.title = "A strip that softens", .x_label = "x [mm]", .y_label = "y [mm]", .series = {}};
  ChartSeries theirs{.name = "bendstiff", .points = {}, .dots = true}, shape{.name = "ours", .points = {}};
  for (const Place& place : kPlaces) theirs.points.emplace_back(1e3 * place.x, 1e3 * place.y);
  for (const Eigen::Vector2d& place : strip.places) shape.points.emplace_back(1e3 * place);
  chart.series = {theirs, shape};
  result.figures.push_back(
      {"A heavy cantilever of 250 mm whose bending stiffness falls by two orders of magnitude "
       "towards the clamp: the shape that another program finds, and ours from the same law.",
       line_chart(chart)});
  return result;
}

/// Its shape in, its law out.
Findings compare_softening_shape() {
  constexpr int kPieces = 25;             // of the law, two places each
  constexpr double kStraight = 0.03;      // where the moment is less, the strip is as good as straight [N]
  constexpr double kRms = 4, kMost = 12;  // [%]: where the law turns sharply, its pieces cut the corner
  std::vector<Eigen::Vector2d> places;
  for (const Place& place : kPlaces) places.emplace_back(place.x, place.y);
  const BendingLaw law = bending_law_of_profile(places, softening_strip::kLoad, kPieces);
  const Place &clamp = kPlaces.front(), &tip = kPlaces.back();
  Findings result{{within_share("softening strip, from its shape: moment at the clamp", "N", clamp.moment,
                                law.strain.back(), kShare, kBendstiff)}};
  double squares = 0, largest = 0;
  int count = 0;
  for (const Place& place : kPlaces) {
    if (place.moment < kStraight) continue;
    const double missed = 100 * (law(place.moment) / place.curvature - 1);
    squares += missed * missed, ++count;
    largest = std::max(largest, std::abs(missed));
  }
  const std::string all = fmt::format("softening strip, from its shape: curvature at {} moments, ", count);
  result.rows.push_back({all + "r.m.s. error", "%", 0, std::sqrt(squares / count), kRms, kBendstiff, ""});
  result.rows.push_back({all + "largest error", "%", 0, largest, kMost, kBendstiff, ""});
  result.rows.push_back(within_share(
      "softening strip, from the law of its shape: tip, down", "m", -tip.y,
      strip_at_rest(law, softening_strip::kLength, softening_strip::kLoad).tip(), kShare, kBendstiff));
  Chart chart{.title = "Its law from its shape",
              .x_label = "curvature [1/m]",
              .y_label = "moment per width [N]",
              .series = {},
              .log_x = true};
  ChartSeries theirs{.name = "bendstiff", .points = {}, .dots = true}, ours{.name = "ours", .points = {}};
  for (const Place& place : kPlaces) theirs.points.emplace_back(place.curvature, place.moment);
  for (size_t k = 0; k < law.strain.size(); ++k) ours.points.emplace_back(law.stress[k], law.strain[k]);
  chart.series = {theirs, ours};
  result.figures.push_back(
      {"The same strip the other way round: moment over curvature from the shape alone.", line_chart(chart)});
  return result;
}

/// Fibres with two moduli: the section's law, elements, and a heavy strip of them.
Findings compare_two_moduli(double ratio) {
  constexpr double kModulus = 10e9, kThickness = 0.3e-3, kCurvature = 5;  // [Pa], [m], [1/m]
  constexpr double kBeta = 4, kDrop = 0.42516;                            // heavy elastica
  constexpr int kPoints = 5, kElements = 16;
  const Sheet sheet{kModulus, kThickness, 1, 1 / ratio};
  const Fabric fabric = sheet.fabric();
  const double moment =
      section_moment(fabric.tension.slowest(), fabric.compression.slowest(), kThickness, kCurvature);
  const std::string of = fmt::format("two moduli, Et/Ec = {:g}: ", ratio);
  return {{within_share(of + "stiffness of the section", "N mm", 1e3 * sheet.bending_stiffness(),
                        1e3 * moment / kCurvature, kShare, kTwoModuli),
           within_share(of + "stiffness of elements with 5 points, over the exact one", "", 1,
                        stiffness_of_two_moduli(ratio, kPoints), kShare, kTwoModuli),
           within_share(of + "drop/L of a heavy strip of elements, w L^3/D = 4", "", kDrop,
                        drop_under_weight(kBeta, kElements, ratio, kPoints), kShare,
                        "heavy elastica with D of the two moduli")}};
}

}  // namespace

void add_bending_comparisons(std::vector<Comparison>& comparisons) {
  comparisons.push_back({"bending", "softening strip", compare_softening_strip});
  comparisons.push_back({"bending", "softening strip, its law from its shape", compare_softening_shape});
  for (const double ratio : {4.0, 10.0})
    comparisons.push_back({"bending", "two moduli", [=] { return compare_two_moduli(ratio); }});
}

}  // namespace drapeplan
