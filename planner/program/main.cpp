// The drapeplan program: one verb per call; verbs live in planner/verbs.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "planner/base/spelling.hpp"
#include "planner/cli/process.hpp"
#include "planner/program/command_line.hpp"

namespace drapeplan {
namespace {

/// True if the first argument is no verb, with an error that names the nearest one.
bool names_no_verb(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;  // options of the program itself, e.g. --help
  const std::string word = argv[1];
  const auto has_this_name = [&word](const CLI::App* verb) { return verb->get_name() == word; };
  if (!program.get_subcommands(has_this_name).empty()) return false;
  std::vector<std::string> verbs;
  for (const CLI::App* verb : shown_verbs(program)) verbs.push_back(verb->get_name());
  const std::string nearest = nearest_word(word, verbs);
  const std::string hint =
      nearest.empty() ? "expected " + alternatives_text(verbs) : fmt::format("did you mean \"{}\"?", nearest);
  std::cerr << fmt::format("drapeplan: there is no verb \"{}\"; {}\n", word, hint);
  return true;
}

int run(int argc, char** argv) {
  Action action;
  const std::unique_ptr<CLI::App> program = make_command_line(action);
  if (names_no_verb(*program, argc, argv)) return kInputWrong;
  try {
    program->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program->exit(error) == 0 ? kDone : kInputWrong;
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
