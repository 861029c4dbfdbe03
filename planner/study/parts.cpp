// The parts of a study beside the FE runs: mapping, reach, search; and what follows from all.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "planner/base/quantity.hpp"
#include "planner/base/statistics.hpp"
#include "planner/drape/problem.hpp"
#include "planner/study/study.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Median time of so many calls.
template <class Work>
double timed(int repeats, const Work& work) {
  std::vector<double> times;
  for (int k = 0; k < std::max(1, repeats); ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(seconds_since(start));
  }
  return median(times);
}

/// Places of the compared points on the mold.
std::vector<Vector3d> mapped_grid(const Case& definition, const MapResult& map) {
  std::vector<Vector3d> places;
  for (const Eigen::Vector2d& point : compared_points(definition.ply))
    places.push_back(mapped_point(map.net, *definition.mold, point));
  return places;
}

double largest_distance(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double largest = 0;
  for (size_t k = 0; k < a.size(); ++k) largest = std::max(largest, (a[k] - b[k]).norm());
  return largest;
}

/// The number that a setting gives to its only knob; the mean step for the step's safety, which is what
/// counts.
double size_of(const StudyPoint& point) {
  if (point.curve == "step safety") return point.runs.empty() ? 0 : point.runs.front().dt;
  std::string fault;
  const std::string& text = point.settings.begin()->second;
  if (const std::optional<double> length = parse_quantity(text, Dimension::length, fault)) return *length;
  return std::atof(text.c_str());
}

double mesh_size_of(const Settings& settings) {
  std::string fault;
  const auto found = settings.find("fem.mesh_size");
  return found == settings.end() ? 0 : parse_quantity(found->second, Dimension::length, fault).value_or(0);
}

}  // namespace

std::vector<MappingRow> study_mapping(const StudySubject& subject, int repeats) {
  std::vector<MappingRow> rows;
  if (!subject.base().mapping) return rows;
  std::vector<Vector3d> targets, places;
  double shear = 0;
  for (const double factor :
       {0.125, 0.25, 0.5, 1.0, 2.0, 4.0}) {  // the finest is what the others are compared with
    MappingRow row;
    row.cell_size = factor * subject.base().mapping->cell_size;
    Case definition = subject.base();
    definition.mapping->cell_size = row.cell_size;
    MapResult map;
    row.wall_seconds = timed(repeats, [&] { map = map_case(definition); });
    const std::vector<Vector3d> grid = mapped_grid(definition, map);
    if (rows.empty()) targets = map.targets, places = grid, shear = map.max_shear_deg;
    row.targets = largest_distance(map.targets, targets);
    row.places = rms_distance(grid, places);
    row.max_shear_deg = std::abs(map.max_shear_deg - shear);
    rows.push_back(row);
  }
  return rows;
}

std::vector<ReachRow> study_reach(const StudySubject& subject, int repeats) {
  std::vector<ReachRow> rows;
  if (!subject.drapes()) return rows;
  const ReachProblem problem = reach_problem_of(subject.base(), map_case(subject.base()).targets);
  for (const int starts : {16, 8, 4, 2, 1, 0}) {  // the most are what the others are compared with
    ReachRow row;
    row.starts = starts;
    ReachResult result;
    row.wall_seconds =
        timed(repeats, [&] { result = solve_reach(problem, starts, subject.base().optimise.seed); });
    row.floor_rms = result.floor_rms;
    row.floor_max = result.floor_max;
    row.link_violation = result.link_violation;
    row.floor_rms_error = rows.empty() ? 0 : std::abs(row.floor_rms - rows.front().floor_rms);
    row.floor_max_error = rows.empty() ? 0 : std::abs(row.floor_max - rows.front().floor_max);
    rows.push_back(row);
  }
  return rows;
}

SearchTrace search_trace(const std::vector<Evaluation>& evaluations, const std::string& fidelity) {
  SearchTrace trace{"waves, then every gripper", {}, {}, {}};
  double seconds = 0, best = kInfinity;
  int count = 0;
  for (const Evaluation& one : evaluations) {
    if (one.stage == "report") continue;  // finalists again, and baselines: no search
    ++count;
    seconds += one.outcome.wall_seconds;
    if (one.fidelity != fidelity || !one.outcome.score.valid) continue;
    best = std::min(best, one.outcome.score.objective);
    trace.evaluations.push_back(count);
    trace.seconds.push_back(seconds);
    trace.best.push_back(best);
  }
  return trace;
}

std::map<std::string, std::map<std::string, double>> orders_of(const Study& study) {
  std::map<std::string, std::vector<const StudyPoint*>> curves;
  for (const StudyPoint& point : study.points) {
    if (point.valid() && point.settings.size() == 1) curves[point.curve].push_back(&point);
  }
  std::map<std::string, std::map<std::string, double>> orders;
  for (const auto& [curve, points] : curves) {
    const bool mesh = curve == "mesh size";
    constexpr size_t kFewest = 4;
    if (points.size() < kFewest) continue;
    const double finest = mesh ? mesh_size_of(study.reference) : size_of(*points.front());
    for (const auto& [name, unused] : points.front()->error) {
      std::vector<double> sizes, errors;
      for (const StudyPoint* point : points) {
        const auto& list = mesh ? point->error : point->knob_error;
        if (list.count(name) == 0) continue;
        sizes.push_back(size_of(*point));
        errors.push_back(list.at(name));
      }
      orders[curve][name] = observed_order(sizes, errors, finest);
    }
  }
  return orders;
}

bool only_numerical(const Settings& settings) {
  return std::all_of(settings.begin(), settings.end(), [](const auto& setting) {
    return setting.first.starts_with("fem.") && setting.first != "fem.rates";
  });
}

std::map<std::string, Settings> chosen_fidelities(const Study& study) {
  std::map<std::string, Settings> chosen;
  double cost = kInfinity;
  for (const StudyPoint& point : study.points) {
    const auto error = point.error.find("relative");
    if (error == point.error.end() || error->second > kReportError || !only_numerical(point.settings))
      continue;
    if (point.mean(&StudyRun::cpu_seconds) >= cost) continue;
    cost = point.mean(&StudyRun::cpu_seconds);
    chosen[kReport] = point.settings;
  }
  for (const auto& [name, least] : {std::pair{"search", kSearchRank}, {"screen", kScreenRank}}) {
    cost = kInfinity;
    for (const RankRow& row : study.ranks) {
      if (!(row.spearman >= least) || row.compared < study.schedules || row.cpu_seconds >= cost) continue;
      cost = row.cpu_seconds;
      chosen[name] = row.settings;
    }
  }
  return chosen;
}

}  // namespace drapeplan
