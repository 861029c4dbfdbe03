// Reading case files: every field's name, unit, range, default and meaning is stated once, in
// fields.cpp; the schema, the echo of defaults, `explain` and all error messages come from there.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planner/case/case.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

struct CaseReading {
  Case definition;                 ///< only meaningful without errors
  std::vector<InputError> errors;  ///< all of them, in the order of the file
  std::vector<std::string> notes;  ///< on curves and molds that were fitted to files, and what they miss
};

/// Reads and checks a case file with its `path=value` overrides (dots between keys; the value is JSON or a
/// bare word or quantity). Never throws for bad input.
CaseReading read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same of a document that no file holds; names of files in it are absolute. @param name  of the case,
/// and in its errors.
CaseReading read_case_document(const nlohmann::json& document, const std::string& name);

/// A case with overrides as above; read and checked anew.
CaseReading changed_case(const Case& definition, const std::vector<std::string>& overrides);

/// The complete case with all defaults as JSON, in the file's own format and units, self-contained (a
/// referenced material, mold or curve is written out). Reading it again gives the same case.
nlohmann::json resolved_case(const Case& definition);

/// JSON Schema (draft 2020-12) of the case file.
nlohmann::json case_schema();

/// Doc, unit, range and default of the field at `path` ("grippers.joint_offset"); of a section: of all its
/// fields. Empty if there is no such field; `nearest` then holds the most similar path.
std::string explain_field(const std::string& path, std::string& nearest);

}  // namespace drapeplan
