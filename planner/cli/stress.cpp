// stress: numerical stability on stiff and extreme scenes, as a table.
#include <cstdio>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "planner/base/parallel.hpp"
#include "planner/base/text.hpp"
#include "planner/cli/cli.hpp"
#include "planner/stress/stress.hpp"

namespace drapeplan {
namespace {

struct StressOptions {
  CommonOptions common;
  std::vector<std::string> only;
  bool fast = false;
};

std::vector<StressScene> chosen_scenes(const StressOptions& options) {
  std::vector<StressScene> chosen;
  for (StressScene& scene : stress_scenes()) {
    bool wanted = options.only.empty();
    for (const std::string& text : options.only)
      wanted = wanted || (scene.group + ": " + scene.name).find(text) != std::string::npos;
    if (wanted && (scene.fast || !options.fast)) chosen.push_back(std::move(scene));
  }
  return chosen;
}

std::string line_of(const StressOutcome& outcome) {
  char head[300];
  std::snprintf(head, sizeof head, "%-8s %-16s %s: ", verdict_name(outcome.verdict), outcome.group.c_str(),
                outcome.name.c_str());
  return head + outcome.reason + "\n";
}

int stress(const StressOptions& options) {
  if (!options.common.overrides.empty() || options.common.seed) {
    std::cerr << "stress: --set and --seed: its scenes are no case files, nothing can be changed in them\n";
    return kInputWrong;
  }
  const std::vector<StressScene> scenes = chosen_scenes(options);
  if (scenes.empty()) {
    std::cerr << "stress: no scene has a name with such a text; run it without --only to see all\n";
    return kInputWrong;
  }
  if (!options.common.out.empty()) {  // minutes of runs are not to be lost
    std::error_code error;
    std::filesystem::create_directories(options.common.out, error);
    if (error) {
      std::cerr << options.common.out << ": cannot be made: " << error.message() << '\n';
      return kInputWrong;
    }
  }
  std::vector<StressOutcome> outcomes(scenes.size());
  std::mutex printing;
  size_t done = 0;
  parallel_for(
      int(scenes.size()),
      [&](int k) {
        outcomes[size_t(k)] = play_stress(scenes[size_t(k)]);
        const std::lock_guard<std::mutex> lock(printing);
        ++done;
        if (options.common.quiet) return;
        char time[60];
        std::snprintf(time, sizeof time, "%3zu of %zu, %5.1f s  ", done, scenes.size(),
                      outcomes[size_t(k)].wall_seconds);
        std::cerr << time << line_of(outcomes[size_t(k)]);
      },
      options.common.threads);
  const nlohmann::json result = stress_json(outcomes);
  std::string text;
  for (const StressOutcome& outcome : outcomes) text += line_of(outcome);
  text += "\n" + std::to_string(outcomes.size()) + " scenes, " + std::to_string(result["failures"].size()) +
          " wrong\n";
  const int code = deliver(result, text, options.common);
  if (code == kDone && !options.common.out.empty()) {
    const std::filesystem::path folder(options.common.out);
    write_text(folder / "stress.csv", stress_csv(outcomes));
    write_text(folder / "stress.md", stress_markdown(outcomes));
  }
  return result["failures"].empty() ? code : kNotFinished;
}

}  // namespace

void add_stress(CLI::App& program, Action& action) {
  add_verb<StressOptions>(
      program, action, "stress", "numerical stability on stiff and extreme scenes, as a table",
      [](CLI::App& verb, StressOptions& options) {
        verb.add_option("--only", options.only,
                        "only scenes whose group and name hold this text (repeatable)")
            ->type_name("TEXT");
        verb.add_flag("--fast", options.fast, "only the scenes that the tests run, some seconds");
      },
      stress);
}

}  // namespace drapeplan
