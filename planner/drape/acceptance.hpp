// Whether a drape is good enough: the tolerances of its case, by how much they are missed and on how much of
// the ply, and whether any schedule of this rig could keep them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planner/drape/problem.hpp"

namespace drapeplan {

/// One tolerance of a case, beside what a drape has.
struct Tolerance {
  const char* key;     ///< in results; that of the score's part
  const char* what;    ///< "the largest gap"
  const char* beyond;  ///< "of the ply lies higher"
  double value = 0;    ///< [m]
  double allowed = 0;  ///< [m]
  double share = 0;    ///< of the ply's area, or of its edge, that is beyond what is allowed [-]
  [[nodiscard]] bool kept() const { return value <= allowed; }
};

/// The score at the end of the run: after pressing where the ply was pressed.
const Score& last_score(const Drape& drape);

/// What a drape is at its end, after pressing where it is pressed.
struct Acceptance {
  std::vector<Tolerance> tolerances;  ///< of gap and edge; none of a drape that failed
  bool pressed = false;
  std::string reason;  ///< of a drape that failed
  [[nodiscard]] bool accepted() const;
};

/// @param drape  of this problem at this fidelity, with its last state; it has ended, or failed.
Acceptance acceptance_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity);

/// The point of a front of floors which shows that no schedule keeps both tolerances [m]; null where some schedule may,
/// or where nobody knows.
const FloorPoint* out_of_reach(const FloorFront& front, double gap, double edge);

/// The verdict in words: accepted or not, what is missed and by how much.
std::string acceptance_text(const Acceptance& acceptance);

/// Whether another schedule could do better; empty if the drape is accepted, if some schedule may keep the
/// tolerances, or if the ply is pressed, which the floor knows nothing of. Asks for the floor, which takes
/// seconds.
std::string out_of_reach_text(const DrapeProblem& problem, const Acceptance& acceptance);

nlohmann::json acceptance_json(const Acceptance& acceptance);

}  // namespace drapeplan
