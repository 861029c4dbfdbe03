// A curve of stress over strain from a table: taken as it is, or smoothed where it has many rows or noise.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/law/fabric.hpp"
#include "planner/base/quantity.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

/// What the columns are called in the file; empty: one of the usual names is looked for.
struct CurveColumns {
  std::string strain, stress;
};

/// What became of a table.
struct CurveFit {
  size_t rows = 0;
  size_t knots = 0;     ///< of the smoothed curve; 0: the rows are the curve
  double residual = 0;  ///< r.m.s. of what the curve misses at the rows, of the largest stress [-]
};

struct CurveReading {
  Curve curve;  ///< only meaningful without errors
  CurveFit fit;
  std::vector<InputError> errors;  ///< with file and line
};

/// Reads a curve. A table of at most 100 rows with growing strains and stresses that do not fall is the curve; a
/// row at rest is put in front where there is none. Every other one is smoothed: the curve, straight between equally
/// spaced knots, that is nearest to the rows in the sense of least squares and does not fall. It has 8 knots, and
/// twice as many as long as that lowers the scatter of the rows about it by 3 % (64 at most).
/// Refused are tables that are no such curve: rows out of order, a stress that falls by more than noise, a stress at
/// no strain, negative strains. Never throws for bad input.
/// @param abscissa  Dimension::strain, or Dimension::angle for shear, whose column is an angle [rad].
CurveReading read_curve(const std::filesystem::path& file, Dimension abscissa, const CurveColumns& columns);

/// "curve.csv: 512 rows, smoothed to 16 knots; it misses them by 1.2 % of the largest stress (r.m.s.)".
std::string fit_text(const std::string& file, const CurveFit& fit);

}  // namespace drapeplan
