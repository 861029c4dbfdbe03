// Triangles from files of CAD programs: STL (text and binary) and OBJ.
#pragma once

#include <filesystem>
#include <vector>

#include "mapping/surface/triangles.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

struct TriangleReading {
  Triangles triangles;             ///< in the file's own unit; only meaningful without errors
  std::vector<InputError> errors;  ///< with the file
};

/// Reads all triangles of a file, whose ending says what it is; faces of more corners, which must be convex,
/// are split. Coordinates have single precision. Never throws for bad input.
TriangleReading read_triangles(const std::filesystem::path& file);

}  // namespace drapeplan
