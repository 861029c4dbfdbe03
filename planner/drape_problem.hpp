// A case made ready to be simulated: mapping, reach, models of all fidelities, and one evaluation as a pure
// function.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/simulate.hpp"
#include "planner/case.hpp"
#include "planner/evaluation_log.hpp"
#include "planner/map_result.hpp"
#include "planner/reach.hpp"
#include "planner/strategy.hpp"

namespace drapeplan {

/// The fidelity at which results are claimed; every case has it.
inline constexpr const char* kReport = "report";

/// The FE scene of a case at a fidelity: sections that are absent add nothing.
/// @throws std::invalid_argument if the scene cannot be built.
Scene scene_of(const Case& value, const FemOptions& options);

/// The reach problem of a case with grippers. @param targets  mapped places of the pads [m].
ReachProblem reach_problem_of(const Case& value, const std::vector<Eigen::Vector3d>& targets);

/// One simulated drape with its score.
struct Drape {
  RunResult run;
  Score score;
  std::vector<double> separation;  ///< per node [m]
  std::vector<Snapshot> frames;    ///< equally spaced in time, as many as were asked for
};

/// A part of a run: from a saved state, and up to a pause [s, schedule's clock]; see RunRequest.
struct RunPart {
  const State* from = nullptr;
  double pause = 0;
};

/// Const after construction; shared by all threads.
class DrapeProblem {
 public:
  /// Maps the ply, solves the reach problem and builds the models.
  /// @param value  needs mold, mapping and grippers.
  /// @throws std::domain_error if the ply cannot be mapped, std::invalid_argument if a model cannot be built.
  explicit DrapeProblem(Case value);

  [[nodiscard]] const Case& value() const { return case_; }
  [[nodiscard]] const MapResult& mapping() const { return map_; }
  [[nodiscard]] const ReachProblem& reach_problem() const { return reach_problem_; }
  [[nodiscard]] const ReachResult& reach() const { return reach_; }
  [[nodiscard]] const SequenceFrame& frame() const { return frame_; }
  [[nodiscard]] const Model& model(const std::string& fidelity) const { return *models_.at(fidelity); }

  /// Runs a schedule. Never throws for a schedule that fits the rig: a failed run is an invalid score.
  [[nodiscard]] Drape run(const Schedule& schedule, const std::string& fidelity, int frames = 0,
                          RunPart part = {}) const;

 private:
  Case case_;
  MapResult map_;
  ReachProblem reach_problem_;
  ReachResult reach_;
  SequenceFrame frame_;
  std::map<std::string, std::unique_ptr<const Model>> models_;
};

}  // namespace drapeplan
