// What `simulate` writes for people beside the ParaView files: histories, profiles and views, as tables,
// charts and one page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fem/run/simulate.hpp"
#include "planner/drape/map_result.hpp"
#include "planner/page/page.hpp"
#include "planner/views/history.hpp"

namespace drapeplan {

/// probes.csv as text: `time [s]`, and `simulated time [s]` where the time is scaled; of each probe its
/// place, displacement and drop [mm], and with a mold its gap [mm]. @param history  with probes.
std::string probes_csv(const History& history);

/// grips.csv as text: times as in probes.csv; of each grip its displacement [mm] and its force on the ply
/// [N].
std::string grips_csv(const History& history);

/// What the page of a run shows of a drape beside what every run has.
struct DrapePage {
  std::string verdict;                                     ///< good enough or not
  std::optional<ReportReasons> reasons;                    ///< why not
  std::vector<ReportRow> rows;                             ///< scores and references
  std::vector<ReportFigure> figures;                       ///< shown first
  const std::vector<Snapshot>* frames = nullptr;  ///< of the run, for the view in space; null: without it
  const MapResult* mapping = nullptr;             ///< of the ply; null without one
  std::vector<std::pair<std::string, std::string>> files;  ///< that are there already: name, what it holds
  std::vector<std::string> notes;                          ///< more of them, shown first
  std::string fidelity;                                    ///< at which it was played; empty: not told
  std::vector<ReportTable> tables;                         ///< more of them, shown last
};

/// Writes probes.csv, grips.csv and profile_NAME.csv as far as the case asks for them, the picture of each
/// (.svg), shear.svg, and report.html with all of them.
/// @throws NotFinished if a file cannot be written.
void write_run(const std::filesystem::path& folder, const Case& definition, const Model& model,
               const Recorder& seen, const RunResult& run, DrapePage drape = {});

}  // namespace drapeplan
