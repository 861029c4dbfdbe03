// JSON documents in and out. What comes in is held to one set of rules and keeps the line of every value;
// what goes out is valid UTF-8, whatever bytes its texts have.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace drapeplan {

/// A fault of the text itself.
struct TextFault {
  int line = 0;         ///< from 1
  int column = 0;       ///< byte of the line, from 1; 0: the whole line
  std::string pointer;  ///< of the value; empty for syntax errors
  std::string message;
};

struct ParsedText {
  /// Null after a syntax error.
  nlohmann::json value;
  /// JSON pointer of every value -> line of its key or, in lists, of itself.
  std::map<std::string, int> lines;
  /// All that is wrong with values and keys, up to the first syntax error.
  std::vector<TextFault> faults;
};

/// Parses JSON (RFC 8259, no comments) in UTF-8 without a byte order mark. Faults too: a number that no
/// double can hold, a key that appears twice in an object, a NUL character, nesting deeper than 64 levels.
/// Never throws for bad input.
ParsedText parse_json_text(std::string_view text);

/// The value of a text that is held to the same rules, such as a line of a log.
/// @throws WrongInput with the first fault and, where the text has several lines, its line.
nlohmann::json checked_json(std::string_view text);

/// The text of a document: bytes that are not UTF-8 become U+FFFD. `indent` < 0: on one line.
std::string dump_json(const nlohmann::json& value, int indent = -1);

/// `key` as a JSON pointer token (RFC 6901), with the leading slash.
std::string pointer_token(std::string_view key);

}  // namespace drapeplan
