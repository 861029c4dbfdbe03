// Values that list their own fields: whoever must see all of them, like a fingerprint, cannot forget one.
//
// A struct lists its fields beside its definition, by a structured binding of all of them:
//
//   inline auto fields_of(const RestCriterion& of) {
//     const auto& [speed, hold] = of;
//     return std::tie(speed, hold);
//   }
//
// A field that is added and not listed is a binding of the wrong length, which does not compile.
#pragma once

#include <concepts>
#include <string>
#include <tuple>
#include <type_traits>

#include "fem/core/hash.hpp"

namespace drapeplan {

/// T, const or not.
template <class MaybeConst, class T>
concept EitherConst = std::same_as<std::remove_const_t<MaybeConst>, T>;

/// Adds a value with all its parts: numbers, enumerations, texts, optional values, lists with their lengths,
/// and structs that list their fields.
template <class T>
void add_fields(Fnv1a& hash, const T& value) {
  if constexpr (std::is_enum_v<T> || std::is_arithmetic_v<T>) {
    hash.add(double(value));
  } else if constexpr (std::is_same_v<T, std::string>) {
    hash.add(double(value.size()));
    hash.add(std::string_view(value));
  } else if constexpr (requires { fields_of(value); }) {
    std::apply([&hash](const auto&... field) { (add_fields(hash, field), ...); }, fields_of(value));
  } else if constexpr (requires { value.has_value(); }) {
    hash.add(value.has_value() ? 1.0 : 0.0);
    if (value) add_fields(hash, *value);
  } else {
    hash.add(double(value.size()));
    for (const auto& part : value) add_fields(hash, part);
  }
}

}  // namespace drapeplan
