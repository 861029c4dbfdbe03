#include "planner/views/drape_page.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "planner/base/text.hpp"
#include "planner/exports/run_exports.hpp"
#include "planner/report/picture.hpp"
#include "planner/report/robot_table.hpp"
#include "planner/report/run_files.hpp"
#include "planner/schedule/robot_files.hpp"
#include "planner/views/files.hpp"

namespace drapeplan {

nlohmann::json played_json(const Played& played) {
  nlohmann::json value{{"fidelity", played.fidelity}, {"frames", played.frames}, {"part", played.part}};
  if (!played.schedule.empty()) value["schedule"] = played.schedule;
  return value;
}

Played played_from(const nlohmann::json& value) {
  return {.schedule = value.value("schedule", ""),
          .fidelity = value.at("fidelity").get<std::string>(),
          .frames = value.at("frames").get<int>(),
          .part = value.at("part").get<bool>()};
}

SeenDrape play_drape(const DrapeProblem& problem, const Schedule& schedule, const Played& played,
                     RunPart part) {
  Recorder recorder(problem.definition(), problem.model(played.fidelity), &schedule);
  part.samples = played.frames > 0 ? kHistoryInstants : 0;
  part.sample = [&recorder](const Snapshot& now) { recorder.see(now); };
  Drape drape = problem.run(schedule, played.fidelity, played.frames, part);
  recorder.see(drape.run.final);
  return {std::move(drape), std::move(recorder)};
}

SeenRun play_run(const Case& definition, const Model& model, const Played& played, const RunPart& part) {
  Recorder recorder(definition, model, nullptr);
  std::vector<Snapshot> frames;
  RunRequest request;
  request.duration = definition.duration;
  request.from = part.from;
  request.pause = part.pause;
  request.frames = played.frames;
  request.observe = [&frames](const Snapshot& frame) { frames.push_back(frame); };
  request.samples = played.frames > 0 ? kHistoryInstants : 0;
  request.sample = [&recorder](const Snapshot& now) { recorder.see(now); };
  RunResult run = simulate(model, request);
  recorder.see(run.final);
  return {std::move(run), std::move(frames), std::move(recorder)};
}

void write_drape_page(const std::filesystem::path& folder, const DrapeProblem& problem, const SeenDrape& seen,
                      const Schedule& schedule, const Played& played, const std::string& verdict,
                      const Diagnosis& diagnosis, const std::vector<std::string>& notes) {
  const Case& definition = problem.definition();
  const Model& model = problem.model(played.fidelity);
  const Drape& drape = seen.drape;
  NamedFiles files{{"schedule.json", "the sequence, knots"}};
  const auto list = [&files](const NamedFiles& more) { files.insert(files.end(), more.begin(), more.end()); };
  list(robot_files());
  list(write_exports(folder, "ply", definition,
                     {.scene = &model.scene(),
                      .frames = &drape.frames,
                      .schedule = &schedule,
                      .mapping = &problem.mapping()},
                     drape.run));
  const std::string picture = drape_picture({drape_panel(problem, drape, played.fidelity, played.schedule)},
                                            definition.mold->extent());
  write_text(folder / "drape.svg", picture);
  DrapePage page{
      .verdict = verdict,
      .reasons = {},
      .rows = reference_rows(definition),
      .figures = {{"Gap between ply and mold, seen from above, with the prescribed boundary", picture}},
      .files = std::move(files),
      .notes = notes,
      .fidelity = played.fidelity,
      .tables = {robot_table(played.schedule, schedule, definition, drape.score)}};
  const std::vector<std::string> warnings = warning_notes(problem, drape, played.fidelity);
  page.notes.insert(page.notes.end(), warnings.begin(), warnings.end());
  const std::vector<ReportRow> own = drape_rows(played.schedule, drape);
  page.rows.insert(page.rows.end(), own.begin(), own.end());
  if (!diagnosis.good()) page.reasons = reasons_report(problem, drape, played.fidelity, diagnosis);
  page.frames = &drape.frames;
  page.mapping = &problem.mapping();
  write_run(folder, definition, model, seen.recorder, drape.run, std::move(page));
}

void write_run_page(const std::filesystem::path& folder, const Case& definition, const Model& model,
                    const SeenRun& seen, const std::vector<std::string>& notes) {
  DrapePage page;
  page.frames = &seen.frames;
  page.files =
      write_exports(folder, "ply", definition, {.scene = &model.scene(), .frames = &seen.frames}, seen.run);
  page.notes = notes;
  write_run(folder, definition, model, seen.recorder, seen.run, std::move(page));
}

}  // namespace drapeplan
