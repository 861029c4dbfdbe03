#include "planner/base/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "mapping/error.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr size_t kDeepest = 64;  // levels; a case needs 6, and recursion must not exhaust the stack

/// Line and column of the byte at `offset`.
TextFault fault_at(std::string_view text, size_t offset, std::string message) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const int line = 1 + int(std::count(before.begin(), before.end(), '\n'));
  const int column = int(before.size() - (before.rfind('\n') + 1)) + 1;  // npos + 1 = 0
  return {line, column, "", std::move(message)};
}

/// The first byte that no text in plain UTF-8 has.
std::optional<TextFault> encoding_fault(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) {
    return fault_at(text, 0, "starts with a byte order mark; expected UTF-8 without one");
  }
  const size_t bad = std::min(utf8_prefix(text), text.find('\0'));
  if (bad >= text.size()) return std::nullopt;
  const bool wide = bad < 2 && text.size() > 1;  // its byte order mark, or the zero beside its first letter
  return fault_at(
      text, bad,
      fmt::format("the byte 0x{:02X} is not text in UTF-8{}", static_cast<unsigned char>(text[bad]),
                  wide ? " (the file may be in UTF-16)" : ""));
}

/// Line of the last byte that the parser has taken. It takes one byte more than a number has; that byte may
/// be a line break, which still belongs to the line that it ends.
struct LineCount {
  int line = 1;
  char last = ' ';
  void take(char byte) {
    if (last == '\n') ++line;
    last = byte;
  }
};

/// Hands the bytes of a text to the parser and counts their lines.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, LineCount* count) : at_(at), count_(count) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    count_->take(*at_++);
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  LineCount* count_;
};

/// Builds the value while it is parsed, and notes lines and faults.
class Builder : public json::json_sax_t {
 public:
  Builder(std::string_view text, const LineCount& count, ParsedText& result)
      : text_(text), count_(count), result_(result) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& digits) override {
    const bool zero = digits.substr(0, digits.find_first_of("eE")).find_first_of("123456789") == digits.npos;
    if (value == 0 && !zero) fault(next_pointer(), fmt::format("number underflow parsing '{}'", digits));
    return add(value);
  }
  bool string(string_t& value) override {
    if (value.find('\0') != value.npos) fault(next_pointer(), "the text holds a NUL character (\\u0000)");
    return add(std::move(value));
  }
  bool binary(binary_t&) override { return false; }  // JSON has none
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    key_ = key;
    const std::string pointer = next_pointer();
    if (key.find('\0') != key.npos) fault(pointer, "the key holds a NUL character (\\u0000)");
    if (levels_.back().value->contains(key)) {
      fault(pointer, fmt::format("the key \"{}\" appears twice in this object; first on line {}", key,
                                 result_.lines[pointer]));
    }
    result_.lines.emplace(pointer, count_.line);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const json::exception& error) override {
    std::string reason = clean_text(error.what());
    // The library's prefix names its exception and repeats the position.
    for (const char* start : {"syntax error", "number overflow"}) {
      const size_t found = reason.find(start);
      if (found != reason.npos) reason.erase(0, found);
    }
    result_.faults.push_back(fault_at(text_, position > 0 ? position - 1 : 0, std::move(reason)));
    return false;
  }

 private:
  /// An object or a list that is not closed yet.
  struct Level {
    json* value;
    std::string pointer;
  };

  /// Pointer of the value that comes next.
  [[nodiscard]] std::string next_pointer() const {
    if (levels_.empty()) return "";
    const auto& [value, pointer] = levels_.back();
    return pointer + (value->is_array() ? fmt::format("/{}", value->size()) : pointer_token(key_));
  }

  json& place(json value) {
    result_.lines.emplace(next_pointer(), count_.line);  // a key has noted its line already
    if (levels_.empty()) return result_.value = std::move(value);
    json& parent = *levels_.back().value;
    if (parent.is_object()) return parent[key_] = std::move(value);
    parent.push_back(std::move(value));
    return parent.back();
  }

  bool add(json value) {
    place(std::move(value));
    return true;
  }

  bool open(json empty) {
    std::string pointer = next_pointer();
    if (levels_.size() == kDeepest) {
      fault(std::move(pointer), fmt::format("nested deeper than {} levels", kDeepest));
      return false;
    }
    json& value = place(std::move(empty));
    levels_.push_back({&value, std::move(pointer)});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  void fault(std::string pointer, std::string message) {
    result_.faults.push_back({count_.line, 0, std::move(pointer), std::move(message)});
  }

  std::string_view text_;
  const LineCount& count_;
  ParsedText& result_;
  std::vector<Level> levels_;
  std::string key_;  ///< of the value that comes next, in an object
};

}  // namespace

ParsedText parse_json_text(std::string_view text) {
  ParsedText result;
  if (std::optional<TextFault> fault = encoding_fault(text)) {
    result.faults.push_back(std::move(*fault));
    return result;
  }
  LineCount count;
  Builder builder(text, count, result);
  const CountingIterator begin(text.data(), &count), end(text.data() + text.size(), &count);
  if (!json::sax_parse(begin, end, &builder)) result.value = nullptr;
  return result;
}

json checked_json(std::string_view text) {
  ParsedText parsed = parse_json_text(text);
  if (parsed.faults.empty()) return std::move(parsed.value);
  const TextFault& fault = parsed.faults.front();
  std::string place = fault.line > 1 ? fmt::format("line {}: ", fault.line) : "";
  if (fault.column > 0) place += fmt::format("column {}: ", fault.column);
  if (!fault.pointer.empty()) place += fmt::format("{}: ", fault.pointer);
  throw WrongInput(place + fault.message);
}

std::string dump_json(const json& value, int indent) {
  return value.dump(indent, ' ', false, json::error_handler_t::replace);
}

std::string pointer_token(std::string_view key) {
  std::string token = "/";
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

}  // namespace drapeplan
