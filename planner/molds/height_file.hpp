// Heights over a rectangular grid from text files.
#pragma once

#include <filesystem>
#include <vector>

#include "planner/molds/triangle_file.hpp"

namespace drapeplan {

/// Reads heights and makes two triangles of every rectangle of the grid whose four corners have one. What the
/// file is follows from its beginning:
///   "ncols 90" ...                      an ESRI ASCII grid, rows from the largest y down;
///   three columns x, y, z               points in any order; each at a crossing of a grid, which may be
///   uneven; x1, x2, ... / y1, z11, z12 ... / ...  a matrix: a row of x first (with or without a word in
///   front), y in front of
///                                       each row.
/// Columns are separated by semicolons, tabs, commas or blanks; where no commas separate, they may be decimal
/// signs. Empty cells, "nan" and the grid's NODATA_value have no height. Coordinates are in the file's own
/// unit. Errors have the file and the line. Never throws for bad input.
TriangleReading read_heights(const std::filesystem::path& file);

}  // namespace drapeplan
