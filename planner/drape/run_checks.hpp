// What is suspicious about a run: each check has a name, a value and a limit; none says that a drape is good.
#pragma once

#include <string>
#include <vector>

#include "planner/drape/problem.hpp"

namespace drapeplan {

/// What a drape asked of the material beyond what its curves are known to hold for (`valid_to`): one text for
/// each such curve; none of a score that is not valid.
std::vector<std::string> range_warnings(const MaterialNotes& material, const Score& score);

/// One check of a run that came out badly.
struct RunWarning {
  const char* check;  ///< its name: "kinetic", "damping", "hourglass", "waves", "penetration", "saturated",
                      ///< "overhang"
  double value = 0, limit = 0;
  std::string text;  ///< value, limit, and what to do
};

/// Below it the largest gap was at most 7 % off, above it up to 400 % (tests/bench/study.md, "Thrown or
/// laid").
inline constexpr double kKineticLimit = 0.3;
inline constexpr double kDampingLimit = 0.5;     ///< of the work of gravity and actuators
inline constexpr double kHourglassLimit = 0.05;  ///< of the internal energy; usual in explicit codes
inline constexpr double kWavesLimit = 20;  ///< stress waves cross the ply so often during a run, at least
inline constexpr double kPenetrationLimit = 0.1;  ///< of the ply's thickness

/// The checks that a run did not pass. @param drape  of this problem at this fidelity.
std::vector<RunWarning> run_warnings(const DrapeProblem& problem, const Drape& drape,
                                     const std::string& fidelity);

/// All that a drape is to be warned of: the texts of both.
std::vector<std::string> drape_warnings(const DrapeProblem& problem, const Drape& drape,
                                        const std::string& fidelity);

/// The share of the work of gravity and actuators below which the ratio of kinetic to internal energy says
/// nothing: a ply that sinks onto a plane or a gently curved mold is hardly deformed, and its internal energy
/// is next to none.
inline constexpr double kFabricShare = 0.1;
bool fabric_takes_part(const RunSummary& run);

/// Why a drape with this ratio of kinetic to internal energy has no score.
std::string thrown_text(double ratio, double limit);

}  // namespace drapeplan
