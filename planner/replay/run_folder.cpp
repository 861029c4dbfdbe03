#include "planner/replay/run_folder.hpp"

#include <fmt/format.h>

#include <vector>

#include "planner/base/json_text.hpp"
#include "planner/base/text.hpp"
#include "planner/case/file.hpp"
#include "planner/schedule/check.hpp"
#include "planner/schedule/file.hpp"
#include "planner/search/plan.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

bool has(const fs::path& folder, const char* name) {
  std::error_code error;
  return fs::exists(folder / name, error);
}

/// The verb whose run the folder is of. @throws WrongInput unless it is one whose page can be made again.
std::string verb_of_run(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw WrongInput(fmt::format("{}: {}; `report` takes the folder that `plan` or `simulate --out` has made",
                                 folder.string(),
                                 fs::exists(folder, error) ? "is no folder" : "there is no such folder"));
  const std::string verb = verb_of_results(folder);
  if (verb.empty())
    throw WrongInput(
        fmt::format("{}: is not the folder of a run: there is no {} in it that says which verb made it",
                    folder.string(), kRunLock));
  if (verb != "plan" && verb != "simulate")
    throw WrongInput(
        fmt::format("{}: holds results of `{}`; `report` makes the pages of `plan` and `simulate` again",
                    folder.string(), verb));
  return verb;
}

/// @throws NotFinished if the run has not come to its results.
void require_ended(const fs::path& folder, const std::string& verb) {
  if (has(folder, "result.json")) return;
  if (verb == "plan" && has(folder, kEvaluations))
    throw NotFinished(
        fmt::format("its plan has not ended: there is no result.json; `drapeplan plan CASE --out {} "
                    "--resume` goes on with what it has",
                    folder.string()));
  throw NotFinished("its run has not ended: there is no result.json");
}

/// All errors, one per line. @throws WrongInput if there are any.
void require_none(const std::vector<InputError>& errors) {
  std::string text;
  for (const InputError& error : errors) text += (text.empty() ? "" : "\n") + error.text();
  if (!text.empty()) throw WrongInput(text);
}

}  // namespace

RunFolder open_run(const fs::path& folder) {
  const std::string verb = verb_of_run(folder);
  RunFolder run{.out = OutputFolder(folder, verb), .verb = verb, .result = {}};
  require_ended(folder, verb);
  const std::string file = run.file("result.json").string();
  const FileText text = read_file(file);
  if (!text.fault.empty()) throw WrongInput(file + ": cannot be read: " + text.fault);
  try {
    run.result = checked_json(text.text);
  } catch (const WrongInput& fault) {
    throw WrongInput(file + ": " + fault.what());
  }
  return run;
}

namespace {

/// A file that the run has written: nothing that may never end, as a pipe. What is absent is told by its
/// reader.
fs::path own_file(const RunFolder& run, const std::string& name) {
  fs::path file = run.file(name);
  std::error_code error;
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw WrongInput(file.string() + ": is no file that a run has written");
  return file;
}

}  // namespace

Case case_in(const RunFolder& run, const std::string& name) {
  CaseReading reading = read_case(own_file(run, name));
  require_none(reading.errors);
  return std::move(reading.definition);
}

Schedule schedule_in(const RunFolder& run, const std::string& name, const RigOptions& rig) {
  ScheduleReading reading = read_schedule(own_file(run, name), rig);
  require_none(reading.errors);
  return std::move(reading.value);
}

}  // namespace drapeplan
