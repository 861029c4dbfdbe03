// Fields of the mold, and between them and a mold.
#pragma once

#include <string>
#include <vector>

#include "mapping/mold.hpp"
#include "planner/input/field.hpp"
#include "planner/input/reader.hpp"

namespace drapeplan {

/// The mold as the file states it.
struct MoldFields {
  int shape = 1;  ///< index of Mold::Shape, or beyond: a file that becomes a spline
  Extent extent;
  double angle = 0;
  double unit = 1;
  std::vector<PolynomialShape::Term> terms;
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 0;
  double azimuth = 0;
  std::string file;         ///< of triangles or heights
  double file_unit = 1e-3;  ///< what 1 in it stands for
  Eigen::Vector3d rotate{0, 0, 0}, translate{0, 0, 0};
  Eigen::Vector2d origin{0, 0}, spacing{0, 0};  ///< of a spline
  int columns = 0, rows = 0;
  std::string coefficients;  ///< as coefficient_text writes them
  std::string source;        ///< what the spline was fitted to
};

void visit_mold(FieldVisitor& visitor, MoldFields& mold);

/// Reads the triangles or heights that a mold names and makes it the spline that is fitted to them; checks
/// the coefficients of a spline that is stated. Errors are placed below "/mold".
/// @param ply  longer side of the ply [m]: a mold whose size has nothing to do with it has another unit.
/// @return a line on what was read and how well the spline meets it, if there was a file.
std::vector<std::string> read_mold_of_file(MoldFields& mold, double ply, FieldReader& reader);

/// Fields into a mold and back. @param fields  without errors, read by read_mold_of_file.
/// @param source  what a spline was fitted to.
Mold mold_of(const MoldFields& fields);
MoldFields mold_fields(const Mold& mold, const std::string& source);

}  // namespace drapeplan
