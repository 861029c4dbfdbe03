// A mold from a file of triangles or heights: read, placed, checked and fitted by a smooth surface.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/surface/upper_surface.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

/// What a case says of the file.
struct MoldFile {
  bool heights = false;                ///< heights over a grid; otherwise triangles
  double unit = 1e-3;                  ///< what 1 in the file stands for [m]
  Eigen::Vector3d rotate{0, 0, 0};     ///< about x, then y, then z of the world [rad]
  Eigen::Vector3d translate{0, 0, 0};  ///< afterwards [m]
  std::optional<Extent> extent = {};   ///< absent: all that the file covers
};

struct MoldReading {
  UpperSurface surface;            ///< only meaningful without errors
  std::string text;                ///< what the file held, and how far the smooth surface is from it
  std::vector<InputError> errors;  ///< with the file, and with the line or the place
};

/// Never throws for bad input.
/// @param name  the file as the user calls it, for the text.
MoldReading read_mold_file(const std::filesystem::path& file, const std::string& name,
                           const MoldFile& options);

}  // namespace drapeplan
