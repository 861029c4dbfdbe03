#include "planner/diagnosis/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "planner/drape/run_checks.hpp"

namespace drapeplan {
namespace {

/// The checks that say that a figure may be wrong; the others are about the rig.
constexpr std::array<std::string_view, 5> kDoubts{"kinetic", "damping", "hourglass", "waves", "penetration"};

std::string doubts_text(const DrapeProblem& problem, const PlanResult& result) {
  std::vector<std::string> doubts;
  for (const RunWarning& warning : run_warnings(problem, result.best, result.search.best_fidelity)) {
    if (std::find(kDoubts.begin(), kDoubts.end(), warning.check) != kDoubts.end())
      doubts.emplace_back(warning.check);
  }
  if (doubts.empty()) return {};
  return fmt::format(" The figures of this run are doubtful: it did not pass the {} {}, see the warnings.",
                     doubts.size() == 1 ? "check" : "checks", fmt::join(doubts, ", "));
}

std::string plants_text(const PlantSpread& spread, const ScoreOptions& options, bool accepted) {
  const int kept = accepted_plants(spread, options), plants = spread.plants();
  if (kept == 0) return fmt::format(" In none of {} plants that differ a little it is accepted.", plants);
  return fmt::format(" In {} of {} plants that differ a little it is {}accepted.", kept, plants,
                     accepted ? "still " : "");
}

}  // namespace

std::string within_reach_text(const FloorFront& front, double floor_max, const ScoreOptions& options) {
  // A point at a tighter edge is a shape that keeps the tolerance of the edge, too.
  const FloorPoint* point = nullptr;
  for (const FloorPoint& one : front.points) {
    if (!one.converged || one.boundary_tolerance > options.target_boundary_offset) continue;
    if (point == nullptr || one.gap < point->gap) point = &one;
  }
  if (point == nullptr || point->gap > options.target_gap) return {};
  return fmt::format(
      "The rig does not forbid it: with its edge within {:g} mm a ply whose fibres stretch by 1 % at most "
      "can "
      "come within {:.1f} mm of the mold, and all grippers can come within {:.1f} mm of their targets at "
      "once. "
      "What is missing is for the schedule, friction and force to bring.",
      1e3 * point->boundary_tolerance, 1e3 * point->gap, 1e3 * floor_max);
}

int accepted_plants(const PlantSpread& spread, const ScoreOptions& options) {
  return int(std::count_if(spread.pairs.begin() + 1, spread.pairs.end(), [&](const DisturbedPair& pair) {
    return pair.best.valid && pair.best.max_gap <= options.target_gap &&
           pair.best.max_boundary_offset <= options.target_boundary_offset;
  }));
}

std::string verdict_text(const DrapeProblem& problem, const PlanResult& result, const PlanTrust& trust) {
  const ScoreOptions& options = problem.definition().score;
  const Acceptance acceptance = acceptance_of(problem, result.best, result.search.best_fidelity);
  std::string text = acceptance_text(acceptance);
  if (!result.best.score.valid) return text;
  if (!acceptance.accepted() && !acceptance.pressed) {
    std::string limit = out_of_reach_text(problem, acceptance);
    if (limit.empty())
      limit = within_reach_text(problem.ply_floor().front, problem.reach().floor_max, options);
    if (!limit.empty()) text += " " + limit;
  }
  // Plants are scored as the objective is: not at the end of a press.
  if (trust.spread && !acceptance.pressed) text += plants_text(*trust.spread, options, acceptance.accepted());
  return text + doubts_text(problem, result);
}

std::string best_force_text(const DrapeProblem& problem, const PlanResult& result) {
  const Case& definition = problem.definition();
  return force_text(result.best.score, definition.grippers->actuator_force_limit,
                    definition.score.lag_tolerance);
}

}  // namespace drapeplan
