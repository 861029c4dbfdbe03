// What the command line says of itself elsewhere: its man page and its completion in bash, made from the same
// verbs and options that are parsed.
#pragma once

#include <string>

#include "planner/cli/cli.hpp"

namespace drapeplan {

/// drapeplan(1), in the macros of man(7).
std::string man_page(const CLI::App& program);

/// A script for bash: verbs, options, their words, and files of the kind that an option or a verb takes.
std::string bash_completion(const CLI::App& program);

/// Adds the verbs `man` and `completion`, which print these; help does not show them. `program` must outlive
/// the action.
void add_documents(CLI::App& program, Action& action);

}  // namespace drapeplan
