// Single values of a case: from JSON into the targets of the field table and back.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "planner/input/field.hpp"

namespace drapeplan {

/// Called with the pointer of the wrong part relative to the value ("" or "/1/0") and what is wrong with it.
using ValueFault = std::function<void(const std::string& where, const std::string& message)>;

/// Reads `value` into the field's target. @return false if there were faults; the target is then unspecified.
bool read_value(const nlohmann::json& value, const Field& field, const ValueFault& fault);

/// The target as it would be written in a file; null if it is an absent optional value or an empty text.
nlohmann::json write_value(const Field& field);

/// Short text of a JSON value for messages.
std::string value_text(const nlohmann::json& value);

}  // namespace drapeplan
