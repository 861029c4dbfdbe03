// Where the plans of several cases go: a folder each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/input/error.hpp"

namespace drapeplan {

/// A run folder per case file: `out` itself for a single case that names one, else a folder below it, by the
/// name of the file without its ending.
/// @param out  of --out; empty: "out".
std::vector<std::filesystem::path> run_folders(const std::vector<std::string>& files, const std::string& out);

/// Two cases in one folder would overwrite each other: an error for each file whose folder an earlier one
/// has.
std::vector<InputError> shared_folders(const std::vector<std::string>& files,
                                       const std::vector<std::filesystem::path>& folders);

}  // namespace drapeplan
