#include "planner/base/quantity.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "planner/base/spelling.hpp"

namespace drapeplan {
namespace {

constexpr double kPi = std::numbers::pi;

const std::map<Dimension, DimensionWords>& all_dimensions() {
  static const std::map<Dimension, DimensionWords> table{
      {Dimension::none, {"a number", "0.5", 0, {{"", 1, 1}}}},
      {Dimension::length,
       {"a length", "0.3 mm", 1, {{"m", 1, 1}, {"mm", 1, 1e3}, {"cm", 1, 1e2}, {"um", 1, 1e6}}}},
      {Dimension::angle, {"an angle", "35 deg", 1, {{"rad", 1, 1}, {"deg", kPi, 180}}}},
      {Dimension::degrees, {"an angle", "35 deg", 0, {{"deg", 1, 1}, {"rad", 180, kPi}}}},
      {Dimension::time, {"a time", "0.8 s", 0, {{"s", 1, 1}, {"ms", 1, 1e3}, {"min", 60, 1}}}},
      {Dimension::mass, {"a mass", "100 g", 1, {{"kg", 1, 1}, {"g", 1, 1e3}}}},
      {Dimension::force, {"a force", "50 N", 0, {{"N", 1, 1}, {"mN", 1, 1e3}, {"kN", 1e3, 1}}}},
      {Dimension::stress,
       {"a stress",
        "0.2 GPa",
        2,
        {{"Pa", 1, 1},
         {"kPa", 1e3, 1},
         {"MPa", 1e6, 1},
         {"GPa", 1e9, 1},
         {"N/mm^2", 1e6, 1},
         {"N/m^2", 1, 1}}}},
      {Dimension::areal_density, {"a mass per area", "314 g/m^2", 1, {{"kg/m^2", 1, 1}, {"g/m^2", 1, 1e3}}}},
      {Dimension::line_stiffness,
       {"a force per length", "10 N/mm", 1, {{"N/m", 1, 1}, {"N/mm", 1e3, 1}, {"kN/m", 1e3, 1}}}},
      {Dimension::velocity,
       {"a velocity", "0.2 m/s", 0, {{"m/s", 1, 1}, {"mm/s", 1, 1e3}, {"mm/min", 1, 6e4}}}},
      {Dimension::acceleration, {"an acceleration", "9.81 m/s^2", 0, {{"m/s^2", 1, 1}, {"mm/s^2", 1, 1e3}}}},
      {Dimension::rate, {"a rate", "22 1/s", 0, {{"1/s", 1, 1}, {"1/min", 1, 60}}}},
      {Dimension::strain, {"a strain", "0.67 %", 1, {{"1", 1, 1}, {"%", 1, 1e2}}}},
  };
  return table;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string expected(Dimension dimension) {
  const DimensionWords& words = words_of(dimension);
  return fmt::format("expected {}, e.g. \"{}\"", words.name, words.example);
}

double to_inside(double number, const Unit& unit) {
  return number * unit.multiply / unit.divide;
}

/// Shortest number that `unit` turns into exactly `value`: first the rounded ones, which a person would have
/// written, then the exact quotient.
std::optional<std::string> number_in_unit(double value, const Unit& unit) {
  const double quotient = value / unit.multiply * unit.divide;
  std::array<char, 32> buffer{};
  for (int digits = 6; digits <= 17; ++digits) {
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), quotient,
                                   std::chars_format::general, digits);
    double rounded = 0;
    std::from_chars(buffer.data(), end.ptr, rounded);
    if (to_inside(rounded, unit) == value) return format_number(rounded);
  }
  return std::nullopt;
}

}  // namespace

const DimensionWords& words_of(Dimension dimension) {
  return all_dimensions().at(dimension);
}

const Unit* find_unit(Dimension dimension, std::string_view name) {
  for (const Unit& unit : words_of(dimension).units) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

std::string unit_fault(std::string_view name, Dimension dimension) {
  std::vector<std::string> names;
  for (const Unit& unit : words_of(dimension).units) names.push_back(unit.name);
  for (const auto& [other, words] : all_dimensions()) {
    if (other != Dimension::none && find_unit(other, name) != nullptr) {
      return fmt::format("\"{}\" is the unit of {}; {}", name, words.name, expected(dimension));
    }
  }
  const std::string nearest = nearest_word(name, names);
  const std::string hint = nearest.empty() ? "" : fmt::format("did you mean \"{}\"? ", nearest);
  return fmt::format("unknown unit \"{}\"; {}{} (units: {})", name, hint, expected(dimension),
                     alternatives_text(names));
}

std::optional<double> parse_quantity(std::string_view text, Dimension dimension, std::string& fault) {
  const std::string_view whole = trimmed(text);
  const bool plus = whole.size() > 1 && whole[0] == '+' && whole[1] != '-';
  const size_t sign = plus ? 1 : 0;  // from_chars takes no plus
  double number = 0;
  const auto [end, error] = std::from_chars(whole.data() + sign, whole.data() + whole.size(), number);
  if (error == std::errc::result_out_of_range) {
    fault = "the number is too large or too small; " + expected(dimension);
    return std::nullopt;
  }
  if (error != std::errc() || !std::isfinite(number)) {
    fault = "does not start with a finite number; " + expected(dimension);
    return std::nullopt;
  }
  const std::string_view name = trimmed(whole.substr(size_t(end - whole.data())));
  const Unit* unit = find_unit(dimension, name);
  if (unit == nullptr) {
    fault = name.empty() ? "the unit is missing; " + expected(dimension) : unit_fault(name, dimension);
    return std::nullopt;
  }
  const double value = to_inside(number, *unit);
  if (!std::isfinite(value)) {
    fault = "the number is too large; " + expected(dimension);
    return std::nullopt;
  }
  return value;
}

std::string format_number(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

std::string format_quantity(double value, Dimension dimension) {
  const DimensionWords& words = words_of(dimension);
  if (dimension == Dimension::none) return format_number(value);
  const Unit& preferred = words.units[words.preferred];
  if (const auto number = number_in_unit(value, preferred))
    return fmt::format("{} {}", *number, preferred.name);
  return fmt::format("{} {}", format_number(value), words.units.front().name);
}

}  // namespace drapeplan
