#include "planner/input/writer.hpp"

#include <algorithm>

#include "planner/input/values.hpp"

namespace drapeplan {

using nlohmann::json;

json FieldWriter::object(const std::function<void()>& visit) {
  stack_.push_back(json::object());
  visit();
  json written = std::move(stack_.back());
  stack_.pop_back();
  return written;
}

bool FieldWriter::useful(const std::vector<std::string>& needs) const {
  return std::all_of(needs.begin(), needs.end(),
                     [this](const auto& need) { return stack_.front().contains(need); });
}

void FieldWriter::field(const Field& field) {
  json value = write_value(field);
  if (!value.is_null() && useful(field.needs)) stack_.back()[field.name] = std::move(value);
}

bool FieldWriter::section(const Section& section, bool present, const std::function<void()>& visit) {
  if (present && useful(section.needs)) stack_.back()[section.name] = object(visit);
  if (!present && section.flag) stack_.back()[section.name] = false;
  return present;
}

void FieldWriter::alternative(const std::string&, const std::string&, bool selected,
                              const std::function<void()>& visit) {
  if (selected) visit();
}

void FieldWriter::list(const ObjectList& list) {
  if ((list.size == 0 && !list.required) || !useful(list.needs)) return;
  json items = json::array();
  for (size_t k = 0; k < list.size; ++k) items.push_back(object([&] { list.visit(k); }));
  stack_.back()[list.name] = std::move(items);
}

void FieldWriter::named(const NamedObjects& objects) {
  if (objects.names.empty() || !useful(objects.needs)) return;
  json written = json::object();
  for (const std::string& name : objects.names) written[name] = object([&] { objects.visit(name); });
  stack_.back()[objects.name] = std::move(written);
}

}  // namespace drapeplan
