// JSON Schema (draft 2020-12) of the case file, and `explain`, which reads it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "planner/base/json_text.hpp"
#include "planner/base/spelling.hpp"
#include "planner/case/fields.hpp"
#include "planner/case/file.hpp"
#include "planner/input/document.hpp"
#include "planner/input/values.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

/// `text` with all characters that mean something in a regular expression escaped.
std::string literal(const std::string& text) {
  std::string pattern;
  for (const char c : text) {
    if (std::string_view("^$.*+?()[]{}|\\/").find(c) != std::string_view::npos) pattern += '\\';
    pattern += c;
  }
  return pattern;
}

json unit_names(Dimension dimension) {
  json names = json::array();
  for (const Unit& unit : words_of(dimension).units) names.push_back(unit.name);
  return names;
}

/// Type of one number or quantity.
json number_schema(const Field& field) {
  json schema;
  if (field.dimension == Dimension::none) {
    schema["type"] = "number";
    if (std::isfinite(field.range.lowest)) {
      schema[field.range.lowest_excluded ? "exclusiveMinimum" : "minimum"] = field.range.lowest;
    }
    if (std::isfinite(field.range.highest)) {
      schema[field.range.highest_excluded ? "exclusiveMaximum" : "maximum"] = field.range.highest;
    }
    return schema;
  }
  std::string pattern = R"(^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*)";
  char separator = '(';
  for (const Unit& unit : words_of(field.dimension).units) {
    pattern += separator;
    pattern += literal(unit.name);
    separator = '|';
  }
  pattern += R"()\s*$)";
  schema["type"] = "string";
  schema["pattern"] = pattern;
  return schema;
}

json fixed_list(json items, size_t size) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", size}, {"maxItems", size}};
}

json integer_schema(const Field& field) {
  json schema = number_schema(field);
  schema["type"] = "integer";
  if (field.range.odd) {
    json allowed = json::array();
    for (int value = int(field.range.lowest); value <= int(field.range.highest); value += 2)
      allowed.push_back(value);
    schema = {{"enum", std::move(allowed)}};
  }
  return schema;
}

json table_schema(const Table& table) {
  const json units = {
      {"type", "array"},
      {"prefixItems", {{{"enum", unit_names(table.abscissa)}}, {{"enum", unit_names(Dimension::stress)}}}},
      {"minItems", 2},
      {"maxItems", 2}};
  return {{"type", "array"},
          {"prefixItems", json::array({units})},
          {"items", fixed_list({{"type", "number"}}, 2)},
          {"minItems", 3}};
}

/// Type of a field's value, by the type of its target.
struct TypeSchema {
  const Field& field;
  json operator()(double*) const { return number_schema(field); }
  json operator()(std::optional<double>*) const { return number_schema(field); }
  json operator()(int*) const { return integer_schema(field); }
  json operator()(unsigned*) const { return {{"type", "integer"}, {"minimum", 0}, {"maximum", 4294967295U}}; }
  json operator()(bool*) const { return {{"type", "boolean"}}; }
  json operator()(std::string*) const { return {{"type", "string"}}; }
  json operator()(Eigen::Vector2d*) const { return fixed_list(number_schema(field), 2); }
  json operator()(Eigen::Vector3d*) const { return fixed_list(number_schema(field), 3); }
  json operator()(std::optional<std::array<int, 2>>*) const {
    return fixed_list({{"type", "integer"}, {"minimum", 1}}, 2);
  }
  json operator()(Extent*) const { return fixed_list(fixed_list(number_schema(field), 2), 2); }
  json operator()(const PointList& target) const {
    return {{"type", "array"}, {"items", fixed_list(number_schema(field), 2)}, {"minItems", target.fewest}};
  }
  json operator()(const Choice& target) const { return {{"enum", target.words}}; }
  json operator()(const ChoiceList& target) const {
    return {{"type", "array"}, {"items", {{"enum", target.words}}}, {"minItems", 1}, {"uniqueItems", true}};
  }
  json operator()(const Table& table) const { return table_schema(table); }
  json operator()(const WordOrRows& target) const {
    const json number = number_schema(field);
    const json rows = {{"type", "array"}, {"items", {{"type", "array"}, {"items", number}}}};
    return {{"anyOf", {{{"enum", target.word.words}}, number, fixed_list(rows, 2)}}};
  }
};

class SchemaWriter : public FieldVisitor {
 public:
  json root = json{{"type", "object"}, {"additionalProperties", false}, {"properties", json::object()}};

  void field(const Field& field) override {
    json schema = std::visit(TypeSchema{field}, field.target);
    schema["description"] = field.doc;
    if (field.dimension != Dimension::none) {
      schema["x-quantity"] = words_of(field.dimension).name;
      schema["x-units"] = unit_names(field.dimension);
      schema["examples"] = json::array({words_of(field.dimension).example});
    }
    const std::string range = range_text(field.range, field.dimension);
    if (!range.empty()) schema["x-allowed"] = range;
    if (!field.default_words.empty()) {
      schema["x-default"] = field.default_words;
    } else if (!field.required) {
      json value = write_value(field);
      if (!value.is_null()) schema["default"] = std::move(value);
    }
    add(field.name, std::move(schema), field.required, field.needs);
  }

  bool section(const Section& section, bool present, const std::function<void()>& visit) override {
    json schema = object(visit);
    schema["description"] = section.doc;
    if (!section.required) {
      schema["x-default"] = section.always ? "the defaults of its fields" : "absent: so is its physics";
    }
    if (section.flag) {
      schema["type"] = {"object", "boolean"};
      schema["x-default"] = present ? "true" : "false";
    }
    const auto& files = keys_that_may_name_files();
    if (frames_.empty() && std::find(files.begin(), files.end(), section.name) != files.end()) {
      schema["type"] = {"object", "string"};
    }
    add(section.name, std::move(schema), section.required, section.needs);
    return present;
  }

  void alternative(const std::string& selector, const std::string& word, bool selected,
                   const std::function<void()>& visit) override {
    json then = object(visit);  // before `here`: it moves the frames
    json& here = frames_.empty() ? root : frames_.back();
    for (auto& [name, schema] : then["properties"].items()) {
      json& merged = here["properties"][name];
      json words = merged.is_object() ? merged["x-only-with"] : json::array();
      merged = schema;
      words.push_back(fmt::format("{} = {}", selector, word));
      merged["x-only-with"] = std::move(words);
    }
    // A selector that is not stated chooses the default alternative.
    json condition = {{"properties", {{selector, {{"const", word}}}}}};
    if (!selected || here["properties"][selector].value("default", "") != word)
      condition["required"] = json::array({selector});
    if (then.contains("required")) {
      here["allOf"].push_back({{"if", condition}, {"then", {{"required", then["required"]}}}});
    }
  }

  void list(const ObjectList& list) override {
    list.resize(1);
    json schema = {{"type", "array"}, {"items", object([&] { list.visit(0); })}, {"description", list.doc}};
    list.resize(0);
    if (list.required) schema["minItems"] = 1;
    add(list.name, std::move(schema), list.required, list.needs);
  }

  void named(const NamedObjects& objects) override {
    json entry = object([&] { objects.visit("any"); });
    add(objects.name,
        {{"type", "object"}, {"description", objects.doc}, {"additionalProperties", std::move(entry)}}, false,
        objects.needs);
  }

 private:
  json object(const std::function<void()>& visit) {
    frames_.push_back({{"type", "object"}, {"additionalProperties", false}, {"properties", json::object()}});
    visit();
    json schema = std::move(frames_.back());
    frames_.pop_back();
    return schema;
  }

  void add(const std::string& name, json schema, bool required, const std::vector<std::string>& needs) {
    json& here = frames_.empty() ? root : frames_.back();
    if (required) here["required"].push_back(name);
    if (!needs.empty()) here["dependentRequired"][name] = needs;
    here["properties"][name] = std::move(schema);
  }

  std::vector<json> frames_;
};

/// All paths of the schema with dots between keys; `*` stands for a name of the user's choice.
void collect_paths(const json& schema, const std::string& prefix, std::vector<std::string>& paths) {
  if (!schema.contains("properties")) return;
  for (const auto& [name, field] : schema["properties"].items()) {
    paths.push_back(prefix + name);
    collect_paths(field, prefix + name + '.', paths);
    if (field.contains("items")) collect_paths(field["items"], prefix + name + '.', paths);
    if (field.contains("additionalProperties") && field["additionalProperties"].is_object()) {
      collect_paths(field["additionalProperties"], prefix + name + ".*.", paths);
    }
  }
}

/// The schema of the field at `path`, or nullptr.
const json* find_field(const json& schema, const std::string& path) {
  const json* here = &schema;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    const bool index = !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
    if (here->contains("items") && (*here)["items"].contains("properties")) {
      here = &(*here)["items"];
      if (index) continue;
    }
    if (here->contains("properties") && (*here)["properties"].contains(part)) {
      here = &(*here)["properties"][part];
    } else if (here->contains("additionalProperties") && (*here)["additionalProperties"].is_object()) {
      here = &(*here)["additionalProperties"];
    } else {
      return nullptr;
    }
  }
  return here;
}

std::string words(const json& list) {
  std::string text;
  for (const json& word : list) {
    if (!text.empty()) text += ", ";
    text += word.is_string() ? word.get<std::string>() : dump_json(word);
  }
  return text;
}

std::string kind_text(const json& field) {
  if (field.contains("enum")) return "one of: " + words(field["enum"]);
  if (field.contains("anyOf"))
    return fmt::format("{}, {} (units: {}), or two lists of rows of them", words(field["anyOf"][0]["enum"]),
                       field["x-quantity"].get<std::string>(), words(field["x-units"]));
  if (field.contains("x-quantity")) {
    const bool list = field.value("type", json()) == "array";
    return fmt::format("{}{} (units: {})", list ? "list, each " : "", field["x-quantity"].get<std::string>(),
                       words(field["x-units"]));
  }
  const json type = field.value("type", json());
  return type.is_array() ? words(type) : type == "number" ? "bare number" : type.get<std::string>();
}

void explain_one(const std::string& path, const json& field, bool required, std::string& text) {
  text += path + '\n';
  if (field.contains("description")) text += fmt::format("  {}\n", field["description"].get<std::string>());
  text += fmt::format("  type:    {}\n", kind_text(field));
  if (field.contains("x-allowed"))
    text += fmt::format("  allowed: {}\n", field["x-allowed"].get<std::string>());
  if (field.contains("x-only-with")) text += fmt::format("  only if: {}\n", words(field["x-only-with"]));
  if (required) {
    text += "  required\n";
  } else if (field.contains("default")) {
    text += fmt::format("  default: {}\n", value_text(field["default"]));
  } else if (field.contains("x-default")) {
    text += fmt::format("  default: {}\n", field["x-default"].get<std::string>());
  }
}

bool is_required(const json& parent, const std::string& name) {
  if (!parent.contains("required")) return false;
  const json& required = parent["required"];
  return std::find(required.begin(), required.end(), name) != required.end();
}

void explain_tree(const std::string& path, const json& field, bool required, std::string& text) {
  explain_one(path, field, required, text);
  const json* inside = &field;
  if (field.contains("items")) inside = &field["items"];
  if (field.contains("additionalProperties") && field["additionalProperties"].is_object()) {
    inside = &field["additionalProperties"];
  }
  if (!inside->contains("properties")) return;
  if (inside->contains("additionalProperties") && inside != &field && !field.contains("items")) {
    text += "  names of your choice, each with\n";
  }
  for (const auto& [name, child] : (*inside)["properties"].items()) {
    explain_tree(path + (inside == &field || field.contains("items") ? "." : ".*.") + name, child,
                 is_required(*inside, name), text);
  }
}

}  // namespace

json case_schema() {
  CaseFields defaults;
  SchemaWriter writer;
  visit_case(writer, defaults);
  json schema = std::move(writer.root);
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["$id"] = kSchemaFile;
  schema["title"] = kCaseFormat;
  return schema;
}

std::string explain_field(const std::string& path, std::string& nearest) {
  const json schema = case_schema();
  nearest.clear();
  const json* field = path.empty() ? nullptr : find_field(schema, path);
  if (field != nullptr) {
    const size_t dot = path.rfind('.');
    const json* parent = dot == std::string::npos ? &schema : find_field(schema, path.substr(0, dot));
    const std::string name = dot == std::string::npos ? path : path.substr(dot + 1);
    std::string text;
    explain_tree(path, *field, parent != nullptr && is_required(*parent, name), text);
    return text;
  }
  std::vector<std::string> paths;
  collect_paths(schema, "", paths);
  nearest = nearest_word(path, paths);
  // A last word alone ("joint_ofset") is as good a question as a whole path.
  for (size_t k = 0; k < paths.size() && nearest.empty(); ++k) {
    const std::string last = paths[k].substr(paths[k].rfind('.') + 1);
    if (!nearest_word(path, {last}).empty()) nearest = paths[k];
  }
  return {};
}

}  // namespace drapeplan
