// Text of tables as lines of cells: what all readers of such files share.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/input/error.hpp"

namespace drapeplan {

struct TableLine {
  int number = 0;                  ///< in the file, from 1
  std::vector<std::string> cells;  ///< without blanks and quotes around them
};

/// Reads a table's file into `text`, without a byte order mark.
/// @return why it is no text with something in it: it cannot be read, is UTF-16, has a NUL byte, is empty.
std::optional<InputError> load_table_text(const std::filesystem::path& file, std::string& text);

/// Hands over all lines that are not blank, in their order. Lines end with \n or \r\n; a separator between
/// quotes does not separate.
/// @param most_cells  a line with more has this many and one more.
/// @param see         gets each line; false ends it.
void split_table(std::string_view text, char separator, size_t most_cells,
                 const std::function<bool(TableLine&&)>& see);

/// Without blanks, carriage returns and quotes around it.
std::string trimmed_cell(std::string_view cell);

/// The number that a cell is, with a decimal point; may be infinite or NaN. Empty if it is anything else.
std::optional<double> cell_number(std::string_view cell);

}  // namespace drapeplan
