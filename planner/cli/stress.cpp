// stress: numerical stability on stiff and extreme scenes, as a table.
#include <fmt/format.h>

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
      wanted = wanted || fmt::format("{}: {}", scene.group, scene.name).find(text) != std::string::npos;
    if (wanted && (scene.fast || !options.fast)) chosen.push_back(std::move(scene));
  }
  return chosen;
}

std::string line_of(const StressOutcome& outcome) {
  return fmt::format("{:<8} {:<16} {}: {}\n", verdict_name(outcome.verdict), outcome.group, outcome.name,
                     outcome.reason);
}

/// Plays the scenes side by side; each has a line on stderr when it is done.
std::vector<StressOutcome> play_all(const std::vector<StressScene>& scenes, const CommonOptions& options) {
  std::vector<StressOutcome> outcomes(scenes.size());
  std::mutex printing;
  size_t done = 0;
  parallel_for(
      int(scenes.size()),
      [&](int k) {
        outcomes[size_t(k)] = play_stress(scenes[size_t(k)]);
        const std::lock_guard<std::mutex> lock(printing);
        ++done;
        if (options.quiet) return;
        std::cerr << fmt::format("{:3} of {}, {:5.1f} s  {}", done, scenes.size(),
                                 outcomes[size_t(k)].wall_seconds, line_of(outcomes[size_t(k)]));
      },
      options.threads);
  return outcomes;
}

int stress(const StressOptions& options) {
  if (!options.common.overrides.empty() || options.common.seed)
    throw WrongInput("--set and --seed: its scenes are no case files, nothing can be changed in them");
  const std::vector<StressScene> scenes = chosen_scenes(options);
  if (scenes.empty())
    throw WrongInput("no scene has a name with such a text; run it without --only to see all");
  OutputFolder out = take_folder(options.common, "stress");
  begin_output(out, options.common);
  const std::vector<StressOutcome> outcomes = play_all(scenes, options.common);
  const nlohmann::json result = stress_json(outcomes);
  std::string text;
  for (const StressOutcome& outcome : outcomes) text += line_of(outcome);
  text += fmt::format("\n{} scenes, {} wrong\n", outcomes.size(), result["failures"].size());
  if (!options.common.out.empty()) {
    const std::filesystem::path folder(options.common.out);
    write_text(folder / "stress.csv", stress_csv(outcomes));
    write_text(folder / "stress.md", stress_markdown(outcomes));
  }
  deliver(result, text, options.common);
  return result["failures"].empty() ? kDone : kNotFinished;
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
