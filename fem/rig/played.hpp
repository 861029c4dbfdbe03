// What a run has played of its schedule: a saved state goes on only under the same.
#pragma once

#include <string>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

/// The part of a schedule up to the time `until` [s], >= 0: its paths end there, with a knot; releases that
/// come later are left out.
Schedule played_until(const Schedule& schedule, double until);

/// Where a schedule differs from another one up to `until` [s], as the rest of a sentence about it; empty
/// where it does not. Only what is commanded counts, not how the knots say it; places less than a nanometre
/// apart are the same.
/// @param rig  names the grippers.
std::string difference_until(const RigOptions& rig, const Schedule& schedule, const Schedule& other,
                             double until);

}  // namespace drapeplan
