// reach: how close the rig can come to its targets at all.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "planner/cli/cli.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/drape/problem.hpp"
#include "planner/reach/reach.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr int kRandomStarts = 2;  // beside the targets; their agreement is reported as start_spread

struct ReachOptions {
  CommonOptions common;
  std::string file;
};

json result_json(const ReachProblem& problem, const ReachResult& reach) {
  json positions = json::array();
  for (const Eigen::Vector3d& p : reach.positions) positions.push_back({p.x(), p.y(), p.z()});
  return {{"floor_max", reach.floor_max},           {"floor_rms", reach.floor_rms},
          {"per_gripper", reach.per_gripper},       {"positions", std::move(positions)},
          {"link_violation", reach.link_violation}, {"start_spread", reach.start_spread},
          {"converged", reach.converged},           {"status", reach.status},
          {"wall_seconds", reach.wall_seconds},     {"meaning", explain_reach(problem, reach)}};
}

/// The distances as a map of the grid, seen from above: j upwards, i to the right.
std::string result_text(const ReachProblem& problem, const ReachResult& reach) {
  std::string text =
      fmt::format("smallest possible distance to the targets: r.m.s. {:.2f} mm, largest {:.2f} mm\n\n",
                  1e3 * reach.floor_rms, 1e3 * reach.floor_max);
  text += "  distance [mm] of gripper [i, j] at the r.m.s. optimum\n";
  for (int j = problem.rig.rows - 1; j >= 0; --j) {
    text += fmt::format("  j = {:<3}", j + 1);
    for (int i = 0; i < problem.rig.columns; ++i)
      text += fmt::format("{:8.2f}", 1e3 * reach.per_gripper[size_t(j * problem.rig.columns + i)]);
    text += '\n';
  }
  text += "  i =    ";
  for (int i = 0; i < problem.rig.columns; ++i) text += fmt::format("{:8}", i + 1);
  return fmt::format("{}\n\n{}\n", text, explain_reach(problem, reach));
}

int reach(const ReachOptions& options) {
  const Case definition = load_case(options.file, options.common, {"grippers"});
  OutputFolder out = take_folder(options.common, "reach");
  const MapResult map = map_case(definition);
  print_warnings(map_warnings(definition, map), options.common);
  const ReachProblem problem = reach_problem_of(definition, map.targets);
  const ReachResult result = solve_reach(problem, kRandomStarts, definition.optimise.seed);
  begin_output(out, options.common);
  deliver(result_json(problem, result), result_text(problem, result), options.common, &definition);
  if (!result.converged) throw NotFinished("not converged: " + result.status);
  return kDone;
}

}  // namespace

void add_reach(CLI::App& program, Action& action) {
  add_verb<ReachOptions>(
      program, action, "reach", "how close the grippers can come to their targets, whatever the schedule",
      [](CLI::App& verb, ReachOptions& options) {
        verb.add_option("CASE", options.file, "case file")->required();
      },
      reach);
}

}  // namespace drapeplan
