#include "planner/case/file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "planner/case/checks.hpp"
#include "planner/case/section_fields.hpp"
#include "planner/input/document.hpp"
#include "planner/input/reader.hpp"
#include "planner/input/writer.hpp"

namespace drapeplan {

namespace {

CaseReading read_document(const InputDocument& document, const std::string& name) {
  CaseReading reading;
  reading.errors = document.errors();
  if (!document.root().is_object()) return reading;
  CaseFields fields;
  fields.definition.name = name;
  fields.states_numerics = document.root().contains("fem") || document.root().contains("fidelities");
  FieldReader reader(document);
  reader.read([&fields](FieldVisitor& visitor) { visit_case(visitor, fields); });
  if (fields.material) reading.notes = read_curve_files(*fields.material, "/material", reader);
  complete_ply(fields);
  if (fields.mold) {
    const std::vector<std::string> notes = read_mold_of_file(
        *fields.mold, std::max(fields.definition.ply.width, fields.definition.ply.height), reader);
    reading.notes.insert(reading.notes.end(), notes.begin(), notes.end());
  }
  check_case(fields, reader);
  reading.errors.insert(reading.errors.end(), reader.errors().begin(), reader.errors().end());
  document.sort(reading.errors);
  if (reading.errors.empty()) complete_case(fields);
  reading.definition = std::move(fields.definition);
  return reading;
}

}  // namespace

CaseReading read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return read_document(InputDocument(file, overrides, keys_that_may_name_files()), file.stem().string());
}

CaseReading read_case_document(const nlohmann::json& document, const std::string& name) {
  CaseReading reading = read_document(InputDocument(document), name);
  for (InputError& error : reading.errors) error.file = name;
  return reading;
}

CaseReading changed_case(const Case& definition, const std::vector<std::string>& overrides) {
  return read_document(InputDocument(resolved_case(definition), overrides), definition.name);
}

nlohmann::json resolved_case(const Case& definition) {
  CaseFields fields = fields_of(definition);
  FieldWriter writer;
  visit_case(writer, fields);
  return writer.result();
}

}  // namespace drapeplan
