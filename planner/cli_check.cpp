// check, schema, explain: everything about case files that needs no computation.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "planner/cli.hpp"

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
    if (reading.errors.empty()) text += file + ": good\n";
    all.insert(all.end(), reading.errors.begin(), reading.errors.end());
    single = std::move(reading.value);
  }
  CommonOptions delivery = options.common;
  if (!all.empty()) delivery.out.clear();  // wrong input: nothing is written
  const bool resolvable = all.empty() && options.files.size() == 1;
  const int code = deliver({{"cases", std::move(cases)}}, text, delivery, resolvable ? &single : nullptr);
  print_errors(all);
  return all.empty() ? code : kInputWrong;
}

int explain(const std::string& path, const CommonOptions& options) {
  std::string nearest;
  const std::string text = explain_field(path, nearest);
  if (!text.empty()) return deliver({{"path", path}, {"text", text}}, text, options);
  std::cerr << "explain: there is no field \"" << path << '"';
  if (!nearest.empty()) std::cerr << "; did you mean \"" << nearest << "\"?";
  std::cerr << '\n';
  return kInputWrong;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
  CLI::App* verb =
      program.add_subcommand("check", "reads case files and lists everything that is wrong with them");
  const auto options = std::make_shared<CheckOptions>();  // lives as long as CLI11 keeps the callback
  verb->add_option("CASE", options->files, "case files")->required();
  add_common_options(*verb, options->common);
  verb->callback([&action, options] { action = [options] { return check(*options); }; });
}

void add_schema(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand("schema", "prints the JSON schema of case files");
  const auto options = std::make_shared<CommonOptions>();
  add_common_options(*verb, *options);
  verb->callback([&action, options] {
    action = [options] {
      const json schema = case_schema();
      return deliver(schema, schema.dump(2) + '\n', *options);
    };
  });
}

void add_explain(CLI::App& program, Action& action) {
  CLI::App* verb = program.add_subcommand("explain", "prints meaning, unit, range and default of a field");
  const auto path = std::make_shared<std::string>();
  const auto options = std::make_shared<CommonOptions>();
  verb->add_option("PATH", *path, "dots between keys, e.g. grippers.joint_offset")->required();
  add_common_options(*verb, *options);
  verb->callback([&action, path, options] { action = [path, options] { return explain(*path, *options); }; });
}

}  // namespace drapeplan
