// The command line as a whole: all verbs, what each shows as examples, and the version.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "planner/cli/cli.hpp"

namespace drapeplan {

/// All verbs. @param action  what the chosen one does; must outlive the object.
std::unique_ptr<CLI::App> make_command_line(Action& action);

/// The verbs that help shows, in its order.
std::vector<const CLI::App*> shown_verbs(const CLI::App& program);

/// Number, instruction set and compiler, a line each.
std::string version_text();

}  // namespace drapeplan
