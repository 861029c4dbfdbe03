// What the verbs of the program share: options, exit codes, reading cases, writing results.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/case/file.hpp"

namespace drapeplan {

enum ExitCode : int { kDone = 0, kInputWrong = 2, kNotFinished = 3, kBug = 4 };

/// Options of every verb.
struct CommonOptions {
  std::string out;  ///< folder for files; empty: none are written
  int threads = 0;  ///< 0: as many as there are cores
  std::optional<unsigned> seed;
  std::vector<std::string> overrides;  ///< path=value
  bool json = false;
  bool quiet = false;
};

/// What the chosen verb does; returns the exit code. Set while the command line is parsed, called afterwards.
using Action = std::function<int()>;

/// One function per verb, in planner/cli/<verb>.cpp. `action` must outlive the parsing.
void add_check(CLI::App& program, Action& action);
void add_schema(CLI::App& program, Action& action);
void add_explain(CLI::App& program, Action& action);
void add_plan(CLI::App& program, Action& action);
void add_simulate(CLI::App& program, Action& action);
void add_map(CLI::App& program, Action& action);
void add_reach(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action);
void add_stress(CLI::App& program, Action& action);
void add_study(CLI::App& program, Action& action);

void add_common_options(CLI::App& verb, CommonOptions& options);

/// Adds one verb. `Options` has the shared ones in its member `common`.
/// @param describe  describe(CLI::App&, Options&) adds the verb's own arguments and options.
/// @param run       run(const Options&) does the work and returns the exit code.
template <class Options, class Describe, class Run>
void add_verb(CLI::App& program, Action& action, const char* name, const char* text, const Describe& describe,
              const Run& run) {
  CLI::App* verb = program.add_subcommand(name, text);
  const auto options = std::make_shared<Options>();  // lives as long as CLI11 keeps the callback
  add_common_options(*verb, options->common);
  describe(*verb, *options);
  verb->callback([&action, options, run] { action = [options, run] { return run(*options); }; });
}

/// The case in `file` with the overrides (and the seed) of the command line. If something is wrong with it,
/// all errors go to stderr and nothing is returned.
/// @param needs  sections that the verb cannot do without: "mapping", "grippers", "material", "mold".
std::optional<Case> load_case(const std::string& file, const CommonOptions& options,
                              const std::vector<std::string>& needs = {});

/// Prints errors to stderr, one per line, and how many there are.
void print_errors(const std::vector<InputError>& errors);

/// Warnings of the mapping on stderr, unless --quiet.
void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options);

/// The result as text for people, or as JSON with --json; and result.json (with resolved.json if there is a
/// case) under --out. @return kDone, or kNotFinished if a file could not be written (the reason goes to
/// stderr).
int deliver(const nlohmann::json& result, const std::string& text, const CommonOptions& options,
            const Case* resolved = nullptr);

}  // namespace drapeplan
