#include "planner/case/file.hpp"

#include <nlohmann/json.hpp>

#include "planner/case/checks.hpp"
#include "planner/input/document.hpp"
#include "planner/input/reader.hpp"
#include "planner/input/writer.hpp"

namespace drapeplan {

CaseReading read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const InputDocument document(file, overrides, keys_that_may_name_files());
  CaseReading reading;
  reading.errors = document.errors();
  if (!document.root().is_object()) return reading;
  CaseFields fields;
  fields.definition.name = file.stem().string();
  FieldReader reader(document);
  reader.read([&fields](FieldVisitor& visitor) { visit_case(visitor, fields); });
  complete_ply(fields);
  check_case(fields, reader);
  reading.errors.insert(reading.errors.end(), reader.errors().begin(), reader.errors().end());
  document.sort(reading.errors);
  if (reading.errors.empty()) complete_case(fields);
  reading.definition = std::move(fields.definition);
  return reading;
}

nlohmann::json resolved_case(const Case& definition) {
  CaseFields fields = fields_of(definition);
  FieldWriter writer;
  visit_case(writer, fields);
  return writer.result();
}

}  // namespace drapeplan
