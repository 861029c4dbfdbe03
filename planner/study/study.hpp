// Error against run time: one case at many settings, compared with a reference.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fem/rig/schedule.hpp"
#include "planner/case/case.hpp"
#include "planner/search/evaluation_log.hpp"

namespace drapeplan {

/// Changes of a case: path and value, as for --set.
using Settings = std::map<std::string, std::string>;

/// One run of a case at some settings. Figures and places are compared with those of the reference.
struct StudyRun {
  bool valid = false;
  std::string reason;  ///< why it is not
  double wall_seconds = 0;
  double cpu_seconds = 0;  ///< of the one thread that runs it: the wall time on a core that nobody else uses
  double element_updates = 0;
  double steps = 0, dt = 0;  ///< mean step [s]
  double balance_error = 0, kinetic_ratio = 0;
  double objective = 0;                   ///< of a drape
  std::map<std::string, double> figures;  ///< SI; a drape: parts of its score; else by probe and grip
  std::vector<Eigen::Vector3d> places;    ///< of points of the ply in a regular grid, at the end [m]
  std::vector<double> shear_deg;          ///< of the elements that hold them [deg]
};

/// What a case is asked to do: with grippers a schedule, without any its own duration.
class StudySubject {
 public:
  /// @param overrides  path=value, applied before any settings.
  /// @param at         settings around which knobs are turned, beside the `fem` section.
  /// @throws std::invalid_argument for a case that cannot be read or simulated.
  StudySubject(std::string file, std::vector<std::string> overrides, Settings at = {});

  /// The case at these settings.
  [[nodiscard]] const Case& base() const { return base_; }
  [[nodiscard]] const Settings& at() const { return at_; }
  /// The case with all its fidelities.
  [[nodiscard]] Case whole() const;
  [[nodiscard]] bool drapes() const { return base_.grippers.has_value(); }
  /// Names of the case's fidelities, without the reporting one if that is the base.
  [[nodiscard]] std::vector<std::string> fidelities() const;
  /// What `fidelity` changes of the base.
  [[nodiscard]] Settings changes_of(const std::string& fidelity) const;
  /// The base changed by the settings, with `report` as its only fidelity.
  /// @throws std::invalid_argument with all that is wrong with them.
  [[nodiscard]] Case with(const Settings& settings) const;

  /// See spread_schedules().
  [[nodiscard]] std::vector<Schedule> schedules(int count) const;
  /// Schedules on a short straight line through the wave family, `step` apart in its coordinates, the
  /// baseline wave in the middle.
  [[nodiscard]] std::vector<Schedule> line_of_schedules(int count, double step) const;

  /// Runs all schedules at the settings, one thread, the case made ready once. A run that fails is an entry,
  /// never an exception; so are settings that the case cannot have.
  [[nodiscard]] std::vector<StudyRun> run(const Settings& settings,
                                          const std::vector<Schedule>& schedules) const;

 private:
  std::string file_;
  std::vector<std::string> overrides_;
  Settings at_;
  Case base_;
};

/// A regular grid of points (u, v) over the ply's bounding box [m]: where places are compared.
std::vector<Eigen::Vector2d> compared_points(const Ply& ply);

/// R.m.s. distance of points in pairs; those that are not finite are left out, NaN if none is left.
double rms_distance(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);

/// Errors of a run against the reference's, by name: "gap", "boundary_offset", ... (figures) [SI],
/// "places" (r.m.s. distance) [m], "shear_deg" (r.m.s.) [deg], and "relative", the largest relative error of
/// the leading figures: of a drape the leading parts of its score, else all. Of several runs the
/// largest of each. Empty if a run is not valid.
std::map<std::string, double> study_errors(const std::vector<StudyRun>& runs,
                                           const std::vector<StudyRun>& reference, bool drapes);

/// One point of the study: settings, what they cost and how wrong they are.
struct StudyPoint {
  std::string curve;  ///< the knob that is turned: "mesh size", ...; "combination"; or "fidelity NAME"
  Settings settings;
  std::vector<StudyRun> runs;                ///< of the baselines
  std::map<std::string, double> error;       ///< against the reference; empty if a run failed
  std::map<std::string, double> knob_error;  ///< against the most careful value on the same curve

  [[nodiscard]] bool valid() const { return !error.empty(); }
  /// Means over the runs.
  [[nodiscard]] double mean(double StudyRun::*member) const;
};

/// Settings of a sweep: the named fidelities, every knob around the `fem` section, then combinations of the
/// cheap ones. A curve begins with its most careful value.
std::vector<StudyPoint> sweep_points(const StudySubject& subject);

/// A length for settings, to four digits.
std::string rounded_length(double value);

/// The settings of the reference: the base's with a mesh `refinement` times finer.
Settings reference_settings(const StudySubject& subject, double refinement);

/// What ranking found for one setting.
struct RankRow {
  std::string name = {};  ///< of a fidelity; empty for a combination
  Settings settings = {};
  double wall_seconds = 0, cpu_seconds = 0;  ///< of one run, median
  double spearman = 0, kendall = 0;
  std::vector<double> objectives = {};  ///< NaN where a run failed
  int compared = 0;                     ///< schedules that both could score
};

/// Whether settings change numerics alone: not the material, nor whether its rates count.
bool only_numerical(const Settings& settings);

/// Sets the correlations of every row with the objectives of the reference.
void rank_against(const std::vector<double>& reference, std::vector<RankRow>& rows);

/// Noise of the objective at one fidelity: from seven points of a short line through the wave family.
struct NoiseRow {
  std::string name;
  Settings settings;
  double step = 0;          ///< between the points, in the family's coordinates
  double objective = 0;     ///< median
  double noise = 0;         ///< standard deviation
  bool consistent = false;  ///< see NoiseEstimate
};

/// The mapping at one cell size, against the finest.
struct MappingRow {
  double cell_size = 0, wall_seconds = 0;
  double targets = 0;  ///< largest distance of a gripper's target [m]
  double places = 0;   ///< r.m.s. distance over the ply [m]
  double max_shear_deg = 0;
};

/// The reach problem with so many random starts, against the most.
struct ReachRow {
  int starts = 0;
  double wall_seconds = 0;
  double floor_rms = 0, floor_max = 0;              ///< [m]
  double floor_rms_error = 0, floor_max_error = 0;  ///< [m]
  double link_violation = 0;                        ///< [m]
};

/// Best objective of a search so far, after so many evaluations and so much time.
struct SearchTrace {
  std::string name;
  std::vector<double> evaluations, seconds, best;  ///< seconds: sum of the run times of all evaluations
};

std::vector<MappingRow> study_mapping(const StudySubject& subject, int repeats);
std::vector<ReachRow> study_reach(const StudySubject& subject, int repeats);
/// The search of a plan, from the lines of its log: best objective at the fidelity of its last stage.
/// Objectives of different fidelities are not comparable, but all evaluations count as effort.
/// @param fidelity  of that stage.
SearchTrace search_trace(const std::vector<Evaluation>& evaluations, const std::string& fidelity);

/// All that a study found; parts that were not asked for are empty.
struct Study {
  std::string case_name;
  bool drapes = false;
  Settings at;  ///< see StudySubject
  Settings reference;
  std::vector<StudyRun> reference_runs;
  std::vector<StudyPoint> points;
  std::map<std::string, double>
      base_error;     ///< by curve: relative, of the case's value against the most careful
  int schedules = 0;  ///< that were ranked
  std::string rank_reference;
  std::vector<RankRow> ranks;
  std::vector<NoiseRow> noise;
  std::vector<MappingRow> mapping;
  std::vector<ReachRow> reach;
  std::vector<SearchTrace> searches;
};

/// Observed orders of the curves whose knob is a number, by curve and error: see observed_order().
std::map<std::string, std::map<std::string, double>> orders_of(const Study& study);

/// The fidelities that follow: `report` is the cheapest point with a relative error of at most 1 %, `search`
/// the cheapest setting that can score every schedule and ranks them with Spearman >= 0.9, `screen` with >=
/// 0.75. What no setting reaches is absent.
std::map<std::string, Settings> chosen_fidelities(const Study& study);

inline constexpr double kReportError = 0.01, kSearchRank = 0.9, kScreenRank = 0.75;

}  // namespace drapeplan
