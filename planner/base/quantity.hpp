// Quantities as people write them ("0.3 mm", "314 g/m^2") to SI numbers and back, without losing a bit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drapeplan {

enum class Dimension {
  none,  ///< a bare number
  length,
  angle,    ///< inside [rad]
  degrees,  ///< an angle that is kept in degrees inside, where the name of the variable says so
  time,
  mass,
  force,
  stress,
  areal_density,
  line_stiffness,  ///< force per length
  velocity,
  acceleration,
  rate,
  strain,  ///< per cent or "1"
};

/// SI value = number * multiply / divide. Both are exact, so that the result is the nearest double to the
/// decimal.
struct Unit {
  std::string name;
  double multiply = 1;
  double divide = 1;
};

/// What a dimension is called and which units it may have; the first unit is that of the inside value.
struct DimensionWords {
  std::string name;      ///< "a length"
  std::string example;   ///< "0.3 mm"
  size_t preferred = 0;  ///< unit for display
  std::vector<Unit> units;
};

const DimensionWords& words_of(Dimension dimension);

/// The unit called `name`, or nullptr.
const Unit* find_unit(Dimension dimension, std::string_view name);

/// Finite value [SI] of a quantity such as "0.3 mm"; otherwise empty, and `fault` says why and what was
/// expected.
std::optional<double> parse_quantity(std::string_view text, Dimension dimension, std::string& fault);

/// Shortest text in the preferred unit, or else the SI unit, that parse_quantity turns into exactly `value`.
std::string format_quantity(double value, Dimension dimension);

/// Shortest text of a number that reads back as exactly the same number.
std::string format_number(double value);

/// Why `name` is no unit of this dimension, with the nearest right one.
std::string unit_fault(std::string_view name, Dimension dimension);

}  // namespace drapeplan
