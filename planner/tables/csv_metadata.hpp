// What the columns of a CSV file mean, for programs: a document beside it, so that the file itself begins
// with the names of its columns (CSV on the Web, W3C: "Metadata Vocabulary for Tabular Data").
#pragma once

#include <string>
#include <vector>

namespace drapeplan {

struct CsvColumn {
  std::string name;
  std::string datatype;  ///< of CSV on the Web: "integer", "decimal" (no exponent), "double"
  std::string doc;       ///< a sentence, with the unit
};

struct CsvTable {
  std::string file;                      ///< of the table, beside the document
  std::string case_name, case_hash;      ///< of the case that it belongs to
  std::vector<std::string> description;  ///< what a reader has to know, a sentence each
  std::vector<CsvColumn> columns;        ///< in their order
  std::vector<std::string> key;          ///< names of the columns that tell rows apart
};

/// The name that programs look for: "schedule.csv-metadata.json".
std::string metadata_name(const std::string& file);

/// The document.
std::string metadata_text(const CsvTable& table);

/// The names of the columns, as the first line of the table.
std::string head_line(const CsvTable& table);

}  // namespace drapeplan
