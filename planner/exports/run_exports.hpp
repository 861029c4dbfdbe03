// All that other programs read of one run.
#pragma once

#include <filesystem>
#include <string>

#include "fem/run/simulate.hpp"
#include "planner/case/case.hpp"
#include "planner/exports/run_frames.hpp"

namespace drapeplan {

/// Writes the run over time and what stands still meanwhile (run_frames.hpp), and the fibres of its end
/// (fibres.hpp), unless it diverged.
/// @param name  of the run's collections, e.g. "ply".
/// @return the files to open.
NamedFiles write_exports(const std::filesystem::path& folder, const std::string& name, const Case& definition,
                         const RunFrames& run, const RunResult& result);

}  // namespace drapeplan
