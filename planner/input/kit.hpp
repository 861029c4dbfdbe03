// What statements of fields share: ranges, words, lists of objects, optional sections.
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/input/field.hpp"

namespace drapeplan {

inline constexpr double kRightAngle = std::numbers::pi / 2;
inline constexpr double kLargestLength = 20;  // [m]; beyond it a unit was mistaken

inline Range positive(double highest = Range().highest) {
  return {0, highest, true};
}
inline Range from(double lowest, double highest = Range().highest) {
  return {lowest, highest};
}

template <class Enum>
Choice choice(Enum& target, std::vector<std::string> words) {
  return {std::move(words), [&target] { return int(target); },
          [&target](int index) { target = Enum(index); }};
}

template <class Item, class Visit>
ObjectList object_list(std::string name, std::string doc, std::vector<Item>& items, Visit visit) {
  ObjectList list{std::move(name), std::move(doc)};
  list.size = items.size();
  list.resize = [&items](size_t size) { items.resize(size); };
  list.visit = [&items, visit](size_t index) { visit(items[index]); };
  return list;
}

/// A section whose absence is the absence of its physics.
template <class Value, class Visit>
void optional_section(FieldVisitor& visitor, const Section& section, std::optional<Value>& slot, Value start,
                      Visit visit) {
  Value value = slot.value_or(std::move(start));
  const bool present = visitor.section(section, slot.has_value(), [&] { visit(value); });
  slot.reset();
  if (present) slot = std::move(value);
}

}  // namespace drapeplan
