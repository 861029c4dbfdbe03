// Files that VTK reads, and ParaView with it: grids with fields, and collections of them over time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace drapeplan {

/// Kinds of cells, by their numbers in VTK.
enum class VtkKind : std::uint8_t { vertex = 1, line = 3, polyline = 4, triangle = 5, polygon = 7, quad = 9 };

struct VtkCell {
  VtkKind kind = VtkKind::vertex;
  std::vector<std::int64_t> points;  ///< indices of its corners
};

/// Files of a run that a page lists: each with what it holds.
using NamedFiles = std::vector<std::pair<std::string, std::string>>;

/// One value, or one vector, for each point or for each cell. Names end with their unit, as the columns of
/// our tables do: SI units and degrees, "gap_m", "shear_deg"; a bare number has no ending.
struct VtkField {
  std::string name;
  std::vector<double> values;  ///< `width` of them for each point or cell; those that are not known are NaN
  int width = 1;
};

VtkField vtk_vectors(std::string name, const std::vector<Eigen::Vector3d>& vectors);

struct VtkGrid {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<VtkCell> cells;
  std::vector<VtkField> point_fields, cell_fields;
};

/// Writes an unstructured grid (XML, double precision, base64).
/// @throws std::invalid_argument if a field has not one value for each point or cell, or if a cell has a
/// corner that is no point; NotFinished if the file cannot be written.
void write_vtu(const std::filesystem::path& file, const VtkGrid& grid);

/// One file of a collection; `file` is relative to the collection.
struct PvdEntry {
  double time = 0;  ///< [s]
  std::string file;
};

/// Writes a collection over time; times keep all their digits.
void write_pvd(const std::filesystem::path& file, const std::vector<PvdEntry>& entries);

/// Writes one grid per instant as NAME_000.vtu and so on, and the collection NAME.pvd. A reader asks the
/// first file of a collection which fields there are, so all must have the same.
/// @param times    of the grids [s].
/// @param grid_of  makes the grid of the instant of that index; one is kept at a time.
/// @throws as write_vtu; std::invalid_argument also if a grid has other fields than the first.
void write_over_time(const std::filesystem::path& folder, const std::string& name,
                     const std::vector<double>& times, const std::function<VtkGrid(size_t)>& grid_of);

/// Writes what does not move as NAME.vtu, and NAME.pvd with it alone: all that is to be opened in ParaView
/// are the collections of a folder.
void write_still(const std::filesystem::path& folder, const std::string& name, const VtkGrid& grid);

}  // namespace drapeplan
