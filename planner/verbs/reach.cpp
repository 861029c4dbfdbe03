// reach: how close the rig can come to its targets at all.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "mapping/error.hpp"
#include "planner/base/quantity.hpp"
#include "planner/drape/floor_changes.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/drape/problem.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/exports/mapped_files.hpp"
#include "planner/reach/reach.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr int kRandomStarts = 2;  // beside the targets; their agreement is reported as start_spread

struct ReachOptions {
  CommonOptions common;
  std::string file;
  std::string cell = "20 mm", tolerance = "10 mm";
  double fibre_strain = 0.01;
  bool changes = true;
};

/// What is known of the ply itself.
struct Floors {
  FloorProblem problem;
  FloorFront front;
  std::vector<ChangedFloor> changes;
  double tolerance = 0;  ///< of the changes [m]
};

double positive_length(const std::string& option, const std::string& text) {
  std::string fault;
  const std::optional<double> value = parse_quantity(text, Dimension::length, fault);
  if (!value) throw WrongInput(option + ": " + fault);
  if (!(*value > 0)) throw WrongInput(option + ": must be positive, not " + text);
  return *value;
}

Floors find_floors(const Case& definition, const MapResult& map, const ReachOptions& options) {
  const double cell = positive_length("--cell", options.cell);
  const double tolerance = positive_length("--tolerance", options.tolerance);
  Floors floors{floor_problem_of(definition, map, cell), {}, {}, tolerance};
  floors.problem.fibre_strain = options.fibre_strain;
  FloorOptions solving;
  solving.seed = definition.optimise.seed;
  floors.front = solve_floor(floors.problem, solving);
  if (options.changes)
    floors.changes = solve_changes(floor_changes(definition), tolerance, cell, options.fibre_strain);
  return floors;
}

/// The floor that the changes compare with.
const FloorPoint* point_at(const FloorFront& front, double tolerance) {
  for (const FloorPoint& point : front.points) {
    if (std::abs(point.boundary_tolerance - tolerance) <= 1e-9) return &point;
  }
  return nullptr;
}

std::string meaning_of(const Floors& floors) {
  std::string text = explain_floor(floors.problem, floors.front, floors.tolerance);
  const FloorPoint* point = point_at(floors.front, floors.tolerance);
  const std::string changed = point != nullptr ? explain_changes(*point, floors.changes) : "";
  return changed.empty() ? text : text + " " + changed;
}

void add_floors(const Floors& floors, json& result) {
  result["front"] = front_json(floors.front);
  result["fibre_strain"] = floors.problem.fibre_strain;
  result["front_meaning"] = meaning_of(floors);
  result["front_starts"] = {{"tried", floors.front.starts},
                            {"converged", floors.front.converged},
                            {"agreed", floors.front.agreed},
                            {"spread", floors.front.start_spread}};
  result["front_wall_seconds"] = floors.front.wall_seconds;
  json changes = json::array();
  for (const ChangedFloor& change : floors.changes) {
    FloorFront front;
    front.points = {change.point};
    changes.push_back({{"change", change.name}, {"words", change.words}, {"front", front_json(front)}});
  }
  result["changes"] = std::move(changes);
}

std::string floors_text(const Floors& floors) {
  std::string text = "\n" + front_table(floors.front);
  text += fmt::format("  {} of {} starts agree; {:.1f} s\n", floors.front.agreed, floors.front.starts,
                      floors.front.wall_seconds);
  if (!floors.changes.empty()) {
    text += fmt::format("\nsmallest possible largest gap [mm], edge within {:g} mm, with one change\n",
                        1e3 * floors.tolerance);
    for (const ChangedFloor& change : floors.changes) {
      text += change.point.converged ? fmt::format("  {:8.2f}  {}\n", 1e3 * change.point.gap, change.words)
                                     : fmt::format("         -  {}: {}\n", change.words, change.point.status);
    }
  }
  return text + "\n" + meaning_of(floors) + "\n";
}

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
  const Floors floors = find_floors(definition, map, options);
  begin_output(out, options.common);
  json document = result_json(problem, result);
  add_floors(floors, document);
  if (!options.common.out.empty()) write_reach(out.path(), problem, result);
  deliver(document, result_text(problem, result) + floors_text(floors), options.common, &definition);
  if (!result.converged) throw NotFinished("not converged: " + result.status);
  return kDone;
}

}  // namespace

void add_reach(CLI::App& program, Action& action) {
  add_verb<ReachOptions>(
      program, action, "reach",
      "how close grippers and ply can come to a perfect drape, whatever the schedule",
      [](CLI::App& verb, ReachOptions& options) {
        verb.add_option("CASE", options.file, "case file")->required();
        verb.add_option("--cell", options.cell, "cells of the net of the ply (default 20 mm)");
        verb.add_option("--tolerance", options.tolerance,
                        "boundary tolerance at which changes are tried (default 10 mm)");
        verb.add_option("--fibre-strain", options.fibre_strain,
                        "largest tensile strain of fibres (default 0.01)")
            ->check(CLI::Range(0.0, 1.0));
        verb.add_flag("!--no-changes", options.changes, "only the floors of the case as it is");
      },
      reach);
}

}  // namespace drapeplan
