#include "planner/drape/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fem/mesh/mesh.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

double share_above(const Mesh& mesh, const std::vector<double>& gap, double allowed) {
  const std::vector<double> areas = nodal_areas(mesh);
  double area = 0, above = 0;
  for (size_t n = 0; n < areas.size(); ++n) {
    area += areas[n];
    if (gap[n] > allowed) above += areas[n];
  }
  return above / area;
}

std::string missed(const Tolerance& tolerance) {
  const double share = 1e2 * tolerance.share;
  return fmt::format("{} is {:.2f} mm where {:g} mm is allowed ({} % {})", tolerance.what,
                     1e3 * tolerance.value, 1e3 * tolerance.allowed,
                     share < 10 ? fmt::format("{:.2g}", share) : fmt::format("{:.0f}", share),
                     tolerance.beyond);
}

std::string kept(const Tolerance& tolerance) {
  return fmt::format("{} is {:.2f} mm of {:g} mm allowed", tolerance.what, 1e3 * tolerance.value,
                     1e3 * tolerance.allowed);
}

}  // namespace

const Score& last_score(const Drape& drape) {
  return drape.other && !drape.other->before ? drape.other->score : drape.score;
}

bool Acceptance::accepted() const {
  return !tolerances.empty() &&
         std::all_of(tolerances.begin(), tolerances.end(), [](const Tolerance& t) { return t.kept(); });
}

Acceptance acceptance_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity) {
  const Score& score = last_score(drape);
  Acceptance result;
  result.pressed = drape.other.has_value();
  if (!score.valid) {
    result.reason = score.reason;
    return result;
  }
  const Case& definition = problem.definition();
  const ScoreOptions& options = definition.score;
  const Mesh& mesh = problem.model(fidelity).scene().mesh;
  const std::vector<Eigen::Vector3d> edge = ply_edge(mesh, drape.run.final, definition.material.thickness);
  result.tolerances = {{"max_gap", "the largest gap", "of the ply lies higher", score.max_gap,
                        options.target_gap, share_above(mesh, drape.gap, options.target_gap)},
                       {"max_boundary_offset", "the largest offset of the edge", "of the edge is farther off",
                        score.max_boundary_offset, options.target_boundary_offset,
                        share_beyond(edge, problem.mapping().boundary, options.target_boundary_offset)}};
  return result;
}

const FloorPoint* out_of_reach(const FloorFront& front, double gap, double edge) {
  // A looser edge has a lower floor: the tightest one that is not tighter than the tolerance bounds it from
  // below.
  const FloorPoint* tightest = nullptr;
  for (const FloorPoint& point : front.points) {
    if (!point.converged || point.boundary_tolerance < edge) continue;
    if (tightest == nullptr || point.boundary_tolerance < tightest->boundary_tolerance) tightest = &point;
  }
  return tightest != nullptr && tightest->gap > gap ? tightest : nullptr;
}

std::string acceptance_text(const Acceptance& acceptance) {
  if (acceptance.tolerances.empty()) return fmt::format("Not accepted: {}.", acceptance.reason);
  const bool accepted = acceptance.accepted();
  std::vector<std::string> parts;
  for (const Tolerance& tolerance : acceptance.tolerances) {
    if (accepted)
      parts.push_back(kept(tolerance));
    else if (!tolerance.kept())
      parts.push_back(missed(tolerance));
  }
  return fmt::format("{}: {}{}.", accepted ? "Accepted" : "Not accepted",
                     acceptance.pressed ? "after pressing " : "", fmt::join(parts, ", and "));
}

std::string out_of_reach_text(const DrapeProblem& problem, const Acceptance& acceptance) {
  if (acceptance.accepted() || acceptance.pressed) return {};
  const ScoreOptions& options = problem.definition().score;
  const FloorPoint* floor =
      out_of_reach(problem.ply_floor().front, options.target_gap, options.target_boundary_offset);
  if (floor == nullptr) return {};
  const std::string edge = std::isfinite(floor->boundary_tolerance)
                               ? fmt::format("with its edge within {:g} mm", 1e3 * floor->boundary_tolerance)
                               : "wherever its edge lies";
  return fmt::format(
      "No schedule of this rig keeps both: {}, a ply whose fibres stretch by 1 % at most keeps a gap of "
      "{:.1f} mm somewhere. Change the rig, press the ply, or allow more.",
      edge, 1e3 * floor->gap);
}

nlohmann::json acceptance_json(const Acceptance& acceptance) {
  nlohmann::json parts = nlohmann::json::array();
  for (const Tolerance& t : acceptance.tolerances)
    parts.push_back({{"part", t.key},
                     {"value", t.value},
                     {"tolerance", t.allowed},
                     {"kept", t.kept()},
                     {"share_beyond", t.share}});
  return {{"accepted", acceptance.accepted()}, {"pressed", acceptance.pressed}, {"tolerances", parts}};
}

}  // namespace drapeplan
