// What became of several plans, case by case: for the console, for a spreadsheet, and as a page that leads to
// theirs.
#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace drapeplan {

/// One case of several. What is not known of it is NaN.
struct PlannedLine {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::string file;              ///< of the case
  std::filesystem::path folder;  ///< of its run; empty: there is none
  std::string status;            ///< "accepted", "not accepted", "interrupted", "not finished", "wrong input"
  std::string reason;            ///< of the last three
  double uniform = kUnknown, wave = kUnknown, optimised = kUnknown;  ///< objectives [-]
  double max_gap = kUnknown, max_boundary_offset = kUnknown;         ///< of the optimised drape [m]
  /// Gap below which no schedule of the rig comes while the edge lies within its tolerance, or within the
  /// least one that was looked at above it [m].
  double gap_floor = kUnknown;
  int evaluations = 0;
  double wall_seconds = 0;
};

/// @param result  the result of a plan, as in result.json.
PlannedLine planned_line(const std::string& file, const std::filesystem::path& folder,
                         const nlohmann::json& result);

/// A table with a heading line, millimetres and minutes, for people.
std::string summary_text(const std::vector<PlannedLine>& lines);

/// Writes summary.csv (SI units, as the heads say) and summary.html, which leads to the pages of the plans.
/// @param root  the folder above the run folders; it is made.  @throws NotFinished if they cannot be written.
void write_summary(const std::filesystem::path& root, const std::vector<PlannedLine>& lines);

}  // namespace drapeplan
