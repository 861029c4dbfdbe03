// Where things stand in a JSON text: nlohmann::json keeps no positions, so they are found here.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace drapeplan {

/// A fault of the text itself.
struct TextFault {
  int line = 0, column = 0;  ///< from 1; column 0: the whole line
  std::string pointer;       ///< empty for syntax errors
  std::string message;
};

struct ParsedText {
  nlohmann::json value;  ///< only meaningful without faults
  std::map<std::string, int>
      lines;                      ///< JSON pointer of every value -> line of its key or, in lists, of itself
  std::vector<TextFault> faults;  ///< a syntax error (then the only one), or all duplicate keys
};

/// Parses JSON (RFC 8259, no comments). A number that no double can hold, a key that appears twice in an
/// object, and nesting deeper than 64 levels are faults too. Never throws for bad input.
ParsedText parse_json_text(std::string_view text);

/// `key` as a JSON pointer token (RFC 6901), with the leading slash.
std::string pointer_token(std::string_view key);

}  // namespace drapeplan
