// Published problems of shells that start flat, as a ply does.
#include <fmt/format.h>

#include <cmath>

#include "planner/validate/shell_problems.hpp"
#include "planner/validate/validate.hpp"

namespace drapeplan {
namespace {

constexpr int kElements = 16;    // along strips and across plates
constexpr double kShare = 0.01;  // of the published figure
constexpr const char* kSze = "Sze, Liu, Lo 2004 (the elastica: Mattiasson 1981)";

Findings compare_tip_force(double k, double up, double shortened) {
  const TipPlace tip = under_tip_force(k, kElements);
  const std::string load = fmt::format("strip under a tip force, P L^2/D = {:g}: ", k);
  return {{within_share(load + "W/L", "", up, tip.up, kShare, kSze),
           within_share(load + "U/L", "", shortened, 1 - tip.along, kShare, kSze)}};
}

Findings compare_roll_up() {
  const TipPlace tip = under_tip_moment(2 * kElements);
  return {{{"strip rolled up by M = 2 pi D/L: tip to root, of L", "", 0, std::hypot(tip.along, tip.up),
            kShare, kSze, "1 % of L"}}};
}

Findings compare_weight(double beta, double drop) {
  return {{within_share(fmt::format("heavy strip, w L^3/D = {:g}: drop/L", beta), "", drop,
                        drop_under_weight(beta, kElements), kShare, "heavy elastica, by shooting")}};
}

/// E = 0.69 GPa, 0.3 mm, 314 g/m^2, 150 mm long: w L^3/D = 6.6985.
Findings compare_codes() {
  constexpr double kBeta = 6.6985, kLength = 150;  // [-], [mm]
  const double drop = kLength * drop_under_weight(kBeta, kElements);
  const std::string what = "150 mm strip of 0.69 GPa: drop of the tip";
  return {{within_share(what, "mm", 88.217, drop, kShare, "CalculiX 2.20, 30 x 3 S8R, run for this project"),
           within_share(what, "mm", 88.220, drop, kShare, "OpenRadioss, QEPH, run for this project")}};
}

Findings compare_annulus() {
  constexpr double kAnnulusShare = 0.02;  // 4 x 24 elements; converging
  const auto [inner, outer] = lifted_annulus(4, 24);
  return {{within_share("slit annular plate, P = 0.8: W_A", "", 13.891, inner, kAnnulusShare, kSze),
           within_share("slit annular plate, P = 0.8: W_B", "", 17.528, outer, kAnnulusShare, kSze)}};
}

Findings compare_plate(PlateEdge edge, PlateLoad load, double published) {
  const std::string what =
      fmt::format("{} square plate, {}", edge == PlateEdge::supported ? "supported" : "clamped",
                  load == PlateLoad::uniform ? "uniform load: w D/(q a^4)" : "central force: w D/(P a^2)");
  return {{within_share(what, "", published, plate_deflection(edge, load, kElements, published), kShare,
                        "Timoshenko, Woinowsky-Krieger: Theory of Plates and Shells")}};
}

}  // namespace

void add_shell_comparisons(std::vector<Comparison>& comparisons) {
  const auto add = [&](std::string name, std::function<Findings()> compare) {
    comparisons.push_back({"shells", std::move(name), std::move(compare)});
  };
  add("slit annular plate", compare_annulus);  // the longest
  for (const auto& [k, up, shortened] :
       {std::array{1.0, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {4, 0.66996, 0.32894}})
    add("strip under a tip force", [=] { return compare_tip_force(k, up, shortened); });
  add("strip rolled up", compare_roll_up);
  for (const auto& [beta, drop] : {std::pair(1.0, 0.12347), {4.0, 0.42516}, {10.0, 0.70020}, {40.0, 0.89464}})
    add("heavy strip", [=] { return compare_weight(beta, drop); });
  add("heavy strip in other codes", compare_codes);
  using enum PlateEdge;
  using enum PlateLoad;
  for (const auto& [edge, load, published] :
       {std::tuple(supported, uniform, 0.00406235), std::tuple(supported, central, 0.01160),
        std::tuple(clamped, uniform, 0.00126532), std::tuple(clamped, central, 0.00560)})
    add("square plate", [=] { return compare_plate(edge, load, published); });
}

}  // namespace drapeplan
