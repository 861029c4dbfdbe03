#include "planner/input/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "planner/base/json_text.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

bool lies_in(const std::string& pointer, const std::string& prefix) {
  return pointer.starts_with(prefix) && (pointer.size() == prefix.size() || pointer[prefix.size()] == '/');
}

std::vector<std::string> split(const std::string& path, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// The value of an override: JSON if it is JSON, otherwise the text itself.
json override_value(const std::string& text) {
  ParsedText parsed = parse_json_text(text);
  return parsed.faults.empty() ? std::move(parsed.value) : json(text);
}

/// Sets the value at `parts` of `root`, or takes it away if it is null. Objects on the way are made.
/// @return what was wrong, or empty.
std::string set_at(json& root, const std::vector<std::string>& parts, json value) {
  json* here = &root;
  for (size_t k = 0; k < parts.size(); ++k) {
    const std::string& part = parts[k];
    const bool last = k + 1 == parts.size();
    if (*here == true) *here = json::object();  // a section that says no more than that it is there
    if (here->is_array()) {
      const bool digits =
          !part.empty() && part.size() < 9 && part.find_first_not_of("0123456789") == part.npos;
      const size_t index = digits ? std::stoul(part) : std::numeric_limits<size_t>::max();
      if (index >= here->size()) {
        return fmt::format("\"{}\" is no index of a list with {} entries", part, here->size());
      }
      here = &(*here)[index];
    } else if (here->is_object() || here->is_null()) {
      if (last && value.is_null()) {
        if (here->is_object()) here->erase(part);
        return {};
      }
      here = &(*here)[part];
    } else {
      return fmt::format("\"{}\" lies below a value that is no section", part);
    }
  }
  *here = std::move(value);
  return {};
}

}  // namespace

const std::vector<std::string>& keys_that_may_name_files() {
  static const std::vector<std::string> keys{"material", "mold"};
  return keys;
}

InputDocument::InputDocument(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                             const std::vector<std::string>& keys) {
  sources_.push_back({"", file.string(), {}, false});  // so that every pointer has a source
  if (!load(file, "", root_)) return;
  complete(file.parent_path(), overrides, keys);
}

InputDocument::InputDocument(json root, const std::vector<std::string>& overrides) : root_(std::move(root)) {
  sources_.push_back({"", "", {}, false});
  complete({}, overrides, {});
}

void InputDocument::complete(const std::filesystem::path& folder, const std::vector<std::string>& overrides,
                             const std::vector<std::string>& keys) {
  if (!root_.is_object()) {
    errors_.push_back(error_at("", "expected an object { ... }"));
    return;
  }
  // Which file is referred to must be known before something inside it can be overridden.
  const auto names_reference = [&keys](const std::string& text) {
    return std::find(keys.begin(), keys.end(), text.substr(0, text.find('='))) != keys.end();
  };
  for (const std::string& text : overrides) {
    if (names_reference(text)) apply(text);
  }
  for (const std::string& key : keys) place_file(folder, key);
  for (const std::string& text : overrides) {
    if (!names_reference(text)) apply(text);
  }
}

bool InputDocument::load(const std::filesystem::path& file, const std::string& prefix, json& into) {
  const FileText text = read_file(file, prefix.empty());
  if (!text.fault.empty()) {
    const std::string fault = "cannot be read: " + text.fault;
    if (prefix.empty()) {
      errors_.push_back({file.string(), 0, "", fault});
    } else {
      errors_.push_back(error_at(prefix, fmt::format("the file \"{}\" {}", file.string(), fault)));
    }
    return false;
  }
  ParsedText parsed = parse_json_text(text.text);
  for (const TextFault& at : parsed.faults) {
    const std::string column = at.column > 0 ? fmt::format("column {}: ", at.column) : "";
    errors_.push_back({file.string(), at.line, at.pointer, column + at.message});
  }
  sources_.push_back({prefix, file.string(), std::move(parsed.lines), false});
  into = std::move(parsed.value);
  if (into.is_null() && parsed.faults.empty()) {
    errors_.push_back({file.string(), 1, prefix, "null: expected an object { ... }"});
  }
  return !into.is_null();
}

void InputDocument::place_file(const std::filesystem::path& folder, const std::string& key) {
  const auto found = root_.find(key);
  if (found == root_.end() || !found->is_string()) return;
  const auto name = found->get<std::string>();
  json content;
  if (load((folder / name).lexically_normal(), '/' + key, content)) {
    *found = std::move(content);
  } else {
    unread_.insert('/' + key);
  }
}

void InputDocument::apply(const std::string& override_text) {
  const size_t equals = override_text.find('=');
  const auto fail = [&](const std::string& message) {
    errors_.push_back({"--set " + override_text, 0, "", message});
  };
  const std::vector<std::string> parts = split(override_text.substr(0, equals), '.');
  const bool empty_part =
      std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); });
  if (equals == std::string::npos || parts.empty() || empty_part || parts.size() > 16) {
    return fail("expected path=value, e.g. friction.coefficient=0.3");
  }
  if (utf8_prefix(override_text) < override_text.size()) return fail("is not valid UTF-8");
  const std::string fault = set_at(root_, parts, override_value(override_text.substr(equals + 1)));
  if (!fault.empty()) return fail(fault);
  std::string pointer;
  for (const std::string& part : parts) pointer += pointer_token(part);
  sources_.push_back({pointer, "--set " + override_text, {}, true});
}

const InputDocument::Source& InputDocument::source_of(const std::string& pointer) const {
  const Source* best = &sources_.front();
  for (const Source& source : sources_) {
    if (lies_in(pointer, source.prefix) && source.prefix.size() >= best->prefix.size()) best = &source;
  }
  return *best;
}

InputError InputDocument::error_at(const std::string& pointer, std::string message) const {
  const Source& source = source_of(pointer);
  if (source.override_text) return {source.file, 0, pointer, std::move(message)};
  const std::string inside = pointer.substr(source.prefix.size());
  if (!source.lines.contains(inside)) {  // not in the file: perhaps an override of something below made it
    for (const Source& other : sources_) {
      if (other.override_text && lies_in(other.prefix, pointer))
        return {other.file, 0, pointer, std::move(message)};
    }
  }
  for (std::string place = inside;; place.erase(place.rfind('/'))) {
    const auto line = source.lines.find(place);
    if (line != source.lines.end()) return {source.file, line->second, inside, std::move(message)};
    if (place.empty()) return {source.file, 0, inside, std::move(message)};
  }
}

std::filesystem::path InputDocument::file_at(const std::string& pointer, const std::string& name) const {
  const Source& source = source_of(pointer);
  const std::filesystem::path beside(source.override_text ? sources_.front().file : source.file);
  return (beside.parent_path() / name).lexically_normal();
}

void InputDocument::sort(std::vector<InputError>& errors) const {
  const auto rank = [this](const InputError& error) {
    for (size_t k = 0; k < sources_.size(); ++k) {
      if (sources_[k].file == error.file) return k;
    }
    return sources_.size();
  };
  std::stable_sort(errors.begin(), errors.end(), [&rank](const InputError& a, const InputError& b) {
    return std::pair(rank(a), a.line) < std::pair(rank(b), b.line);
  });
}

}  // namespace drapeplan
