// The drapeplan program: one verb per call; every verb lives in its own cli_<verb>.cpp.
#include <exception>
#include <iostream>

#include "planner/cli.hpp"

int main(int argc, char** argv) {
  using namespace drapeplan;
  try {
    CLI::App program("Plans the draping of woven prepreg plies by a grid of grippers.", "drapeplan");
    program.require_subcommand(1);
    Action action;
    add_plan(program, action);
    add_map(program, action);
    add_reach(program, action);
    add_simulate(program, action);
    add_bench(program, action);
    add_check(program, action);
    add_schema(program, action);
    add_explain(program, action);
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return program.exit(error) == 0 ? kDone : kInputWrong;
    }
    return action();
  } catch (const std::exception& error) {
    std::cerr << "drapeplan: a bug: " << error.what() << '\n';
    return kBug;
  }
}
