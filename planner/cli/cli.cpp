#include "planner/cli/cli.hpp"

#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "planner/base/json_text.hpp"

namespace drapeplan {
namespace {

constexpr int kIndent = 2;  // of JSON output

bool has_section(const Case& definition, const std::string& name) {
  if (name == "mapping") return definition.mapping.has_value();
  if (name == "grippers") return definition.grippers.has_value();
  if (name == "mold") return definition.mold.has_value();
  return definition.material.thickness > 0;
}

bool write_json(const std::filesystem::path& file, const nlohmann::json& value) {
  std::ofstream stream(file);
  stream << dump_json(value, kIndent) << '\n';
  stream.close();
  if (!stream) std::cerr << file.string() << ": cannot be written\n";
  return bool(stream);
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

void print_errors(const std::vector<InputError>& errors) {
  for (const InputError& error : errors) std::cerr << error.text() << '\n';
  if (errors.size() > 1) std::cerr << errors.size() << " errors\n";
}

std::optional<Case> load_case(const std::string& file, const CommonOptions& options,
                              const std::vector<std::string>& needs) {
  CaseReading reading = read_case(file, options.overrides);
  if (reading.errors.empty()) {
    for (const std::string& need : needs) {
      if (has_section(reading.definition, need)) continue;
      reading.errors.push_back(
          {file, 0, "", "this verb needs the section \"" + need + "\", which is absent"});
    }
  }
  if (!reading.errors.empty()) {
    print_errors(reading.errors);
    return std::nullopt;
  }
  if (!options.out.empty() && std::filesystem::exists(options.out) &&
      !std::filesystem::is_directory(options.out)) {
    std::cerr << options.out << ": --out must be a folder\n";
    return std::nullopt;
  }
  if (options.seed) reading.definition.optimise.seed = *options.seed;
  return std::move(reading.definition);
}

void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options) {
  if (options.quiet) return;
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
}

int deliver(const nlohmann::json& result, const std::string& text, const CommonOptions& options,
            const Case* resolved) {
  if (options.json) {
    std::cout << dump_json(result, kIndent) << '\n';
  } else if (!options.quiet) {
    std::cout << text;
  }
  std::cout.flush();
  if (options.out.empty()) return kDone;
  const std::filesystem::path folder(options.out);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    std::cerr << options.out << ": cannot be made: " << error.message() << '\n';
    return kNotFinished;
  }
  bool written = write_json(folder / "result.json", result);
  if (resolved != nullptr)
    written = write_json(folder / "resolved.json", resolved_case(*resolved)) && written;
  return written ? kDone : kNotFinished;
}

}  // namespace drapeplan
