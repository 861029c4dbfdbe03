// The drapeplan program: one verb per call; every verb lives in its own <verb>.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "planner/base/spelling.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

/// True if the first argument is no verb, with an error that names the nearest one.
bool names_no_verb(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;  // options of the program itself, e.g. --help
  std::vector<std::string> verbs;
  for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back(verb->get_name());
  const std::string word = argv[1];
  if (std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return false;
  const std::string nearest = nearest_word(word, verbs);
  const std::string hint =
      nearest.empty() ? "expected " + alternatives_text(verbs) : fmt::format("did you mean \"{}\"?", nearest);
  std::cerr << fmt::format("drapeplan: there is no verb \"{}\"; {}\n", word, hint);
  return true;
}

int run(int argc, char** argv) {
  CLI::App program("Plans the draping of woven prepreg plies by a grid of grippers.", "drapeplan");
  program.require_subcommand(1);
  Action action;
  add_plan(program, action);
  add_map(program, action);
  add_reach(program, action);
  add_simulate(program, action);
  add_report(program, action);
  add_bench(program, action);
  add_study(program, action);
  add_characterise(program, action);
  add_validate(program, action);
  add_stress(program, action);
  add_check(program, action);
  add_schema(program, action);
  add_explain(program, action);
  if (names_no_verb(program, argc, argv)) return kInputWrong;
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kDone : kInputWrong;
  }
  return action();
}

}  // namespace
}  // namespace drapeplan

int main(int argc, char** argv) {
  using namespace drapeplan;
  prepare_streams();
  return run_guarded(
      [argc, argv] {
        const int code = run(argc, argv);
        if (!std::cout.flush()) throw NotFinished("stdout: cannot be written");  // of --help
        return code;
      },
      "");
}
