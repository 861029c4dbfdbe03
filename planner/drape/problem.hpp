// A case made ready to be simulated: mapping, and one evaluation as a pure function. Models of fidelities and
// the reach floor are made when they are first asked for.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "fem/run/simulate.hpp"
#include "planner/case/case.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/reach/floor.hpp"
#include "planner/reach/reach.hpp"
#include "planner/schedule/strategy.hpp"
#include "planner/score/score.hpp"
#include "planner/score/score_fields.hpp"

namespace drapeplan {

/// The fidelity at which results are claimed; every case has it.
inline constexpr const char* kReport = "report";
/// Those that a search uses, where a case has them; the cheapest first.
inline constexpr std::array kSearched{"screen", "search"};

/// The FE scene of a case at a fidelity: sections that are absent add nothing.
/// @throws WrongInput if the scene cannot be built.
Scene scene_of(const Case& definition, const FemOptions& options);

/// The model of that scene. @throws also NotFinished, with the number of nodes, if the memory does not
/// suffice.
Model model_of(const Case& definition, const FemOptions& options);

/// The reach problem of a case with grippers. @param targets  mapped places of the pads [m].
ReachProblem reach_problem_of(const Case& definition, const std::vector<Eigen::Vector3d>& targets);

/// The floor of a case with grippers, on the mesh that a drape at this mesh size has, held where a drape is.
/// @param cell  mesh size [m].
/// @throws WrongInput if there is no such mesh.
FloorProblem floor_problem_of(const Case& definition, const MapResult& map, double cell = 0.020);

/// One simulated drape with its score.
struct Drape {
  RunResult run;
  Score score;                      ///< the one that the objective takes
  std::optional<OtherScore> other;  ///< where the ply was pressed
  std::vector<double> gap;          ///< per node [m]
  std::vector<Snapshot> frames;     ///< equally spaced in time, as many as were asked for
};

/// A part of a run: from a saved state, and up to a pause [s, schedule's clock]; see RunRequest.
struct RunPart {
  const State* from = nullptr;
  double pause = 0;
  bool press = true;  ///< where the case has a press
  int samples = 0;    ///< snapshots handed to `sample`, see RunRequest
  std::function<void(const Snapshot&)> sample = nullptr;
};

/// The best that any schedule could do with the ply, in numbers and in words.
struct PlyFloor {
  FloorFront front;  ///< without points if the ply has no net
  std::string meaning;
};

/// Shared by all threads: whoever asks first for a model or the reach floor makes it, the others wait for it.
class DrapeProblem {
 public:
  /// Maps the ply; where the schedule aims at reachable places, also solves the reach problem.
  /// @param value  needs mold, mapping and grippers.
  /// @throws NotFinished if the ply cannot be mapped, or not be reached where the schedule needs it.
  explicit DrapeProblem(Case definition);
  DrapeProblem(const DrapeProblem&) = delete;  // parts of it refer to others
  DrapeProblem& operator=(const DrapeProblem&) = delete;

  [[nodiscard]] const Case& definition() const { return case_; }
  [[nodiscard]] const MapResult& mapping() const { return map_; }
  [[nodiscard]] const ReachProblem& reach_problem() const { return reach_problem_; }
  [[nodiscard]] const ReachResult& reach() const;
  /// With cells of 20 mm; takes seconds.
  [[nodiscard]] const PlyFloor& ply_floor() const;
  [[nodiscard]] const SequenceFrame& frame() const { return frame_; }
  /// On the coarsest mesh of those that a plan uses. @throws WrongInput if there is no such mesh.
  [[nodiscard]] const ScoreFields& score_fields() const;
  /// The fields of a drape at a fidelity, as the objective sees it (before or after pressing); empty if its
  /// score is not valid.
  [[nodiscard]] std::vector<float> score_fields_of(const Drape& drape, const std::string& fidelity) const;
  /// @throws std::out_of_range if the case has no such fidelity, WrongInput if its model cannot be
  /// built.
  [[nodiscard]] const Model& model(const std::string& fidelity) const;

  /// Runs a schedule. Once the fidelity's model is built it never throws for a schedule that fits the rig: a
  /// failed run is an invalid score.
  [[nodiscard]] Drape run(const Schedule& schedule, const std::string& fidelity, int frames = 0,
                          RunPart part = {}) const;
  /// The same as far as a search needs it: where the objective is taken before pressing, only the reporting
  /// fidelity presses. Scores are those of the whole run (but for largest strains and lags, which are looked at
  /// now and then, at other times in a longer run), also where the press would fail.
  [[nodiscard]] Drape run_for_objective(const Schedule& schedule, const std::string& fidelity) const;
  /// Runs a schedule on another model: the case's ply, mold and rig with something disturbed. It is scored as
  /// the case.
  [[nodiscard]] Drape run_on(const Model& model, const Schedule& schedule, int frames = 0,
                             RunPart part = {}) const;

 private:
  /// Made by whoever asks first.
  template <class T>
  class Lazy {
   public:
    template <class Make>
    const T& get(const Make& make) {
      const std::scoped_lock lock(mutex_);
      if (!value_) value_ = std::make_unique<const T>(make());
      return *value_;
    }

   private:
    std::mutex mutex_;
    std::unique_ptr<const T> value_;
  };

  /// The score of a run as the ply was at an instant. @param seen  the run's extremes until then.
  [[nodiscard]] Score score_at(const Model& model, const RunResult& run, const Snapshot& ply,
                               const RunRecord& seen, double duration) const;

  Case case_;
  MapResult map_;
  ReachProblem reach_problem_;
  SequenceFrame frame_;
  std::unique_ptr<Lazy<ReachResult>> reach_;
  std::unique_ptr<Lazy<PlyFloor>> ply_floor_;
  std::unique_ptr<Lazy<ScoreFields>> score_fields_;
  std::map<std::string, std::unique_ptr<Lazy<ScoreFields::Sampling>>> samplings_;
  std::map<std::string, std::unique_ptr<Lazy<Model>>> models_;
};

}  // namespace drapeplan
