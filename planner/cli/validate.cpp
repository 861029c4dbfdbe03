// validate: comparisons with outside codes, closed forms and measurements.
#include "planner/validate/validate.hpp"

#include <fmt/format.h>

#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "planner/base/parallel.hpp"
#include "planner/base/text.hpp"
#include "planner/cli/cli.hpp"
#include "planner/validate/files.hpp"

namespace drapeplan {
namespace {

struct ValidateOptions {
  CommonOptions common;
  std::vector<std::string> only;
};

std::vector<Comparison> chosen_comparisons(const ValidateOptions& options) {
  std::vector<Comparison> chosen;
  for (Comparison& one : comparisons()) {
    bool wanted = options.only.empty();
    for (const std::string& text : options.only)
      wanted = wanted || fmt::format("{}: {}", one.group, one.name).find(text) != std::string::npos;
    if (wanted) chosen.push_back(std::move(one));
  }
  return chosen;
}

/// Runs them side by side; each has a line on stderr when it is done.
std::vector<ComparisonResult> run_all(const std::vector<Comparison>& chosen, const CommonOptions& options) {
  std::vector<ComparisonResult> results(chosen.size());
  std::mutex printing;
  size_t done = 0;
  parallel_for(
      int(chosen.size()),
      [&](int k) {
        ComparisonResult& result = results[size_t(k)];
        result = run_comparison(chosen[size_t(k)]);
        const std::lock_guard<std::mutex> lock(printing);
        ++done;
        if (options.quiet) return;
        std::cerr << fmt::format("{:2} of {}, {:5.1f} s  {}: {}\n", done, chosen.size(), result.seconds,
                                 result.group, result.name);
      },
      options.threads);
  return results;
}

int validate(const ValidateOptions& options) {
  if (!options.common.overrides.empty() || options.common.seed)
    throw WrongInput("--set and --seed: comparisons are no case files, nothing can be changed in them");
  const std::vector<Comparison> chosen = chosen_comparisons(options);
  if (chosen.empty())
    throw WrongInput("no comparison has a name with such a text; run it without --only to see all");
  OutputFolder out = take_folder(options.common, "validate");
  begin_output(out, options.common);
  const std::vector<ComparisonResult> results = run_all(chosen, options.common);
  if (!options.common.out.empty()) {
    const std::filesystem::path folder(options.common.out);
    write_text(folder / "validate.md", validation_markdown(results));
    write_text(folder / "validation.html", validation_page(results));
  }
  const nlohmann::json document = validation_json(results);
  deliver(document, validation_text(results), options.common);
  return document["failures"].empty() ? kDone : kNotFinished;
}

}  // namespace

void add_validate(CLI::App& program, Action& action) {
  add_verb<ValidateOptions>(
      program, action, "validate",
      "comparisons with outside codes, closed forms and measurements, as a table",
      [](CLI::App& verb, ValidateOptions& options) {
        verb.add_option("--only", options.only,
                        "only comparisons whose group and name hold this text (repeatable)")
            ->type_name("TEXT");
      },
      validate);
}

}  // namespace drapeplan
