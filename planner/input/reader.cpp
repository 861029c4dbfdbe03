#include "planner/input/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "planner/base/json_text.hpp"
#include "planner/base/spelling.hpp"
#include "planner/input/values.hpp"

namespace drapeplan {

using nlohmann::json;

FieldReader::FieldReader(const InputDocument& document) : document_(document) {}

void FieldReader::read(const std::function<void(FieldVisitor&)>& visit_root) {
  visit_object(document_.root(), "", [&] { visit_root(*this); });
}

void FieldReader::fail(const std::string& pointer, const std::string& message) {
  const json::json_pointer place(pointer);
  const bool there = !pointer.empty() && document_.root().contains(place);
  const std::string shown = there ? value_text(document_.root().at(place)) + ": " : "";
  add_error(pointer, shown + message);
}

void FieldReader::add_error(const std::string& pointer, std::string message) {
  errors_.push_back(document_.error_at(pointer, std::move(message)));
  failed_.push_back(pointer);
}

void FieldReader::add_errors(const std::string& pointer, const std::vector<InputError>& errors) {
  errors_.insert(errors_.end(), errors.begin(), errors.end());
  failed_.push_back(pointer);
}

bool FieldReader::good(const std::string& pointer) const {
  if (!document_.root().contains(json::json_pointer(pointer))) return false;
  return std::none_of(failed_.begin(), failed_.end(),
                      [&pointer](const std::string& failed) { return failed.starts_with(pointer); });
}

void FieldReader::visit_object(const json& object, const std::string& pointer,
                               const std::function<void()>& visit) {
  if (document_.unread(pointer)) return failed_.push_back(pointer);
  if (!object.is_object()) return fail(pointer, "expected an object { ... }");
  Frame frame;
  frame.object = &object;
  frame.pointer = pointer;
  frames_.push_back(std::move(frame));
  visit();
  check_keys(frames_.back());
  frames_.pop_back();
}

void FieldReader::check_keys(const Frame& frame) {
  for (const auto& [key, value] : frame.object->items()) {
    if (std::find(frame.known.begin(), frame.known.end(), key) != frame.known.end()) continue;
    const std::string pointer = frame.pointer + pointer_token(key);
    const auto other = frame.elsewhere.find(key);
    if (other != frame.elsewhere.end()) {
      fail(pointer, fmt::format("belongs to {} only", other->second));
      continue;
    }
    const std::string nearest = nearest_word(key, frame.known);
    const std::string hint = nearest.empty() ? "known: " + alternatives_text(frame.known)
                                             : fmt::format("did you mean \"{}\"?", nearest);
    add_error(pointer, fmt::format("unknown key \"{}\"; {}", key, hint));
  }
}

void FieldReader::check_needs(const std::string& name, const std::vector<std::string>& needs) {
  for (const std::string& need : needs) {
    if (document_.root().contains(need)) continue;
    const std::string pointer = frames_.back().pointer + pointer_token(name);
    add_error(pointer, fmt::format("needs the section \"{}\", which is absent", need));
  }
}

const json* FieldReader::find(const std::string& name, bool required, const std::string& doc) {
  Frame& frame = frames_.back();
  if (skipping_) {
    if (unchosen_.empty()) {
      frame.known.push_back(name);
    } else {
      frame.elsewhere.emplace(name, unchosen_);
    }
    return nullptr;
  }
  frame.known.push_back(name);
  const auto found = frame.object->find(name);
  if (found != frame.object->end()) return &*found;
  if (required) {
    add_error(frame.pointer, fmt::format("\"{}\" is missing ({})", name, doc));
  }
  return nullptr;
}

void FieldReader::field(const Field& field) {
  const json* value = find(field.name, field.required, field.doc);
  const bool selector = std::holds_alternative<Choice>(field.target) && !skipping_;
  if (value == nullptr) {
    if (selector && field.required) frames_.back().failed_choices.insert(field.name);
    return;
  }
  check_needs(field.name, field.needs);
  const std::string pointer = frames_.back().pointer + pointer_token(field.name);
  const bool good = read_value(*value, field, [&](const std::string& where, const std::string& message) {
    fail(pointer + where, message);
  });
  if (selector && !good) frames_.back().failed_choices.insert(field.name);
}

bool FieldReader::section(const Section& section, bool present, const std::function<void()>& visit) {
  const json* value = find(section.name, section.required, section.doc);
  if (value == nullptr) return section.flag && present;
  check_needs(section.name, section.needs);
  const std::string pointer = frames_.back().pointer + pointer_token(section.name);
  if (section.flag && value->is_boolean()) return value->get<bool>();
  if (section.flag && !value->is_object()) {
    fail(pointer, "expected true or false, or an object { ... }");
    return present;
  }
  visit_object(*value, pointer, visit);
  return true;
}

void FieldReader::alternative(const std::string& selector, const std::string& word, bool selected,
                              const std::function<void()>& visit) {
  const bool undecided = frames_.back().failed_choices.contains(selector);
  if (selected && !undecided) return visit();
  skipping_ = true;
  unchosen_ = undecided ? "" : fmt::format("\"{}\": \"{}\"", selector, word);
  visit();
  skipping_ = false;
}

void FieldReader::list(const ObjectList& list) {
  const json* value = find(list.name, list.required, list.doc);
  if (value == nullptr) return;
  check_needs(list.name, list.needs);
  const std::string pointer = frames_.back().pointer + pointer_token(list.name);
  if (!value->is_array() || (list.required && value->empty()))
    return fail(pointer, "expected a list [ ... ]");
  list.resize(value->size());
  for (size_t k = 0; k < value->size(); ++k) {
    visit_object((*value)[k], fmt::format("{}/{}", pointer, k), [&] { list.visit(k); });
  }
}

void FieldReader::named(const NamedObjects& objects) {
  const json* value = find(objects.name, false, objects.doc);
  if (value == nullptr) return;
  check_needs(objects.name, objects.needs);
  const std::string pointer = frames_.back().pointer + pointer_token(objects.name);
  if (!value->is_object()) return fail(pointer, "expected an object { ... }");
  for (const auto& [name, object] : value->items()) {
    visit_object(object, pointer + pointer_token(name), [&] { objects.visit(name); });
  }
}

}  // namespace drapeplan
