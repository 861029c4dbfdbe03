#include "planner/report/run_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "planner/base/json_text.hpp"
#include "planner/base/text.hpp"
#include "planner/case/file.hpp"
#include "planner/diagnosis/verdict.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/drape/run_checks.hpp"
#include "planner/exports/pattern.hpp"
#include "planner/exports/run_exports.hpp"
#include "planner/page/page.hpp"
#include "planner/report/charts.hpp"
#include "planner/report/page_parts.hpp"
#include "planner/report/robot_table.hpp"
#include "planner/schedule/file.hpp"
#include "planner/score/scoring.hpp"
#include "planner/search/finalists.hpp"
#include "planner/trust/setting_runs.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Published rows first, then the baselines, then the optimum.
std::vector<ReportRow> rows_of(const DrapeProblem& problem, const PlanResult& result) {
  std::vector<ReportRow> rows = reference_rows(problem.definition());
  for (const auto& [name, drape] : {std::pair<const char*, const Drape&>{"uniform", result.uniform},
                                    {"wave", result.wave},
                                    {"optimised", result.best}}) {
    const bool coarse = &drape == &result.best && result.search.best_fidelity != kReport;
    const std::vector<ReportRow> own =
        drape_rows(coarse ? fmt::format("{} (at {})", name, result.search.best_fidelity) : name, drape);
    rows.insert(rows.end(), own.begin(), own.end());
  }
  return rows;
}

/// Best objective at each fidelity against the number of evaluations.
Chart history_chart(const StagedResult& search) {
  Chart chart{.title = "Search", .x_label = "evaluation", .y_label = "objective", .series = {}};
  std::map<std::string, size_t> place;
  for (const HistoryEntry& entry : search.history) {
    const auto [found, fresh] = place.try_emplace(entry.fidelity, chart.series.size());
    if (fresh) {
      chart.series.push_back({.name = entry.fidelity + ": each", .points = {}, .dots = true, .steps = false});
      chart.series.push_back(
          {.name = entry.fidelity + ": best so far", .points = {}, .dots = false, .steps = true});
    }
    const double objective = entry.valid ? entry.objective : kNaN;
    chart.series[found->second].points.emplace_back(entry.number, objective);
    chart.series[found->second + 1].points.emplace_back(entry.number, entry.best_so_far);
  }
  return chart;
}

/// Gap against boundary offset: what no schedule can go below, what drapes have, and which of all candidates
/// at the reporting fidelity no other one beats in gap, offset and duration.
Chart floor_chart(const FloorFront& front, const std::vector<ReportRow>& rows, const StagedResult& search,
                  const ScoreOptions& options) {
  Chart chart{.title = "Gap and boundary offset",
              .x_label = "largest boundary offset [mm]",
              .y_label = "largest gap [mm]",
              .series = {},
              .side_legend = true};
  ChartSeries floor{.name = "floor of any schedule", .points = {}, .marks = true};
  for (const FloorPoint& point : front.points) {
    if (point.converged && std::isfinite(point.boundary_tolerance))
      floor.points.emplace_back(1e3 * point.boundary_tolerance, 1e3 * point.gap);
  }
  std::sort(floor.points.begin(), floor.points.end(),
            [](const auto& a, const auto& b) { return a.x() < b.x(); });
  chart.series.push_back(floor);
  const double edge = 1e3 * options.target_boundary_offset, gap = 1e3 * options.target_gap;
  chart.series.push_back({.name = "tolerances of the case", .points = {{0, gap}, {edge, gap}, {edge, 0}}});
  for (const ReportRow& row : rows) {
    if (!row.score.valid) continue;
    chart.series.push_back({.name = row.name,
                            .points = {{1e3 * row.score.max_boundary_offset, 1e3 * row.score.max_gap}},
                            .dots = true});
  }
  for (const Candidate* candidate : unbeaten(search.finalists)) {
    const Score& score = candidate->outcome.score;
    chart.series.push_back({.name = fmt::format("{}, {:.1f} s", candidate->name, score.duration),
                            .points = {{1e3 * score.max_boundary_offset, 1e3 * score.max_gap}},
                            .rings = true});
  }
  return chart;
}

/// What was changed of the case, and what each change brought.
std::string design_note(const PlanResult& result) {
  std::string text = fmt::format(
      "The rig was searched together with the schedule. On the case as it was given, the uniform sequence "
      "has an "
      "objective of {:.2f}. Changed:",
      result.given.objective);
  for (const DesignChange& change : result.design->changes) {
    text += fmt::format(" {} is {} instead of {} (the best sequence without this change: {});", change.path,
                        change.after, change.before,
                        change.without.score.valid ? fmt::format("{:.2f}", change.without.score.objective)
                                                   : change.without.score.reason);
  }
  text.back() = '.';
  return text;
}

}  // namespace

std::vector<ReportRow> reference_rows(const Case& definition) {
  std::vector<ReportRow> rows;
  for (const Reference& reference : definition.references) {
    Score score;
    for (const ScorePart& part : kScoreParts) score.*part.value = kNaN;
    score.valid = true;
    score.max_gap = reference.max_gap;
    score.max_boundary_offset = reference.max_boundary_offset;
    rows.push_back({.name = reference.name, .score = score, .reference = true});
  }
  return rows;
}

std::vector<ReportRow> drape_rows(const std::string& name, const Drape& drape) {
  std::vector<ReportRow> rows{{.name = name, .score = drape.score}};
  if (drape.other)
    rows.push_back({.name = fmt::format("{}, {}", name, drape.other->label()),
                    .score = drape.other->score,
                    .beside = true});
  return rows;
}

std::vector<std::string> warning_notes(const DrapeProblem& problem, const Drape& drape,
                                       const std::string& fidelity) {
  std::vector<std::string> notes = map_warnings(problem.definition(), problem.mapping());
  const std::vector<std::string> more = drape_warnings(problem, drape, fidelity);
  notes.insert(notes.end(), more.begin(), more.end());
  return notes;
}

std::string terms_line(const Model& model) {
  return fmt::format("[{}]", fmt::join(model.term_names(), "] ["));
}

namespace {

/// The picture is of the end of the run: of a ply that was pressed, as it is under pressure.
std::string subtitle_of(const Drape& drape) {
  if (!drape.score.valid) return drape.score.reason;
  const std::string objective = fmt::format("objective {:.2f}", drape.score.objective);
  if (!drape.other) return objective;
  return fmt::format("pressed; {} {} pressing", objective, drape.other->before ? "after" : "before");
}

}  // namespace

DrapePanel drape_panel(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity,
                       const std::string& title) {
  const Mesh& mesh = problem.model(fidelity).scene().mesh;
  const double thickness = problem.definition().material.thickness;
  DrapePanel panel{.title = title,
                   .subtitle = subtitle_of(drape),
                   .mesh = mesh,
                   .position = drape.run.final.position,
                   .gap = drape.gap,
                   .boundary = problem.mapping().boundary,
                   .pads = drape.run.final.pad,
                   .pad_radius = problem.definition().grippers->pad_radius,
                   .largest_offset = std::nullopt};
  if (drape.score.valid) {
    const BoundaryOffset offset =
        boundary_offset(ply_edge(mesh, drape.run.final, thickness), problem.mapping().boundary);
    panel.largest_offset = {offset.on_edge, offset.on_boundary};
  }
  return panel;
}

namespace {

/// A clause, as "the optimised sequence ...", as the beginning of a sentence.
std::string capitalised(std::string clause) {
  if (!clause.empty()) clause.front() = char(std::toupper(static_cast<unsigned char>(clause.front())));
  return clause;
}

/// The numerical settings that a plan chose, and what is known of them.
ReportTable choice_report(const FidelityChoice& choice) {
  ReportTable table{
      .title = "Numerical settings",
      .caption = fmt::format("Chosen from {} runs in {:.0f} s. Errors are estimates, of the largest gap and "
                             "boundary offset. {}",
                             choice.runs, choice.seconds,
                             choice.ranked_against.empty()
                                 ? std::string()
                                 : "Ranks: Spearman's correlation with " + choice.ranked_against + "."),
      .head = {"fidelity", "setting", "error [%]", "ranks", "a run on one core [s]"},
      .rows = {}};
  for (const ChosenFidelity& one : choice.chosen)
    table.rows.push_back({.cells = {one.name, setting_text(one.options), fixed(1e2 * one.error, 1),
                                    fixed(one.ranks, 2), fixed(one.seconds, 1)}});
  return table;
}

/// Both schedules in plants that differ from the case.
ReportTable spread_report(const PlantSpread& spread) {
  ReportTable table{.title = "In a plant that differs",
                    .caption = capitalised(spread_text(spread)) + ".",
                    .head = {"differs by", "largest gap [mm]", "largest boundary offset [mm]", "objective",
                             "objective of the baseline"},
                    .rows = {}};
  for (const DisturbedPair& pair : spread.pairs) {
    const Score& best = pair.best;
    const auto text_of = [](const Score& score, double value, int decimals) {
      return score.valid ? fixed(value, decimals) : std::string("failed");
    };
    table.rows.push_back(
        {.cells = {pair.disturbance.empty() ? "nothing" : pair.disturbance,
                   text_of(best, 1e3 * best.max_gap, 2), text_of(best, 1e3 * best.max_boundary_offset, 2),
                   text_of(best, best.objective, 2), text_of(pair.baseline, pair.baseline.objective, 2)},
         .failed = !pair.best.valid});
  }
  return table;
}

/// The better baseline and the winner, one fidelity above the reporting one.
void add_finer_rows(const Confirmation& confirmation, PlanReport& report) {
  const std::string setting = setting_text(confirmation.options);
  for (const auto& [name, score] :
       {std::pair<const char*, const Score&>{"better baseline", confirmation.finer_baseline},
        {"optimised", confirmation.finer}})
    report.rows.push_back({.name = fmt::format("{}, {}", name, setting), .score = score, .beside = true});
  report.outcome += fmt::format(" {}.", capitalised(confirmation_text(confirmation)));
}

}  // namespace

ReportReasons reasons_report(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity,
                             const Diagnosis& diagnosis) {
  const RigOptions& rig = *problem.definition().grippers;
  DrapePanel panel = drape_panel(problem, drape, fidelity, "why");
  panel.subtitle.clear();
  for (const Fold& fold : diagnosis.folds) panel.folds.push_back(panel.position[size_t(fold.node)]);
  for (int g = 0; g < rig.count(); ++g) panel.pad_names.push_back(rig.name(g));
  if (diagnosis.effects) {
    panel.weights.assign(size_t(rig.count()), 0.0);
    const double largest = diagnosis.effects->values.front().size();
    for (const StrokeEffect& effect : diagnosis.effects->values) {
      double& weight = panel.weights[size_t(effect.gripper)];
      if (effect.size() > 0) weight = std::max(weight, effect.size() / largest);
    }
  }
  return {
      .text = diagnosis_text(diagnosis, rig),
      .remedy = remedy_text(diagnosis, rig),
      .figure = {"Folds by height; the stronger a pad is filled, the more its height or its start matters",
                 drape_picture({panel}, problem.definition().mold->extent())},
      .folds = folds_table(diagnosis, rig)};
}

namespace {

/// The baselines and the winner, for the view in space.
std::vector<ViewDrape> viewed(const DrapeProblem& problem, const PlanResult& result) {
  const Scene& report = problem.model(kReport).scene();
  return {{"uniform", &report, &result.uniform.frames},
          {"wave", &report, &result.wave.frames},
          {"optimised", &problem.model(result.search.best_fidelity).scene(), &result.best.frames}};
}

/// The page of a plan. @param drape, sequence  pictures, as SVG. @param others  files for other programs.
PlanReport page_of(const DrapeProblem& problem, const PlanResult& result, const PlanTrust& trust,
                   const Diagnosis& diagnosis, const std::string& drape, const std::string& sequence,
                   const NamedFiles& others) {
  const RigOptions& rig = *problem.definition().grippers;
  const StagedResult& search = result.search;
  PlanReport report;
  report.title = problem.definition().name;
  report.description = problem.definition().description;
  report.verdict = verdict_text(problem, result, trust);
  report.outcome = fmt::format("{}. {} schedules were simulated in {:.0f} s.", capitalised(search.message),
                               search.evaluations, result.wall_seconds);
  report.reach = explain_reach(problem.reach_problem(), problem.reach()) + " " + problem.ply_floor().meaning;
  if (const std::string force = best_force_text(problem, result); !force.empty()) report.reach += " " + force;
  if (!diagnosis.good())
    report.reasons = reasons_report(problem, result.best, search.best_fidelity, diagnosis);
  report.rows = rows_of(problem, result);
  report.ply_area = ply_area(problem.model(kReport).scene().mesh);
  const std::vector<ViewDrape> drapes = viewed(problem, result);
  report.view = space_view(drapes, &problem.mapping());
  report.tables.push_back(angles_table(drapes, &problem.mapping()));
  if (trust.confirmation) add_finer_rows(*trust.confirmation, report);
  report.notes = warning_notes(problem, result.best, search.best_fidelity);
  const std::vector<std::string> sources = source_notes(problem.definition());
  report.notes.insert(report.notes.end(), sources.begin(), sources.end());
  if (trust.spread) report.tables.push_back(spread_report(*trust.spread));
  report.tables.push_back(
      robot_table(search.best.name, search.best.schedule, problem.definition(), result.best.score));
  if (trust.choice) {
    report.tables.push_back(choice_report(*trust.choice));
    if (!trust.choice->message.empty()) report.notes.push_back(trust.choice->message);
  }
  report.figures = {{"Gap between ply and mold, seen from above, with the prescribed boundary", drape},
                    {"Who goes down when", sequence},
                    {"Heights of the joints over time, in the colours of their arrival",
                     line_chart(height_chart(search.best.schedule, rig, "Optimised sequence"))},
                    {"Best objective against evaluations", line_chart(history_chart(search))}};
  if (const FloorFront& front = problem.ply_floor().front; !front.points.empty()) {
    report.figures.push_back(
        {"Largest gap against largest boundary offset: drapes, and the floor below which no "
         "schedule comes while fibres stretch by 1 % at most; rings are the candidates that no other one "
         "beats in gap, offset and duration at once",
         line_chart(floor_chart(front, report.rows, search, problem.definition().score))});
  }
  report.facts = {{"evaluations", fmt::to_string(search.evaluations)},
                  {"failed evaluations", fmt::to_string(search.failed_evaluations)},
                  {"wall time", fmt::format("{:.0f} s", result.wall_seconds)},
                  {"best candidate", search.best.name},
                  {"state hash of the best drape", hex(result.best.run.summary.state_hash)},
                  {"energy balance error", fmt::format("{:.1e} of the largest energy",
                                                       result.best.run.summary.energy.balance_error)}};
  report.files = {{"schedule.json", "the optimised sequence, knots"},
                  {"result.json", "all results"},
                  {"resolved.json", "the complete case with all defaults"},
                  {"evaluations.jsonl", "every evaluation"}};
  report.files.insert(report.files.end(), others.begin(), others.end());
  report.files.insert(report.files.begin() + 1, robot_files().begin(), robot_files().end());
  if (result.design) {
    report.files.emplace_back(kDesignFile, "the case with what was changed of the rig; it runs on its own");
    if (!search.interrupted) report.notes.push_back(design_note(result));
  }
  return report;
}

}  // namespace

void write_plan(const std::filesystem::path& folder, const DrapeProblem& problem, const PlanResult& result,
                const PlanTrust& trust, const Diagnosis& diagnosis, double cycle) {
  const RigOptions& rig = *problem.definition().grippers;
  const StagedResult& search = result.search;
  write_schedule(folder / "schedule.json", search.best.schedule, rig);
  write_robot_files(folder, search.best.schedule, rig,
                    {.cycle = cycle,
                     .case_name = problem.definition().name,
                     .case_hash = hex(case_hash(problem.definition()))});
  write_schedule(folder / "schedule_uniform.json", search.uniform.schedule, rig);
  write_schedule(folder / "schedule_wave.json", search.wave.schedule, rig);
  if (result.design)
    write_text(folder / kDesignFile, dump_json(resolved_case(problem.definition()), 2) + "\n");
  write_plan_page(folder, problem, result, trust, diagnosis);
}

void write_plan_page(const std::filesystem::path& folder, const DrapeProblem& problem,
                     const PlanResult& result, const PlanTrust& trust, const Diagnosis& diagnosis,
                     const std::vector<std::string>& notes) {
  const StagedResult& search = result.search;
  std::vector<DrapePanel> panels;
  const auto add = [&](const char* name, const Drape& drape, const std::string& fidelity,
                       const Schedule& schedule) {
    panels.push_back(drape_panel(problem, drape, fidelity, name));
    return RunFrames{.scene = &problem.model(fidelity).scene(),
                     .frames = &drape.frames,
                     .schedule = &schedule,
                     .mapping = &problem.mapping()};
  };
  write_frames(folder, "uniform", add("uniform", result.uniform, kReport, search.uniform.schedule));
  write_frames(folder, "wave", add("wave", result.wave, kReport, search.wave.schedule));
  NamedFiles others = write_exports(folder, "optimised", problem.definition(),
                                    add("optimised", result.best, search.best_fidelity, search.best.schedule),
                                    result.best.run);
  const NamedFiles pattern = write_pattern(folder, problem.definition());
  others.insert(others.end(), pattern.begin(), pattern.end());

  const std::string drape = drape_picture(panels, problem.definition().mold->extent());
  const std::string sequence =
      schedule_picture(search.best.schedule, *problem.definition().grippers, "Optimised sequence");
  write_text(folder / "drape.svg", drape);
  write_text(folder / "sequence.svg", sequence);
  PlanReport page = page_of(problem, result, trust, diagnosis, drape, sequence, others);
  page.notes.insert(page.notes.begin(), notes.begin(), notes.end());
  write_text(folder / "report.html", html_report(page));
}

std::string comparison_table(const DrapeProblem& problem, const PlanResult& result) {
  return console_table(rows_of(problem, result));
}

}  // namespace drapeplan
