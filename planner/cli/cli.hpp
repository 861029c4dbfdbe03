// What the verbs of the program share: options, exit codes, reading cases, writing results.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planner/base/output_folder.hpp"
#include "planner/case/case.hpp"
#include "planner/case/file.hpp"
#include "planner/cli/process.hpp"

namespace drapeplan {

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

void add_common_options(CLI::App& verb, CommonOptions& options);

/// Calls `work`, and turns what it throws into a message and an exit code.
/// @param subject  what the work is about, for the message: a case file or the verb.
int run_guarded(const std::function<int()>& work, const std::string& subject);

/// Adds one verb. `Options` has the shared ones in its member `common`, and a verb of one case has its file
/// in `file`.
/// @param describe  describe(CLI::App&, Options&) adds the verb's own arguments and options.
/// @param run       run(const Options&) does the work and returns the exit code, or throws.
template <class Options, class Describe, class Run>
void add_verb(CLI::App& program, Action& action, const char* name, const char* text, const Describe& describe,
              const Run& run) {
  CLI::App* verb = program.add_subcommand(name, text);
  const auto options = std::make_shared<Options>();  // lives as long as CLI11 keeps the callback
  add_common_options(*verb, options->common);
  describe(*verb, *options);
  verb->callback([&action, options, run, name] {
    action = [options, run, name] {
      std::string subject = name;
      if constexpr (requires { options->file; }) subject = options->file;
      return run_guarded([&] { return run(*options); }, subject);
    };
  });
}

/// Adds --only, which `chosen_of` reads. @param things  what it chooses from: "scenes".
void add_only(CLI::App& verb, std::vector<std::string>& only, const std::string& things);

/// Things with a group and a name whose "group: name" holds one of the texts; all if there are none.
template <class Thing>
std::vector<Thing> chosen_of(std::vector<Thing> all, const std::vector<std::string>& only) {
  const auto unwanted = [&only](const Thing& thing) {
    const std::string name = thing.group + ": " + thing.name;
    return std::none_of(only.begin(), only.end(),
                        [&](const std::string& text) { return name.find(text) != std::string::npos; });
  };
  if (!only.empty()) std::erase_if(all, unwanted);
  return all;
}

/// What is said of a thing that is done.
struct DoneLine {
  double seconds = 0;  ///< that it took
  std::string words;
};

/// Does things side by side; each has a line on stderr when it is done, unless --quiet.
/// @param act  act(k) does the k-th one.
void do_all(size_t count, const CommonOptions& options, const std::function<DoneLine(size_t)>& act);

/// The case in `file` with the overrides (and the seed) of the command line.
/// @param needs  sections that the verb cannot do without: "mapping", "grippers", "material", "mold".
/// @throws InputErrors with all that is wrong with it.
Case load_case(const std::string& file, const CommonOptions& options,
               const std::vector<std::string>& needs = {});

/// As `load_case`, but its errors are added to a list: for verbs of many cases.
Case load_case(const std::string& file, const CommonOptions& options, const std::vector<std::string>& needs,
               std::vector<InputError>& errors);

/// Adds --cycle, which `cycle_of` reads.
void add_cycle(CLI::App& verb, std::string& cycle);

/// The cycle of the robot's controller [s]; that of robot_files.hpp if the text is empty.
/// @throws WrongInput  unless it is a time within the limits there.
double cycle_of(const std::string& text);

/// Takes the folder of --out for this verb, before the work begins; no folder if none is named.
/// @throws WrongInput with the place and the reason.
OutputFolder take_folder(const CommonOptions& options, const std::string& verb);

/// Sets aside what an earlier run left in the folder, and says where on stderr, unless --quiet.
void begin_output(OutputFolder& out, const CommonOptions& options, const std::vector<std::string>& kept = {});

/// Says on stderr, unless --quiet, where results of an earlier run were moved to; nothing if there were none.
void print_set_aside(const std::filesystem::path& earlier, const CommonOptions& options);

/// Warnings of the mapping on stderr, unless --quiet.
void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options);

/// A result as the text of a JSON document; bytes that are not UTF-8, of a file's name say, are replaced.
std::string document_text(const nlohmann::json& result);

/// Writes result.json (and resolved.json if there is a case) under --out; then the result goes to stdout as
/// text for people, or as JSON with --json. To be called after all other files were written: a reader of
/// stdout may be gone.
/// @throws NotFinished with the reason if something cannot be written.
void deliver(const nlohmann::json& result, const std::string& text, const CommonOptions& options,
             const Case* resolved = nullptr);

}  // namespace drapeplan
