// One run as `simulate` plays it: what is seen of it, and all that people look at. Played again, it gives the
// same files.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planner/diagnosis/diagnosis.hpp"
#include "planner/drape/problem.hpp"
#include "planner/views/history.hpp"

namespace drapeplan {

/// How a run was asked for, beside its case.
struct Played {
  std::string schedule;  ///< uniform, wave or a file; empty without grippers
  std::string fidelity;
  int frames = 0;     ///< instants kept for views and ParaView; 0: no files
  bool part = false;  ///< it began at a saved state, or was to pause
};
nlohmann::json played_json(const Played& played);
/// @throws std::exception if the value is none.
Played played_from(const nlohmann::json& value);

/// A run, and what was seen of it. The schedule and the model that it was played on must outlive it.
struct SeenDrape {
  Drape drape;
  Recorder recorder;
};
/// The same without grippers.
struct SeenRun {
  RunResult run;
  std::vector<Snapshot> frames;
  Recorder recorder;
};

/// @param part  where it begins and ends; its samples are set here.
SeenDrape play_drape(const DrapeProblem& problem, const Schedule& schedule, const Played& played,
                     RunPart part = {});
SeenRun play_run(const Case& definition, const Model& model, const Played& played, const RunPart& part = {});

/// Pictures, histories, profiles, VTU and PVD, and report.html as the last one.
/// @param verdict  whether the drape is good enough; empty of a run that has not ended.
/// @param notes  more of them for the page.
/// @throws NotFinished if a file cannot be written.
void write_drape_page(const std::filesystem::path& folder, const DrapeProblem& problem, const SeenDrape& seen,
                      const Schedule& schedule, const Played& played, const std::string& verdict,
                      const Diagnosis& diagnosis, const std::vector<std::string>& notes = {});
void write_run_page(const std::filesystem::path& folder, const Case& definition, const Model& model,
                    const SeenRun& seen, const std::vector<std::string>& notes = {});

}  // namespace drapeplan
