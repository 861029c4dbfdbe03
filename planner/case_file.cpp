#include "planner/case_file.hpp"

#include <nlohmann/json.hpp>

#include "planner/case_checks.hpp"
#include "planner/case_document.hpp"
#include "planner/case_reader.hpp"
#include "planner/case_writer.hpp"

namespace drapeplan {

std::string InputError::text() const {
  std::string text = file;
  if (line > 0) text += ':' + std::to_string(line);
  if (!path.empty()) text += ": " + path;
  return text + ": " + message;
}

CaseReading read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const CaseDocument document(file, overrides);
  CaseReading reading;
  reading.errors = document.errors();
  if (!document.root().is_object()) return reading;
  CaseFields fields;
  fields.value.name = file.stem().string();
  CaseReader reader(document);
  reader.read(fields);
  complete_ply(fields);
  check_case(fields, reader);
  reading.errors.insert(reading.errors.end(), reader.errors().begin(), reader.errors().end());
  document.sort(reading.errors);
  if (reading.errors.empty()) complete_case(fields);
  reading.value = std::move(fields.value);
  return reading;
}

nlohmann::json resolved_case(const Case& value) {
  CaseFields fields = fields_of(value);
  CaseWriter writer;
  visit_case(writer, fields);
  return writer.result();
}

}  // namespace drapeplan
