#include "planner/reach/reach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "planner/reach/ipopt.hpp"
#include "planner/reach/nlp.hpp"

namespace drapeplan {
namespace {

using Places = std::vector<Eigen::Vector2d>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSatisfied = 1e-12;     // [spacing]: targets that keep all constraints to round-off
constexpr double kLinkTolerance = 1e-6;  // [m]: a solution that misses more than this is none
// [spacing]: largest shift of a pad, per axis, for a random start. Where neighbours change sides the trellis
// folds over itself: local minima of their own, with floors ten times as large. Shifts of 0.5 lead to such
// ones.
constexpr double kPerturbation = 0.15;
constexpr double kNegligible = 1e-4;  // [m]: finer than a ply is ever placed
constexpr double kSameFloor = 1e-6;   // [m]: floors that differ by less are the same local solution

/// Best of several local solutions.
struct Best {
  IpoptOutcome outcome;
  double value = kNaN;  ///< square root of the objective [m]
  double spread = 0;    ///< largest difference of `value` between the starts that converged [m]
  int solved = 0, agreed = 0;
};

/// Why the problem cannot be posed; empty if it can.
std::string check_reach(const ReachProblem& problem) {
  const RigOptions& rig = problem.rig;
  if (rig.columns < 0 || rig.rows < 0) return "negative number of grippers";
  if (int(problem.targets.size()) != rig.count()) {
    return fmt::format("{} targets for {} grippers", problem.targets.size(), rig.count());
  }
  if (rig.count() > 0 && !(rig.spacing > 0 && std::isfinite(rig.spacing)))
    return "the spacing is not positive";
  if (!std::isfinite(rig.joint_offset + problem.ply_thickness)) return "the joint offset is not finite";
  if (rig.fixed) {
    const auto [i, j] = *rig.fixed;
    if (i < 1 || i > rig.columns || j < 1 || j > rig.rows) return "the fixed gripper is not one of the rig";
    if (!problem.fixed_place.allFinite()) return "the place of the fixed joint is not finite";
  }
  for (int k = 0; k < rig.count(); ++k) {
    const Eigen::Vector3d& target = problem.targets[size_t(k)];
    if (target.allFinite() && problem.mold.normal(target.x(), target.y()).allFinite()) continue;
    return "the mold is not defined at the target of gripper " + rig.name(k);
  }
  return "";
}

Places target_places(const ReachProblem& problem) {
  Places places;
  for (const Eigen::Vector3d& target : problem.targets) places.emplace_back(target.head<2>());
  return places;
}

/// The targets, then the targets with every pad shifted at random. Own mapping of the generator's bits to
/// [-1, 1): the library's distributions differ between compilers.
std::vector<Places> starts(const ReachProblem& problem, int random_starts, unsigned seed) {
  std::mt19937 bits(seed);
  const auto uniform = [&bits] { return double(bits()) / 2147483648.0 - 1; };
  std::vector<Places> all{target_places(problem)};
  for (int k = 0; k < random_starts; ++k) {
    Places shifted = all.front();
    for (Eigen::Vector2d& place : shifted) {
      const double dx = uniform(), dy = uniform();
      const Eigen::Vector2d moved = place + kPerturbation * problem.rig.spacing * Eigen::Vector2d(dx, dy);
      if (problem.mold.normal(moved.x(), moved.y()).allFinite()) place = moved;
    }
    all.push_back(shifted);
  }
  return all;
}

Best best_of(const ReachProblem& problem, const ReachNlp& nlp, const std::vector<Places>& from) {
  Best best;
  std::vector<double> values;
  for (const Places& places : from) {
    IpoptOutcome outcome = minimise(nlp, nlp.variables_at(places));
    const double violation = nlp.violation(outcome.variables);
    const bool solved = outcome.converged && violation * problem.rig.spacing <= kLinkTolerance;
    const double value = std::sqrt(std::max(0.0, nlp.objective(outcome.variables))) * problem.rig.spacing;
    if (solved) values.push_back(value);
    const bool better = values.empty() ? best.outcome.variables.size() == 0 ||
                                             violation < nlp.violation(best.outcome.variables)
                                       : solved && (values.size() == 1 || value < best.value);
    if (!better) continue;
    best.outcome = std::move(outcome);
    best.outcome.converged = solved;
    best.value = solved ? value : kNaN;
  }
  best.solved = int(values.size());
  if (values.empty()) return best;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  best.spread = *high - *low;
  best.agreed =
      int(std::count_if(values.begin(), values.end(), [&](double v) { return v <= *low + kSameFloor; }));
  return best;
}

double largest_link_error(const ReachProblem& problem, const std::vector<Eigen::Vector3d>& joints) {
  double error = 0;
  const auto pairs = interlinks(problem.rig);
  for (size_t k = 0; k < pairs.size() && !problem.rig.interlinks->stiffness; ++k) {
    const double over =
        (joints[size_t(pairs[k][1])] - joints[size_t(pairs[k][0])]).norm() - interlink_length(problem.rig, k);
    error =
        std::max({error, over - problem.rig.interlinks->play[1], -over - problem.rig.interlinks->play[0]});
  }
  return error;
}

std::vector<Eigen::Vector3d> joints_at(const ReachProblem& problem, const Places& places) {
  std::vector<Eigen::Vector3d> joints;
  for (const Eigen::Vector2d& p : places) {
    joints.emplace_back(problem.mold.point(p.x(), p.y()) +
                        (problem.rig.joint_offset + problem.ply_thickness) *
                            problem.mold.normal(p.x(), p.y()));
  }
  return joints;
}

void set_positions(const ReachProblem& problem, const Places& places, ReachResult& result) {
  result.joints = joints_at(problem, places);
  for (size_t k = 0; k < places.size(); ++k) {
    result.positions.push_back(problem.mold.point(places[k].x(), places[k].y()));
    result.per_gripper.push_back((result.positions.back() - problem.targets[k]).norm());
  }
  result.link_violation = largest_link_error(problem, result.joints);
}

/// Solves again with one part of the rig changed, from the targets and from the solution.
ReachCauses find_causes(const ReachProblem& problem, const Places& solution) {
  const std::vector<Places> from{target_places(problem), solution};
  ReachCauses causes;

  const std::vector<Eigen::Vector3d> ideal = joints_at(problem, from.front());
  for (const auto& [i, j] : interlinks(problem.rig)) {
    const double length = (ideal[size_t(j)] - ideal[size_t(i)]).norm();
    causes.shortest_link = causes.longest_link == 0 ? length : std::min(causes.shortest_link, length);
    causes.longest_link = std::max(causes.longest_link, length);
  }

  ReachProblem flush = problem;
  flush.rig.joint_offset = flush.ply_thickness = 0;
  causes.rms_flush = best_of(flush, ReachNlp(flush, ReachGoal::rms), from).value;

  ReachProblem unfixed = problem;
  unfixed.rig.fixed.reset();
  causes.rms_unfixed = best_of(unfixed, ReachNlp(unfixed, ReachGoal::rms), from).value;

  const auto& links = problem.rig.interlinks;
  const bool one_length = links && links->lengths.empty() && !links->has_play() && !links->stiffness &&
                          !interlinks(problem.rig).empty();
  const ReachNlp free_links(problem, ReachGoal::rms, one_length);
  const Best rescaled = best_of(problem, free_links, from);
  causes.rms_rescaled = rescaled.value;
  causes.link_scale = rescaled.solved > 0 ? free_links.link_scale(rescaled.outcome.variables) : kNaN;
  return causes;
}

/// Pads at their targets keep all constraints: nothing to solve.
bool targets_are_reachable(const ReachProblem& problem) {
  const ReachNlp nlp(problem, ReachGoal::rms);
  return nlp.violation(nlp.variables_at(target_places(problem))) <= kSatisfied;
}

ReachResult without_floors(ReachResult result, const std::string& why) {
  result.status = why;
  result.floor_rms = result.floor_max = kNaN;
  result.causes = {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  return result;
}

ReachResult find_floors(const ReachProblem& problem, int random_starts, unsigned seed) {
  ReachResult result;
  if (const std::string why = check_reach(problem); !why.empty()) return without_floors(result, why);
  if (problem.rig.count() == 0 || targets_are_reachable(problem)) {
    set_positions(problem, target_places(problem), result);
    result.converged = true;
    result.status = "the targets themselves are reachable";
    return result;
  }

  std::vector<Places> from = starts(problem, random_starts, seed);
  const ReachNlp rms(problem, ReachGoal::rms), max(problem, ReachGoal::max);
  const Best least_squares = best_of(problem, rms, from);
  const Places solution = rms.places_at(least_squares.outcome.variables);
  set_positions(problem, solution, result);
  if (least_squares.solved == 0) {
    const bool feasible =
        rms.violation(least_squares.outcome.variables) * problem.rig.spacing <= kLinkTolerance;
    const std::string& status = least_squares.outcome.status;
    return without_floors(
        result,
        feasible ? fmt::format("the rig fits the mold, but the search ended early ({})", status) : status);
  }

  from.push_back(solution);
  const Best minimax = best_of(problem, max, from);
  if (minimax.solved == 0) return without_floors(result, "largest distance: " + minimax.outcome.status);
  const Places other = max.places_at(minimax.outcome.variables);
  result.link_violation =
      std::max(result.link_violation, largest_link_error(problem, joints_at(problem, other)));

  result.converged = true;
  result.status = fmt::format("solved; {} of {} starts found the smallest r.m.s. distance",
                              least_squares.agreed, from.size() - 1);
  result.floor_rms = least_squares.value;
  result.floor_max = minimax.value;
  result.start_spread = least_squares.spread;
  result.start_spread_max = minimax.spread;
  result.causes = find_causes(problem, solution);
  return result;
}

std::string millimetres(double length) {
  return fmt::format("{:.1f} mm", 1e3 * length);
}

/// What remains of the floor without joint offset, without the fixed joint or with the best interlink length,
/// and which of the three is the main cause: the first without which less than half is left.
std::string explain_causes(const ReachProblem& problem, const ReachResult& result) {
  struct Change {
    double floor;
    std::string what, cause;
  };
  const ReachCauses& causes = result.causes;
  const double offset = problem.rig.joint_offset + problem.ply_thickness, spacing = problem.rig.spacing;
  const std::vector<Change> changes{
      {causes.rms_flush,
       fmt::format("joints at the mold's surface instead of {} above it", millimetres(offset)),
       "the joint offset"},
      {causes.rms_unfixed, "no joint fixed in-plane", "the fixed joint"},
      {causes.rms_rescaled,
       fmt::format("interlinks of {} instead of {}", millimetres(causes.link_scale * spacing),
                   millimetres(spacing)),
       "the length of the interlinks"},
  };
  const Change* main = nullptr;
  std::string text;
  for (const Change& change : changes) {
    if (!(change.floor < result.floor_rms - kNegligible)) continue;
    text += fmt::format(" With {} the r.m.s. floor would be {}.", change.what, millimetres(change.floor));
    if (main == nullptr && change.floor < 0.5 * result.floor_rms) main = &change;
  }
  if (main != nullptr) text += fmt::format(" So {} causes most of it.", main->cause);
  if (causes.longest_link > causes.shortest_link + kNegligible) {
    text += fmt::format(" All targets could be met only by interlinks of different lengths, {} to {}.",
                        millimetres(causes.shortest_link), millimetres(causes.longest_link));
  }
  return text;
}

/// Starts that disagree mean local minima, as of a folded trellis: the smallest one may not have been met.
std::string explain_spread(const ReachResult& result) {
  const double spread = std::max(result.start_spread, result.start_spread_max);
  if (spread <= kNegligible) return "";
  return fmt::format(
      " The starts of the search disagree by up to {}: a lower floor may exist, try more starts.",
      millimetres(spread));
}

}  // namespace

ReachResult solve_reach(const ReachProblem& problem, int random_starts, unsigned seed) {
  const auto begin = std::chrono::steady_clock::now();
  ReachResult result = find_floors(problem, random_starts, seed);
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

std::string explain_reach(const ReachProblem& problem, const ReachResult& result) {
  if (!result.converged) {
    std::string text = fmt::format("The floor of the rig was not found: {}.", result.status);
    if (result.link_violation > kLinkTolerance) {
      text += fmt::format(" At best an interlink's length is off by {}.", millimetres(result.link_violation));
    }
    return text;
  }
  if (result.floor_max <= kNegligible) return "The rig can put every pad on its target.";
  const auto worst = std::max_element(result.per_gripper.begin(), result.per_gripper.end());
  return fmt::format(
      "With its pads on the mold the rig cannot bring every one closer to its target than {} (largest "
      "distance), nor below {} r.m.s., whatever the schedule. In the best r.m.s. position gripper {} is "
      "farthest off, by {}.{}{}",
      millimetres(result.floor_max), millimetres(result.floor_rms),
      problem.rig.name(int(worst - result.per_gripper.begin())), millimetres(*worst),
      explain_causes(problem, result), explain_spread(result));
}

}  // namespace drapeplan
