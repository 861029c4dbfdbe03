// What a characterisation found, as documents, text and a page.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/characterise/characterise.hpp"

namespace drapeplan {

/// Figures of all laws and verifications; SI, angles in degrees where the key says so.
nlohmann::json characterisation_json(const Characterisation& found);

/// A few lines for the console.
std::string characterisation_text(const Characterisation& found);

/// Writes material.json and the page characterisation.html.
/// @throws NotFinished if a file cannot be written.
void write_characterisation(const std::filesystem::path& folder, const Tests& tests,
                            const Characterisation& found);

}  // namespace drapeplan
