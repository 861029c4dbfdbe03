// check, schema, explain: everything about case files that needs no simulation.
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "planner/drape/map_result.hpp"
#include "planner/search/plan.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> files;
};

json error_json(const InputError& error) {
  return {{"file", error.file}, {"line", error.line}, {"path", error.path}, {"message", error.message}};
}

/// What cannot be done with a case that has no fault in itself is an error of its file, what is odd a note.
void try_case(const std::string& file, CaseReading& reading) {
  try {
    for (const std::string& warning : try_case(reading.definition))
      reading.notes.push_back("warning: " + warning);
  } catch (...) {
    const Failure failure = failure_of(std::current_exception());
    if (failure.code == kBug) throw;
    reading.errors.push_back({file, 0, "", failure.reason});
  }
}

int check(const CheckOptions& options) {
  std::vector<InputError> all;
  json cases = json::array();
  std::string text;
  Case single;
  for (const std::string& file : options.files) {
    CaseReading reading = read_case(file, options.common.overrides);
    if (reading.errors.empty()) try_case(file, reading);
    json errors = json::array();
    for (const InputError& error : reading.errors) errors.push_back(error_json(error));
    cases.push_back({{"file", file}, {"valid", reading.errors.empty()}, {"errors", std::move(errors)}});
    cases.back()["notes"] = reading.notes;
    if (reading.errors.empty()) text += file + ": good\n";
    for (const std::string& note : reading.notes) text += fmt::format("  {}\n", note);
    all.insert(all.end(), reading.errors.begin(), reading.errors.end());
    single = std::move(reading.definition);
  }
  CommonOptions delivery = options.common;
  if (!all.empty()) delivery.out.clear();  // wrong input: nothing is written
  const bool resolvable = all.empty() && options.files.size() == 1;
  if (!all.empty()) std::cerr << errors_text(all) << '\n';
  OutputFolder out = take_folder(delivery, "check");
  begin_output(out, delivery);
  deliver({{"cases", std::move(cases)}}, text, delivery, resolvable ? &single : nullptr);
  return all.empty() ? kDone : kInputWrong;
}

struct SchemaOptions {
  CommonOptions common;
};

int schema(const SchemaOptions& options) {
  const json document = case_schema();
  OutputFolder out = take_folder(options.common, "schema");
  begin_output(out, options.common);
  deliver(document, document_text(document), options.common);
  return kDone;
}

struct ExplainOptions {
  CommonOptions common;
  std::string path;
};

int explain(const ExplainOptions& options) {
  std::string nearest;
  const std::string text = explain_field(options.path, nearest);
  if (text.empty()) {
    throw WrongInput(fmt::format("there is no field \"{}\"{}", options.path,
                                 nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
  }
  OutputFolder out = take_folder(options.common, "explain");
  begin_output(out, options.common);
  deliver({{"path", options.path}, {"text", text}}, text, options.common);
  return kDone;
}

}  // namespace

std::vector<std::string> try_case(const Case& definition) {
  const bool simulates = definition.material.thickness > 0;
  if (!definition.mapping || !definition.mold) {
    if (simulates) static_cast<void>(model_of(definition, definition.fidelities.at(kReport)));
    return {};
  }
  if (!definition.grippers || !simulates) return map_warnings(definition, map_case(definition));
  const DrapeProblem problem(definition);
  if (!definition.chooses_fidelities) build_models(problem);
  return map_warnings(problem.definition(), problem.mapping());
}

void add_check(CLI::App& program, Action& action) {
  add_verb<CheckOptions>(
      program, action, "check",
      "reads case files, maps their plies, and lists everything that is wrong and what a plan would refuse",
      [](CLI::App& verb, CheckOptions& options) {
        verb.add_option("CASE", options.files, "case files")->required();
      },
      check);
}

void add_schema(CLI::App& program, Action& action) {
  add_verb<SchemaOptions>(
      program, action, "schema", "prints the JSON schema of case files", [](CLI::App&, SchemaOptions&) {},
      schema);
}

void add_explain(CLI::App& program, Action& action) {
  add_verb<ExplainOptions>(
      program, action, "explain", "prints meaning, unit, range and default of a field",
      [](CLI::App& verb, ExplainOptions& options) {
        verb.add_option("PATH", options.path, "dots between keys, e.g. grippers.joint_offset")->required();
      },
      explain);
}

}  // namespace drapeplan
