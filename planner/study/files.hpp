// What a study found, as text, tables and pictures.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/study/study.hpp"

namespace drapeplan {

nlohmann::json study_json(const Study& study);

/// All tables as Markdown: reference, work and precision, cheapest settings, orders, ranks, noise, mapping,
/// reach.
std::string study_text(const Study& study);

/// Writes study.md, points.csv, ranks.csv and the pictures into the folder.
/// @throws NotFinished if a file cannot be written.
void write_study(const std::filesystem::path& folder, const Study& study);

}  // namespace drapeplan
