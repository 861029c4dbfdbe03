// What no single cell of a table shows: data of a test that cannot be right as a whole.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "planner/input/error.hpp"
#include "planner/tables/test_table.hpp"

namespace drapeplan {

inline constexpr double kLongestTest = 1e7;  // [s], four months: beyond it a unit was mistaken

/// A strip that is not as long as stated by more than this share [-]: the wrong scale, column or clamp.
inline constexpr double kLengthTolerance = 0.1;
/// A tip that drops by less than this share of the length [-] is within the errors of its clamp.
inline constexpr double kLeastDrop = 0.01;

/// What a test machine can have recorded of a specimen.
struct MachineLimits {
  double rate = 0;                                           ///< of the crosshead [m/s]; 0: not known
  double way = std::numeric_limits<double>::infinity();      ///< that the specimen allows [m]
  double least_force = 0, most_force = 1e7;  ///< range of the largest force [N]; no test machine pulls harder
  bool rises = false;  ///< the curve is what lies before its largest force
};

/// Times and displacements increase (but for noise), at the stated rate and no further than the specimen allows; the
/// force is of a possible size and has neither spikes nor falls after which it rises again.
std::vector<InputError> machine_faults(const TestTable& table, const std::string& file, const MachineLimits& limits);

/// A strip's tip hangs no lower than the strip is long, not above its clamp, and comes down ever more slowly.
/// @param length  of the strip [m].
std::vector<InputError> drop_faults(const TestTable& table, const std::string& file, double length);

/// Places of a strip at rest, from its clamp on: distances increase, and the strip is as long as stated.
/// @param length  of the strip [m].
std::vector<InputError> profile_faults(const TestTable& table, const std::string& file, double length);

}  // namespace drapeplan
