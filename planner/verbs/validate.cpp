// validate: comparisons with outside codes, closed forms and measurements.
#include "planner/validate/validate.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "planner/base/text.hpp"
#include "planner/validate/files.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

struct ValidateOptions {
  CommonOptions common;
  std::vector<std::string> only;
};

int validate(const ValidateOptions& options) {
  if (!options.common.overrides.empty() || options.common.seed)
    throw WrongInput("--set and --seed: comparisons are no case files, nothing can be changed in them");
  const std::vector<Comparison> chosen = chosen_of(comparisons(), options.only);
  if (chosen.empty())
    throw WrongInput("no comparison has a name with such a text; run it without --only to see all");
  OutputFolder out = take_folder(options.common, "validate");
  begin_output(out, options.common);
  std::vector<ComparisonResult> results(chosen.size());
  do_all(chosen.size(), options.common, [&](size_t k) {
    results[k] = run_comparison(chosen[k]);
    return DoneLine{results[k].seconds, fmt::format("{}: {}", results[k].group, results[k].name)};
  });
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
      [](CLI::App& verb, ValidateOptions& options) { add_only(verb, options.only, "comparisons"); },
      validate);
}

}  // namespace drapeplan
