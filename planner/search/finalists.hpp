// What is made of the candidates at the reporting fidelity: a winner, a sentence, a front.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "planner/schedule/strategy.hpp"
#include "planner/search/stages.hpp"

namespace drapeplan {

/// What decides between candidates. Those that ran to their end come first, of these those whose commands were
/// followed.
struct Standing {
  double objective = std::numeric_limits<double>::infinity();  ///< infinite: failed
  bool followed = true;
};
bool ranks_before(const Standing& a, const Standing& b);

/// A candidate before it has a fidelity: strokes and where they come from. One is kept per evaluation, so it
/// is small: the schedule is made from the strokes where it is needed.
struct Trial {
  std::string name;
  Strokes strokes;
  Standing standing = {};
  double lag = 0;  ///< [m]
  [[nodiscard]] double objective() const { return standing.objective; }
  [[nodiscard]] bool ran() const { return std::isfinite(standing.objective); }
};

/// The best few that differ from each other and from what is known. All but the first lag less, if there are
/// such: at the next fidelity joints may lag more, and then none would be followed.
/// @param lists  those to take from, one after the other; in each what failed is left out.
std::vector<Trial> pick_finalists(const SequenceFrame& frame,
                                  const std::vector<const std::vector<Trial>*>& lists,
                                  std::vector<Schedule> known, int count);

/// The baseline that is to be beaten: the one that ranks before the other.
const Candidate& better_baseline(const StagedResult& result);

/// Makes a finalist the best; the message says by how much it beats the baselines, or that it does not.
void declare_best(StagedResult& result, const Candidate& best);

/// Sorts the finalists, best first: failures last, before them what the rig did not follow. The first is the
/// best.
void conclude(StagedResult& result);

/// Of candidates that were evaluated to their end and followed their commands: those that no other one beats,
/// or equals, in largest gap, largest boundary offset and duration at once; by increasing gap.
std::vector<const Candidate*> unbeaten(const std::vector<Candidate>& candidates);

}  // namespace drapeplan
