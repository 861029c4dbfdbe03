#include "planner/program/command_line.hpp"

#include <fmt/format.h>

#include <array>

#include "fem/core/lanes.hpp"
#include "planner/program/documents.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

struct Example {
  const char* verb;  ///< empty: of the program
  const char* command;
  const char* meaning;
};

/// In the order of a first hour with the program.
constexpr std::array kExamples{
    Example{"", "drapeplan new mine.json", "a case to start from"},
    Example{"", "drapeplan check mine.json", "what is wrong with it"},
    Example{"", "drapeplan simulate mine.json --fidelity screen --out out/first",
            "one quick drape; open out/first/report.html"},
    Example{"", "drapeplan plan mine.json", "the search; open out/mine/report.html"},
    Example{"", "drapeplan plan --help", "options and examples of a verb"},
    Example{"plan", "drapeplan plan mine.json --budget \"30 min\" --out out/mine",
            "more time than the case says"},
    Example{"plan", "drapeplan plan mine.json --resume", "goes on with what an earlier run has evaluated"},
    Example{"plan", "drapeplan plan mine.json --set friction.coefficient=0.5 --out out/slippery",
            "one field changed"},
    Example{"plan", "drapeplan plan a.json b.json --out out/both", "several; out/both/summary.html has all"},
    Example{"simulate", "drapeplan simulate mine.json --schedule wave --out out/wave", "a baseline"},
    Example{"simulate", "drapeplan simulate mine.json --schedule out/mine/schedule.json",
            "a schedule of a plan"},
    Example{"map", "drapeplan map mine.json --out out/map",
            "targets, boundary and shear, as tables and for ParaView"},
    Example{"reach", "drapeplan reach mine.json", "how close the rig can come, and what would help"},
    Example{"report", "drapeplan report out/mine",
            "the page of a run, after it was lost or with a newer program"},
    Example{"characterise", "drapeplan characterise tests.json --out out/material",
            "material.json and its page"},
    Example{"new", "drapeplan new mine.json --ply 600x400 --grippers 7x5", "of a size of ply and rig"},
    Example{"new", "drapeplan new mine.json --mold stl=tool.stl --unit \"1 mm\"", "on a mold of yours"},
    Example{"check", "drapeplan check mine.json --json", "errors with file, line and path, for scripts"},
    Example{"schema", "drapeplan schema > drapeplan-case-1.schema.json",
            "beside a case: editors complete and check it"},
    Example{"explain", "drapeplan explain grippers.spacing", "meaning, unit, range and default of a field"},
    Example{"explain", "drapeplan explain grippers", "of all fields of a section"},
    Example{"study", "drapeplan study mine.json --part sweep --out out/study", "error against run time"},
    Example{"bench", "drapeplan bench mine.json --scene case", "element updates per second of a case"},
    Example{"stress", "drapeplan stress --fast", "stiff and extreme scenes, in seconds"},
    Example{"validate", "drapeplan validate --out out/validate",
            "comparisons with others, as table and page"}};

std::string examples_of(const std::string& verb) {
  std::string text;
  for (const Example& example : kExamples) {
    if (verb == example.verb) text += fmt::format("  {}\n      {}\n", example.command, example.meaning);
  }
  return text.empty() ? "" : "Examples:\n" + text;
}

/// The widest instruction set that the program was compiled for.
constexpr const char* instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__AVX__)
  return "AVX";
#elif defined(__ARM_FEATURE_SVE)
  return "SVE";
#elif defined(__ARM_NEON)
  return "NEON";
#elif defined(__SSE2__)
  return "SSE2";
#else
  return "none with lanes";
#endif
}

}  // namespace

std::string version_text() {
  return fmt::format("drapeplan {}\ninstruction set: {}, {} doubles at once\ncompiler: {}", DRAPEPLAN_VERSION,
                     instruction_set(), kLanes, DRAPEPLAN_COMPILER);
}

std::vector<const CLI::App*> shown_verbs(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

std::unique_ptr<CLI::App> make_command_line(Action& action) {
  auto program = std::make_unique<CLI::App>("Plans the draping of woven prepreg plies by a grid of grippers.",
                                            "drapeplan");
  program->require_subcommand(1);
  program->set_version_flag("--version", version_text(), "version, instruction set and compiler");
  for (const auto add :
       {add_plan, add_simulate, add_map, add_reach, add_report, add_new, add_check, add_schema, add_explain,
        add_characterise, add_study, add_bench, add_stress, add_validate})
    add(*program, action);
  for (CLI::App* verb : program->get_subcommands([](const CLI::App*) { return true; }))
    verb->footer(examples_of(verb->get_name()));
  program->footer(examples_of("") + "\nExit codes: 0 done; 2 the input is wrong; 3 not finished; 4 a bug.");
  add_documents(*program, action);
  return program;
}

}  // namespace drapeplan
