#include "planner/cli/cli.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "planner/base/text.hpp"
#include "planner/cli/streams.hpp"

namespace drapeplan {
namespace {

constexpr int kIndent = 2;  // of JSON output

bool has_section(const Case& definition, const std::string& name) {
  if (name == "mapping") return definition.mapping.has_value();
  if (name == "grippers") return definition.grippers.has_value();
  if (name == "mold") return definition.mold.has_value();
  return definition.material.thickness > 0;
}

[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const std::string& reason) {
  throw WrongInput(fmt::format("{}: results cannot be written there: {}", folder.string(), reason));
}

/// Whether a file can be made in it; `access` would say so of folders of /proc, too.
bool takes_files(const std::filesystem::path& folder, std::string& reason) {
  std::string trial = (folder / "trial.XXXXXX").string();
  const int file = mkstemp(trial.data());
  if (file < 0) {
    reason = std::generic_category().message(errno);
    return false;
  }
  close(file);
  unlink(trial.c_str());
  return true;
}

}  // namespace

void add_common_options(CLI::App& verb, CommonOptions& options) {
  verb.add_option("--out", options.out, "folder for result.json, resolved.json and all other files")
      ->type_name("DIR");
  verb.add_option("--threads", options.threads, "number of threads (default: one per core)")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  verb.add_option("--seed", options.seed, "seed of all random numbers (default: the case's)")->type_name("N");
  verb.add_option("--set", options.overrides,
                  "changes one field, e.g. --set ply.width=\"400 mm\" (repeatable)")
      ->type_name("PATH=VALUE")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  verb.add_flag("--json", options.json, "the result as one JSON document on stdout");
  verb.add_flag("--quiet", options.quiet, "only errors on stderr, and nothing on stdout but --json");
}

int run_guarded(const std::function<int()>& work, const std::string& subject) {
  try {
    return work();
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    print_failure(failure, subject);
    return failure.code;
  }
}

Case load_case(const std::string& file, const CommonOptions& options, const std::vector<std::string>& needs,
               std::vector<InputError>& errors) {
  CaseReading reading = read_case(file, options.overrides);
  if (reading.errors.empty()) {
    for (const std::string& need : needs) {
      if (has_section(reading.definition, need)) continue;
      reading.errors.push_back(
          {file, 0, "", fmt::format("this verb needs the section \"{}\", which is absent", need)});
    }
  }
  errors.insert(errors.end(), reading.errors.begin(), reading.errors.end());
  if (options.seed) reading.definition.optimise.seed = *options.seed;
  return std::move(reading.definition);
}

Case load_case(const std::string& file, const CommonOptions& options, const std::vector<std::string>& needs) {
  std::vector<InputError> errors;
  Case definition = load_case(file, options, needs, errors);
  if (!errors.empty()) throw InputErrors(errors);
  return definition;
}

void try_folder(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  std::vector<std::filesystem::path> absent;  // the innermost first
  for (std::filesystem::path at = std::filesystem::absolute(folder, error); !error; at = at.parent_path()) {
    if (exists(status(at, error))) break;
    if (error && error != std::errc::no_such_file_or_directory) refuse_folder(folder, error.message());
    error.clear();
    if (at == at.parent_path()) break;
    absent.push_back(at);
  }
  create_directories(folder, error);
  std::string reason = error.message();
  const bool usable = !error && takes_files(folder, reason);
  for (const std::filesystem::path& made : absent) {
    std::error_code ignored;
    remove(made, ignored);
  }
  if (!usable) refuse_folder(folder, reason);
}

void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options) {
  if (options.quiet) return;
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
}

std::string document_text(const nlohmann::json& result) {
  return result.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void deliver(const nlohmann::json& result, const std::string& text, const CommonOptions& options,
             const Case* resolved) {
  const std::string document = document_text(result);
  if (!options.out.empty()) {
    const std::filesystem::path folder(options.out);
    create_directories(folder);
    write_text(folder / "result.json", document);
    if (resolved != nullptr) write_text(folder / "resolved.json", document_text(resolved_case(*resolved)));
  }
  if (options.json || !options.quiet) print(options.json ? document : text, !options.out.empty());
}

}  // namespace drapeplan
