#include "planner/cli/cli.hpp"

#include <fmt/format.h>

#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "planner/base/json_text.hpp"
#include "planner/base/parallel.hpp"
#include "planner/base/quantity.hpp"
#include "planner/base/text.hpp"
#include "planner/cli/process.hpp"
#include "planner/schedule/robot_files.hpp"

namespace drapeplan {
namespace {

constexpr int kIndent = 2;  // of JSON output

bool has_section(const Case& definition, const std::string& name) {
  if (name == "mapping") return definition.mapping.has_value();
  if (name == "grippers") return definition.grippers.has_value();
  if (name == "mold") return definition.mold.has_value();
  return definition.material.thickness > 0;
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

void add_only(CLI::App& verb, std::vector<std::string>& only, const std::string& things) {
  verb.add_option("--only", only, fmt::format("only {} whose group and name hold this text (repeatable)", things))
      ->type_name("TEXT");
}

void do_all(size_t count, const CommonOptions& options, const std::function<DoneLine(size_t)>& act) {
  std::mutex printing;
  size_t done = 0;
  parallel_for(
      int(count),
      [&](int k) {
        const DoneLine line = act(size_t(k));
        const std::lock_guard<std::mutex> lock(printing);
        ++done;
        if (!options.quiet)
          std::cerr << fmt::format("{:3} of {}, {:5.1f} s  {}\n", done, count, line.seconds, line.words);
      },
      options.threads);
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
  if (!options.quiet && errors.empty()) {
    for (const std::string& note : reading.notes) std::cerr << fmt::format("note: {}: {}\n", file, note);
  }
  if (options.seed) reading.definition.optimise.seed = *options.seed;
  return std::move(reading.definition);
}

Case load_case(const std::string& file, const CommonOptions& options, const std::vector<std::string>& needs) {
  std::vector<InputError> errors;
  Case definition = load_case(file, options, needs, errors);
  if (!errors.empty()) throw InputErrors(errors);
  return definition;
}

void add_cycle(CLI::App& verb, std::string& cycle) {
  verb.add_option(
          "--cycle", cycle,
          fmt::format("cycle of the robot's controller, as \"4 ms\", for schedule.csv and the other files "
                      "for a robot (default: {:g} ms)",
                      1e3 * kDefaultCycle))
      ->type_name("TIME");
}

double cycle_of(const std::string& text) {
  if (text.empty()) return kDefaultCycle;
  std::string fault;
  const std::optional<double> time = parse_quantity(text, Dimension::time, fault);
  if (!time) throw WrongInput("--cycle: " + fault);
  if (is_cycle(*time)) return *time;
  throw WrongInput(
      fmt::format("--cycle: \"{}\": out of range; allowed: whole microseconds from {:g} ms to {:g} ms", text,
                  1e3 * kShortestCycle, 1e3 * kLongestCycle));
}

OutputFolder take_folder(const CommonOptions& options, const std::string& verb) {
  return options.out.empty() ? OutputFolder() : OutputFolder(options.out, verb);
}

void begin_output(OutputFolder& out, const CommonOptions& options, const std::vector<std::string>& kept) {
  print_set_aside(out.begin(kept), options);
}

void print_set_aside(const std::filesystem::path& earlier, const CommonOptions& options) {
  if (!options.quiet && !earlier.empty())
    std::cerr << fmt::format("what an earlier run left is set aside in {}\n", earlier.string());
}

void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options) {
  if (options.quiet) return;
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
}

std::string document_text(const nlohmann::json& result) {
  return dump_json(result, kIndent) + "\n";
}

void deliver(const nlohmann::json& result, const std::string& text, const CommonOptions& options,
             const Case* resolved) {
  const std::string document = document_text(result);
  if (!options.out.empty()) {
    const std::filesystem::path folder(options.out);
    write_text(folder / "result.json", document);
    if (resolved != nullptr) write_text(folder / "resolved.json", document_text(resolved_case(*resolved)));
  }
  if (options.json || !options.quiet) print(options.json ? document : text, !options.out.empty());
}

}  // namespace drapeplan
