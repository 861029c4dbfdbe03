// A state on disk: a run that pauses can go on in another process with the same bits.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fem/model/model.hpp"

namespace drapeplan {

/// A state read from a file, or why it was refused.
struct StateReading {
  std::optional<State> value;
  std::string error;  ///< names the file
};

/// Writes a state. The file is complete or not there: it is written beside and renamed.
/// @throws std::runtime_error if the file cannot be written.
void save_state(const std::filesystem::path& path, const Model& model, const State& state);

/// Reads a state that save_state wrote for a model with the same fingerprint. Refuses files that are cut,
/// changed (checksum), of another format or of another model.
StateReading load_state(const std::filesystem::path& path, const Model& model);

}  // namespace drapeplan
