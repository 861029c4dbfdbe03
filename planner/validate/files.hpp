// What comparisons found, as a document, a table for the console, one for people who read files, and a page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planner/validate/validate.hpp"

namespace drapeplan {

/// `rows`, `failures` (of rows that differ) and `verdicts` (how many of each). What is not finite is null.
nlohmann::json validation_json(const std::vector<ComparisonResult>& results);

/// A line per row, in groups; a row that differs has its reason below it.
std::string validation_text(const std::vector<ComparisonResult>& results);
std::string validation_markdown(const std::vector<ComparisonResult>& results);

/// A page with the tables and the pictures.
std::string validation_page(const std::vector<ComparisonResult>& results);

}  // namespace drapeplan
