#include "planner/base/json_text.hpp"

#include <algorithm>
#include <set>

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr int kDeepest = 64;  // levels; a case needs 6, and recursion must not exhaust the stack

/// Line and column of the byte at `offset`.
TextFault fault_at(std::string_view text, size_t offset, std::string message) {
  offset = std::min(offset, text.size());
  const std::string_view before = text.substr(0, offset);
  const size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  TextFault fault;
  fault.line = 1 + int(std::count(before.begin(), before.end(), '\n'));
  fault.column = 1 + int(offset - line_start);
  fault.message = std::move(message);
  return fault;
}

/// Accepts any valid text; keeps the place and the reason of the first fault.
class SyntaxChecker : public json::json_sax_t {
 public:
  size_t offset = 0;
  std::string reason;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t position, const std::string&, const json::exception& error) override {
    offset = position > 0 ? position - 1 : 0;
    reason = error.what();
    // The library's prefix names its exception and repeats the position.
    for (const char* start : {"syntax error", "number overflow"}) {
      const size_t found = reason.find(start);
      if (found != std::string::npos) reason.erase(0, found);
    }
    return false;
  }

 private:
  bool enter() {
    if (++depth_ <= kDeepest) return true;
    reason = "nested deeper than " + std::to_string(kDeepest) + " levels";
    return false;
  }
  bool leave() {
    --depth_;
    return true;
  }
  int depth_ = 0;
};

/// Walks a text that is known to be valid and notes the line of every value.
class LineScanner {
 public:
  LineScanner(std::string_view text, ParsedText& result) : text_(text), result_(result) {}

  void run() {
    skip_byte_order_mark();
    skip_blanks();
    result_.lines[""] = line_;
    value("");
  }

 private:
  void value(const std::string& pointer) {
    switch (text_[at_]) {
      case '{':
        return object(pointer);
      case '[':
        return array(pointer);
      case '"':
        string();
        return;
      default:
        at_ = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
    }
  }

  void object(const std::string& pointer) {
    std::set<std::string> seen;
    ++at_;
    for (skip_blanks(); text_[at_] != '}'; skip_comma()) {
      const int line = line_;
      const std::string key = string();
      const std::string place = pointer + pointer_token(key);
      if (!seen.insert(key).second) {
        result_.faults.push_back({line, 0, place,
                                  "the key \"" + key + "\" appears twice in this object; first on line " +
                                      std::to_string(result_.lines[place])});
      }
      result_.lines.emplace(place, line);
      skip_blanks();
      ++at_;  // the colon
      skip_blanks();
      value(place);
      skip_blanks();
    }
    ++at_;
  }

  void array(const std::string& pointer) {
    int index = 0;
    ++at_;
    for (skip_blanks(); text_[at_] != ']'; skip_comma()) {
      const std::string place = pointer + '/' + std::to_string(index++);
      result_.lines.emplace(place, line_);
      value(place);
      skip_blanks();
    }
    ++at_;
  }

  /// The string that starts here, without its escapes.
  std::string string() {
    const size_t start = at_++;
    while (text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    ++at_;
    return json::parse(text_.substr(start, at_ - start)).get<std::string>();
  }

  void skip_comma() {
    if (text_[at_] == ',') ++at_;
    skip_blanks();
  }

  void skip_blanks() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) {
      if (text_[at_] == '\n') ++line_;
      ++at_;
    }
  }

  void skip_byte_order_mark() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }

  std::string_view text_;
  ParsedText& result_;
  size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

ParsedText parse_json_text(std::string_view text) {
  ParsedText result;
  SyntaxChecker checker;
  if (!json::sax_parse(text, &checker)) {
    result.faults.push_back(fault_at(text, checker.offset, checker.reason));
    if (checker.offset == 0 && checker.reason.starts_with("nested")) result.faults.back().column = 0;
    return result;
  }
  result.value = json::parse(text);
  LineScanner(text, result).run();
  return result;
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
