// The verbs of the program: one function per verb adds it to the command line; each lives in its own
// <verb>.cpp.
#pragma once

#include "planner/cli/cli.hpp"

namespace drapeplan {

/// `action` must outlive the parsing.
void add_bench(CLI::App& program, Action& action);
void add_characterise(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_explain(CLI::App& program, Action& action);
void add_map(CLI::App& program, Action& action);
void add_new(CLI::App& program, Action& action);
void add_plan(CLI::App& program, Action& action);
void add_reach(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_schema(CLI::App& program, Action& action);
void add_simulate(CLI::App& program, Action& action);
void add_stress(CLI::App& program, Action& action);
void add_study(CLI::App& program, Action& action);
void add_validate(CLI::App& program, Action& action);

/// Maps the ply and builds the models of its runs, as far as the case has these (check.cpp).
/// @return warnings.  @throws WrongInput, NotFinished.
std::vector<std::string> try_case(const Case& definition);

}  // namespace drapeplan
