// check, schema, explain: everything about case files that needs no computation.
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "planner/cli/cli.hpp"

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

int check(const CheckOptions& options) {
  std::vector<InputError> all;
  json cases = json::array();
  std::string text;
  Case single;
  for (const std::string& file : options.files) {
    CaseReading reading = read_case(file, options.common.overrides);
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

void add_check(CLI::App& program, Action& action) {
  add_verb<CheckOptions>(
      program, action, "check", "reads case files and lists everything that is wrong with them",
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
