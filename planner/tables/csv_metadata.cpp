#include "planner/tables/csv_metadata.hpp"

#include <nlohmann/json.hpp>

#include "planner/base/json_text.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {

std::string metadata_name(const std::string& file) {
  return file + "-metadata.json";
}

std::string metadata_text(const CsvTable& table) {
  nlohmann::json columns = nlohmann::json::array();
  for (const CsvColumn& column : table.columns)
    columns.push_back({{"name", column.name},
                       {"titles", column.name},
                       {"datatype", column.datatype},
                       {"dc:description", column.doc}});
  const nlohmann::json document{{"@context", "http://www.w3.org/ns/csvw"},
                                {"url", table.file},
                                {"dc:title", clean_text(table.case_name)},
                                {"dc:identifier", table.case_hash},
                                {"dc:creator", "drapeplan " DRAPEPLAN_VERSION},
                                {"dc:description", table.description},
                                {"tableSchema", {{"columns", columns}, {"primaryKey", table.key}}}};
  return dump_json(document, 2) + "\n";
}

std::string head_line(const CsvTable& table) {
  std::string line;
  for (const CsvColumn& column : table.columns) line += (line.empty() ? "" : ",") + column.name;
  return line + "\n";
}

}  // namespace drapeplan
