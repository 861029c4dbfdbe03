// characterise: raw test data to a material file.
#include "planner/characterise/characterise.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "planner/characterise/files.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

struct CharacteriseOptions {
  CommonOptions common;
  std::string file;
};

int run_characterise(const CharacteriseOptions& options) {
  TestsReading reading = read_tests(options.file, options.common.overrides);
  if (!reading.errors.empty()) throw InputErrors(reading.errors);
  OutputFolder out = take_folder(options.common, "characterise");
  const Characterisation found =
      characterise(reading.tests, options.common.threads, [&](const std::string& what) {
        if (!options.common.quiet) std::cerr << what << '\n';
      });
  begin_output(out, options.common);
  if (!options.common.out.empty()) write_characterisation(options.common.out, reading.tests, found);
  deliver(characterisation_json(found), characterisation_text(found), options.common);
  return kDone;
}

}  // namespace

void add_characterise(CLI::App& program, Action& action) {
  add_verb<CharacteriseOptions>(
      program, action, "characterise", "turns raw test data into a material file",
      [](CLI::App& verb, CharacteriseOptions& options) {
        verb.add_option("TESTS", options.file, "file of tests")->required();
      },
      run_characterise);
}

}  // namespace drapeplan
