#include "planner/study/study.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "fem/mesh/foot.hpp"
#include "fem/run/monitor.hpp"
#include "mapping/error.hpp"
#include "planner/base/json_text.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/statistics.hpp"
#include "planner/base/text.hpp"
#include "planner/case/file.hpp"
#include "planner/drape/problem.hpp"
#include "planner/schedule/families.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using nlohmann::json;

constexpr int kSamples = 21;  // per side of the ply: where places and shear are compared
constexpr double kDegrees = 180 / std::numbers::pi;

/// Of the compared points that lie on the ply; the same ones on every mesh, but for those on an oblique rim.
std::vector<std::optional<Foot>> feet(const Mesh& mesh, const Ply& ply) {
  std::vector<std::optional<Foot>> result;
  for (const Vector2d& point : compared_points(ply)) result.push_back(foot_of(mesh, point));
  return result;
}

/// Adds what the end of a run looks like at the points of the grid; NaN off the ply.
void add_fields(const Mesh& mesh, const std::vector<std::optional<Foot>>& where, const Snapshot& end,
                StudyRun& run) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const std::optional<Foot>& foot : where) {
    run.places.push_back(foot ? place_of(mesh, *foot, end.position) : Eigen::Vector3d::Constant(kNan));
    run.shear_deg.push_back(foot ? kDegrees * end.shear[foot->element] : kNan);
  }
}

void add_report(const RunSummary& report, std::int64_t elements, StudyRun& run) {
  run.wall_seconds = report.wall_seconds;
  run.steps = double(report.steps);
  run.dt = report.dt;
  run.element_updates = double(report.steps) * double(elements);
  run.balance_error = report.energy.balance_error;
  run.kinetic_ratio = report.largest_kinetic_ratio;
  run.valid = report.status == RunStatus::done;
  if (!run.valid) run.reason = report.message;
}

/// Processor time that the calling thread has used [s].
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

StudyRun run_drape(const DrapeProblem& problem, const Schedule& schedule,
                   const std::vector<std::optional<Foot>>& where) {
  const Mesh& mesh = problem.model(kReport).scene().mesh;
  const double clock = thread_seconds();
  const Drape drape = problem.run(schedule, kReport);
  StudyRun run;
  run.cpu_seconds = thread_seconds() - clock;
  add_report(drape.run.summary, mesh.element_count(), run);
  run.valid = drape.score.valid;
  run.reason = drape.score.reason;
  run.objective = drape.score.objective;
  if (!run.valid) return run;
  for (const ScorePart& part : kScoreParts) {
    if (part.study != nullptr) run.figures[part.study] = drape.score.*part.value;
  }
  add_fields(mesh, where, drape.run.final, run);
  return run;
}

StudyRun run_free(const Case& definition) {
  const Model model(scene_of(definition, definition.fidelities.at(kReport)));
  const Mesh& mesh = model.scene().mesh;
  RunRequest request;
  request.duration = definition.duration;
  const double clock = thread_seconds();
  const RunResult result = simulate(model, request);
  StudyRun run;
  run.cpu_seconds = thread_seconds() - clock;
  add_report(result.summary, mesh.element_count(), run);
  if (!run.valid) return run;
  const Snapshot start = take_snapshot(model, model.flat_state(definition.start_height), RigDrive{});
  for (const Probe& probe : definition.probes) {
    const Foot foot = nearest_foot(mesh, probe.place);
    run.figures[probe.name] =
        (place_of(mesh, foot, result.final.position) - place_of(mesh, foot, start.position)).norm();
  }
  for (size_t k = 0; k < model.scene().grips.size(); ++k)
    run.figures[model.scene().grips[k].name + " force"] = result.final.grip_force[k].norm();
  add_fields(mesh, feet(mesh, definition.ply), result.final, run);
  return run;
}

bool leads_scores(const std::string& figure) {
  return std::any_of(kScoreParts.begin(), kScoreParts.end(),
                     [&figure](const ScorePart& part) { return part.leads && figure == part.study; });
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0, count = 0;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const double square = (a[k] - b[k]) * (a[k] - b[k]);
    if (std::isfinite(square)) sum += square, count += 1;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

StudySubject::StudySubject(std::string file, std::vector<std::string> overrides, Settings at)
    : file_(std::move(file)), overrides_(std::move(overrides)), at_(std::move(at)) {
  base_ = with({});
}

Case StudySubject::whole() const {
  return read_case(file_, overrides_).definition;  // read without errors before, by the constructor
}

std::vector<std::string> StudySubject::fidelities() const {
  std::vector<std::string> names;
  for (const auto& [name, options] : whole().fidelities) {
    if (name != kReport || !changes_of(name).empty()) names.push_back(name);
  }
  return names;
}

Settings StudySubject::changes_of(const std::string& fidelity) const {
  Case changed = whole();
  const auto options = changed.fidelities.find(fidelity);
  if (options == changed.fidelities.end()) return {};
  changed.fidelities[kReport] = FemOptions(options->second);  // which is what `fem` holds when it is written
  const json fem = resolved_case(changed)["fem"], base = resolved_case(base_)["fem"];
  Settings changes;
  for (const auto& [key, value] : fem.items()) {
    if (base.contains(key) && base[key] == value) continue;
    changes["fem." + key] = value.is_string()         ? value.get<std::string>()
                            : value.is_number_float() ? format_number(value.get<double>())
                                                      : dump_json(value);
  }
  return changes;
}

Case StudySubject::with(const Settings& settings) const {
  std::vector<std::string> overrides = overrides_;
  overrides.emplace_back("fidelities={}");
  for (const Settings* changes : {&at_, &settings}) {
    for (const auto& [path, value] : *changes) overrides.push_back(fmt::format("{}={}", path, value));
  }
  CaseReading reading = read_case(file_, overrides);
  const Case& definition = reading.definition;
  if (reading.errors.empty() && !(definition.material.thickness > 0))
    reading.errors.push_back({file_, 0, "", "a study needs the section \"material\", which is absent"});
  if (reading.errors.empty() && !definition.grippers && !(definition.duration > 0))
    reading.errors.push_back(
        {file_, 0, "/duration", "a study of a case without grippers needs a duration above 0"});
  if (reading.errors.empty() && !definition.grippers && definition.probes.empty() && definition.grips.empty())
    reading.errors.push_back(
        {file_, 0, "/probes", "a study of a case without grippers needs probes or grips to compare"});
  if (reading.errors.empty()) return std::move(reading.definition);
  std::string text;
  for (const InputError& error : reading.errors) text += (text.empty() ? "" : "\n") + error.text();
  throw WrongInput(text);
}

std::vector<Schedule> StudySubject::schedules(int count) const {
  if (!drapes()) return {Schedule{}};
  return spread_schedules(DrapeProblem(base_).frame(), count);
}

std::vector<Schedule> StudySubject::line_of_schedules(int count, double step) const {
  const DrapeProblem problem(base_);
  const WaveFamily waves(problem.frame());
  const Eigen::VectorXd middle = waves.encode(baseline_wave(problem.frame()));
  Eigen::VectorXd way = Eigen::VectorXd::Zero(middle.size());
  way[2] = way[3] = 1;  // delay and stroke: what changes the sequence smoothly
  std::vector<Schedule> result;
  for (int k = 0; k < count; ++k)
    result.push_back(
        to_schedule(problem.frame(), waves.decode(middle + (k - 0.5 * (count - 1)) * step * way)));
  return result;
}

std::vector<StudyRun> StudySubject::run(const Settings& settings,
                                        const std::vector<Schedule>& schedules) const {
  std::vector<StudyRun> runs;
  try {
    const Case definition = with(settings);
    if (!drapes()) return {run_free(definition)};
    const DrapeProblem problem(definition);
    const std::vector<std::optional<Foot>> where = feet(problem.model(kReport).scene().mesh, definition.ply);
    for (const Schedule& schedule : schedules) runs.push_back(run_drape(problem, schedule, where));
  } catch (const std::exception& error) {
    StudyRun failed;
    failed.reason = error.what();
    runs.assign(std::max<size_t>(schedules.size(), 1), failed);
  }
  return runs;
}

std::vector<Vector2d> compared_points(const Ply& ply) {
  const Eigen::AlignedBox2d box = bounding_box(corners_of(ply));
  std::vector<Vector2d> points;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const Vector2d share(double(i) / (kSamples - 1), double(j) / (kSamples - 1));
      points.push_back(box.min() + share.cwiseProduct(box.sizes()));
    }
  }
  return points;
}

double rms_distance(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double sum = 0, count = 0;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    const double square = (a[k] - b[k]).squaredNorm();
    if (std::isfinite(square)) sum += square, count += 1;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

std::map<std::string, double> study_errors(const std::vector<StudyRun>& runs,
                                           const std::vector<StudyRun>& reference, bool drapes) {
  std::map<std::string, double> errors;
  const auto keep = [&errors](const std::string& name, double error) {
    const auto [entry, fresh] = errors.try_emplace(name, error);
    if (!fresh) entry->second = std::max(entry->second, error);
  };
  for (size_t k = 0; k < runs.size(); ++k) {
    if (k >= reference.size() || !runs[k].valid || !reference[k].valid) return {};
    for (const auto& [name, value] : reference[k].figures) {
      const double error = std::abs(runs[k].figures.at(name) - value);
      keep(name, error);
      const bool leads = !drapes || leads_scores(name);
      if (leads && value != 0) keep("relative", error / std::abs(value));
      if (leads && value != 0) keep("relative_" + name, error / std::abs(value));
    }
    keep("places", rms_distance(runs[k].places, reference[k].places));
    keep("shear_deg", rms_difference(runs[k].shear_deg, reference[k].shear_deg));
  }
  return errors;
}

std::string rounded_length(double value) {
  return fmt::format("{:.4g} mm", 1e3 * value);
}

double StudyPoint::mean(double StudyRun::*member) const {
  double sum = 0;
  for (const StudyRun& run : runs) sum += run.*member;
  return sum / double(std::max<size_t>(runs.size(), 1));
}

Settings reference_settings(const StudySubject& subject, double refinement) {
  return {{"fem.mesh_size", rounded_length(subject.base().fidelities.at(kReport).mesh_size / refinement)}};
}

void rank_against(const std::vector<double>& reference, std::vector<RankRow>& rows) {
  for (RankRow& row : rows) {
    std::vector<double> a, b;
    for (size_t k = 0; k < std::min(reference.size(), row.objectives.size()); ++k) {
      if (!std::isfinite(reference[k]) || !std::isfinite(row.objectives[k])) continue;
      a.push_back(reference[k]);
      b.push_back(row.objectives[k]);
    }
    row.compared = int(a.size());
    row.spearman = spearman(a, b);
    row.kendall = kendall(a, b);
  }
}

}  // namespace drapeplan
