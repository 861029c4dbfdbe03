// The folder of a run that `plan` or `simulate` has left: whose it is, its case, its result, its schedules.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "fem/rig/schedule.hpp"
#include "mapping/error.hpp"
#include "planner/base/output_folder.hpp"
#include "planner/case/case.hpp"

namespace drapeplan {

/// While it lives, no other run can work in the folder.
struct RunFolder {
  OutputFolder out;
  std::string verb;       ///< "plan" or "simulate"
  nlohmann::json result;  ///< of result.json

  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return out.path() / name; }
};

/// @throws WrongInput  if it is no folder of such a run, another run works in it, or result.json cannot be
/// read.
/// @throws NotFinished  if the run has not ended, or nothing of it could be simulated.
RunFolder open_run(const std::filesystem::path& folder);

/// The case in a file of the folder. @throws WrongInput with all that is wrong with it.
Case case_in(const RunFolder& run, const std::string& name);

/// The schedule in a file of the folder. @throws WrongInput with all that is wrong with it.
Schedule schedule_in(const RunFolder& run, const std::string& name, const RigOptions& rig);

/// Takes values out of result.json. @throws WrongInput, with the file and the reason, for what `read` throws.
template <class Read>
auto from_result(const RunFolder& run, const Read& read) {
  try {
    return read(run.result);
  } catch (const std::exception& fault) {
    throw WrongInput(run.file("result.json").string() + ": is not what `" + run.verb +
                     "` of this version writes: " + fault.what());
  }
}

}  // namespace drapeplan
