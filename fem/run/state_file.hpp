// A state on disk: a run that pauses can go on in another process with the same bits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fem/model/model.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

/// A state read from a file, or why it was refused.
struct StateReading {
  std::optional<State> value;
  std::string error;  ///< names the file
};

/// Writes a state, and what it was made with. The file is complete or not there: it is written beside and
/// renamed.
/// @param schedule  that the rig has played; null without a rig.
/// @throws NotFinished if the file cannot be written.
void save_state(const std::filesystem::path& path, const Model& model, const State& state,
                const Schedule* schedule = nullptr);

/// Reads a state that save_state wrote for a model with the same fingerprint. Refuses files that are cut,
/// changed (checksum), of another format, of another model, or made under another schedule: one that differs
/// from `schedule` before the state's time. What comes later may differ.
StateReading load_state(const std::filesystem::path& path, const Model& model,
                        const Schedule* schedule = nullptr);

}  // namespace drapeplan
