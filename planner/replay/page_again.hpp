// The page of a run, made again from its files. Nothing is searched: the drapes are played again, and
// compared with what was recorded of them.
#pragma once

#include <string>
#include <vector>

#include "planner/replay/run_folder.hpp"

namespace drapeplan {

/// A drape as it was recorded and as it is now.
struct ReplayedDrape {
  std::string name;
  std::string recorded_hash, state_hash;
  double recorded_objective = 0, objective = 0;  ///< NaN: failed, or a run that has none
  bool same_score = true;                        ///< all parts, to the bit
  [[nodiscard]] bool same() const { return recorded_hash == state_hash && same_score; }
};

struct PageAgain {
  std::vector<ReplayedDrape> drapes;
  std::vector<std::string> warnings;  ///< one for each drape that is not the same
};

/// Writes pictures, histories, profiles, ParaView files and, as the last one, report.html; each replaces the
/// one before as a whole. Results, schedules, files for a robot and the log stay as they are. Same case, same
/// program and same processor: same files.
/// @throws WrongInput  if a file of the run is missing or wrong, or the run is one part of a longer one.
/// @throws NotFinished  if nothing of the run could be simulated, or a file cannot be written.
PageAgain make_page_again(const RunFolder& run, int threads = 0);

}  // namespace drapeplan
