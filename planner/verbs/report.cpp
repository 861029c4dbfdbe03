// report: the page of a run, and the other files that people look at, made again from the files of the run.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "mapping/error.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/replay/page_again.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct ReportOptions {
  CommonOptions common;
  std::string file;  ///< the folder of the run
};

/// @throws WrongInput for what would make it the page of another run.
void refuse_options(const CommonOptions& options) {
  if (!options.out.empty())
    throw WrongInput(
        "--out: the page lies beside the results that it links to; copy the folder of the run instead");
  if (!options.overrides.empty() || options.seed)
    throw WrongInput(
        "--set, --seed: the page is of the run as it was; its tolerances, too, are part of the objective "
        "that was "
        "searched. To see a schedule judged otherwise: drapeplan simulate RUN_DIR/resolved.json --schedule "
        "RUN_DIR/schedule.json --set ...");
}

json drapes_json(const PageAgain& again) {
  json list = json::array();
  for (const ReplayedDrape& drape : again.drapes)
    list.push_back({{"name", drape.name},
                    {"recorded_hash", drape.recorded_hash},
                    {"state_hash", drape.state_hash},
                    {"recorded_objective", finite(drape.recorded_objective)},
                    {"objective", finite(drape.objective)},
                    {"same", drape.same()}});
  return list;
}

int report(const ReportOptions& options) {
  refuse_options(options.common);
  const RunFolder run = open_run(options.file);
  const PageAgain again = make_page_again(run, options.common.threads);
  print_warnings(again.warnings, options.common);
  const std::string page = run.file("report.html").string();
  const json result{{"run", options.file},
                    {"verb", run.verb},
                    {"report", page},
                    {"drapes", drapes_json(again)},
                    {"warnings", again.warnings}};
  const std::string same = again.warnings.empty() ? "the same bits as recorded" : "not the same as recorded";
  deliver(result,
          fmt::format("{} played again, {}; report: {}\n",
                      again.drapes.size() == 1 ? "the run was" : "three drapes were", same, page),
          options.common);
  return kDone;
}

}  // namespace

void add_report(CLI::App& program, Action& action) {
  add_verb<ReportOptions>(
      program, action, "report",
      "makes the page of a run again from its files; its drapes are played, not searched",
      [](CLI::App& verb, ReportOptions& options) {
        verb.add_option("RUN_DIR", options.file, "folder that plan or simulate --out has made")->required();
      },
      report);
}

}  // namespace drapeplan
