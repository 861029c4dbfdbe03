// stress: numerical stability on stiff and extreme scenes, as a table.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "planner/base/text.hpp"
#include "planner/stress/stress.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

struct StressOptions {
  CommonOptions common;
  std::vector<std::string> only;
  bool fast = false;
};

std::vector<StressScene> chosen_scenes(const StressOptions& options) {
  std::vector<StressScene> chosen = chosen_of(stress_scenes(), options.only);
  if (options.fast) std::erase_if(chosen, [](const StressScene& scene) { return !scene.fast; });
  return chosen;
}

std::string line_of(const StressOutcome& outcome) {
  return fmt::format("{:<8} {:<16} {}: {}", verdict_name(outcome.verdict), outcome.group, outcome.name,
                     outcome.reason);
}

int stress(const StressOptions& options) {
  if (!options.common.overrides.empty() || options.common.seed)
    throw WrongInput("--set and --seed: its scenes are no case files, nothing can be changed in them");
  const std::vector<StressScene> scenes = chosen_scenes(options);
  if (scenes.empty())
    throw WrongInput("no scene has a name with such a text; run it without --only to see all");
  OutputFolder out = take_folder(options.common, "stress");
  begin_output(out, options.common);
  std::vector<StressOutcome> outcomes(scenes.size());
  do_all(scenes.size(), options.common, [&](size_t k) {
    outcomes[k] = play_stress(scenes[k]);
    return DoneLine{outcomes[k].wall_seconds, line_of(outcomes[k])};
  });
  const nlohmann::json result = stress_json(outcomes);
  std::string text;
  for (const StressOutcome& outcome : outcomes) text += line_of(outcome) + '\n';
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
        add_only(verb, options.only, "scenes");
        verb.add_flag("--fast", options.fast, "only the scenes that the tests run, some seconds");
      },
      stress);
}

}  // namespace drapeplan
