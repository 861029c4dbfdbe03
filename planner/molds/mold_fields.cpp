#include "planner/molds/mold_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "planner/base/quantity.hpp"
#include "planner/input/kit.hpp"
#include "planner/molds/mold_file.hpp"
#include "planner/molds/spline_text.hpp"

namespace drapeplan {
namespace {

/// Places of the words of `shape`; the first five are those of Mold::Shape.
enum MoldWord { kPlane, kPolynomial, kSphere, kCylinder, kSpline, kTriangles, kHeightField };

/// Sizes of mold over ply beyond which a unit was mistaken.
constexpr double kSmallestShare = 0.05, kLargestShare = 200;
constexpr int kMostCoefficients = 5000;  // along one side

void visit_extent(FieldVisitor& v, MoldFields& m, bool from_file) {
  Field extent{
      "extent",          &m.extent, "Part of the x-y plane that the mold covers: [[x0, x1], [y0, y1]]",
      Dimension::length, {},        !from_file};
  if (from_file) extent.default_words = "all that the file covers";
  v.field(extent);
}

void visit_polynomial(FieldVisitor& v, MoldFields& m) {
  v.field({"unit", &m.unit, "Length L in z/L = sum of coefficient (x/L)^x (y/L)^y", Dimension::length,
           positive()});
  ObjectList terms = object_list("terms", "Terms of the height", m.terms, [&v](PolynomialShape::Term& term) {
    v.field({"x", &term.i, "Power of x", Dimension::none, from(0, 12), true});
    v.field({"y", &term.j, "Power of y", Dimension::none, from(0, 12), true});
    v.field({"coefficient", &term.coefficient, "Dimensionless, see `unit`", Dimension::none, {}, true});
  });
  terms.required = true;
  v.list(terms);
}

void visit_round(FieldVisitor& v, MoldFields& m) {
  v.field(
      {"centre", &m.centre, "Centre of the sphere, or a point of the cylinder's axis", Dimension::length});
  v.field({"radius", &m.radius, "Of the sphere or cylinder", Dimension::length, positive(1e3), true});
}

void visit_spline(FieldVisitor& v, MoldFields& m) {
  v.field({"source", &m.source, "What the spline was fitted to, and how far it is from it"});
  v.field({"origin", &m.origin, "Lower corner (x, y) of the first cell", Dimension::length, {}, true});
  v.field({"spacing", &m.spacing, "Sizes of a cell along x and y", Dimension::length, positive(), true});
  v.field({"columns", &m.columns, "Coefficients along x", Dimension::none, from(4, kMostCoefficients), true});
  v.field({"rows", &m.rows, "Coefficients along y", Dimension::none, from(4, kMostCoefficients), true});
  v.field({"coefficients",
           &m.coefficients,
           "Of bicubic B-splines: doubles in metres, little-endian, in base64, those along y fastest",
           Dimension::none,
           {},
           true});
}

void visit_file(FieldVisitor& v, MoldFields& m) {
  v.field({"file",
           &m.file,
           "Relative to the file that names it. `stl`: STL (text or binary) or OBJ, one surface or a "
           "solid, whose "
           "upper side counts. `height_field`: a text table of columns x, y, z over a grid, a matrix with a "
           "row of x and "
           "a column of y, or an ESRI ASCII grid",
           Dimension::none,
           {},
           true});
  v.field({"unit", &m.file_unit, "What 1 in the file stands for", Dimension::length, positive(1e3)});
  v.field({"rotate", &m.rotate, "Turns about x, then y, then z of the world, before it is moved",
           Dimension::angle});
  v.field({"translate", &m.translate, "Moves it along x, y, z", Dimension::length});
}

/// A mold whose size has nothing to do with the ply's: the unit of its file is another one.
void check_size(const MoldFields& mold, double ply, FieldReader& reader) {
  const double size = (mold.extent.upper - mold.extent.lower).maxCoeff(), share = size / ply;
  if (!(ply > 0) || (share >= kSmallestShare && share <= kLargestShare)) return;
  const auto text = [](double length) { return format_quantity(length, Dimension::length); };
  reader.add_error("/mold/file", fmt::format("the mold is {} long and the ply {}: is \"unit\", {}, wrong?",
                                             text(size), text(ply), text(mold.file_unit)));
}

Mold::Shape shape_of(const MoldFields& m) {
  switch (m.shape) {
    case kPlane:
      return PlaneShape{m.angle};
    case kSphere:
      return SphereShape{m.centre, m.radius};
    case kCylinder:
      return CylinderShape{m.centre, m.azimuth, m.radius};
    case kSpline:
      return SplineShape{m.origin, m.spacing, coefficients_of(m.coefficients, m.columns, m.rows).value()};
    default:
      break;
  }
  PolynomialShape shape{m.terms};
  for (PolynomialShape::Term& term : shape.terms) term.coefficient *= std::pow(m.unit, 1 - term.i - term.j);
  return shape;
}

}  // namespace

void visit_mold(FieldVisitor& v, MoldFields& m) {
  v.field({"shape",
           choice(m.shape, {"plane", "polynomial", "sphere", "cylinder", "spline", "stl", "height_field"}),
           "`plane` through the origin; `polynomial` height field; upper half of a `sphere` or a lying "
           "`cylinder`; "
           "`stl`: triangles of a file; `height_field`: heights of a file; `spline`: the smooth surface that "
           "either "
           "becomes, as resolved.json states it",
           Dimension::none,
           {},
           true});
  const auto alternative = [&](const char* word, int index, const auto& visit) {
    v.alternative("shape", word, m.shape == index, [&] {
      visit_extent(v, m, index >= kTriangles);
      visit();
    });
  };
  alternative("plane", kPlane, [&] {
    v.field({"angle",
             &m.angle,
             "The plane falls by it towards +x",
             Dimension::angle,
             {-kRightAngle, kRightAngle, true, true}});
  });
  alternative("polynomial", kPolynomial, [&] { visit_polynomial(v, m); });
  alternative("sphere", kSphere, [&] { visit_round(v, m); });
  alternative("cylinder", kCylinder, [&] {
    visit_round(v, m);
    v.field({"azimuth", &m.azimuth, "Direction of the axis, from +x towards +y", Dimension::angle});
  });
  alternative("spline", kSpline, [&] { visit_spline(v, m); });
  alternative("stl", kTriangles, [&] { visit_file(v, m); });
  alternative("height_field", kHeightField, [&] { visit_file(v, m); });
}

std::vector<std::string> read_mold_of_file(MoldFields& m, double ply, FieldReader& reader) {
  if (m.shape == kSpline && reader.good("/mold")) {
    const auto coefficients = coefficients_of(m.coefficients, m.columns, m.rows);
    if (!coefficients)
      reader.fail("/mold/coefficients",
                  fmt::format("is no base64 of {} x {} finite doubles", m.columns, m.rows));
    return {};
  }
  if (m.shape < kTriangles || !reader.good("/mold")) return {};
  MoldFile options{m.shape == kHeightField, m.file_unit, m.rotate, m.translate, {}};
  if ((m.extent.upper - m.extent.lower).norm() > 0) options.extent = m.extent;
  MoldReading reading = read_mold_file(reader.file_at("/mold/file", m.file), m.file, options);
  if (!reading.errors.empty()) {
    reader.add_errors("/mold/file", reading.errors);
    return {};
  }
  const SplineShape& spline = reading.surface.spline;
  m.shape = kSpline;
  m.extent = reading.surface.extent;
  m.origin = spline.origin;
  m.spacing = spline.spacing;
  m.columns = int(spline.coefficients.rows());
  m.rows = int(spline.coefficients.cols());
  m.coefficients = coefficient_text(spline.coefficients);
  m.source = reading.text;
  for (const std::string& warning : reading.surface.warnings) m.source += "; warning: " + warning;
  check_size(m, ply, reader);
  return {"/mold: " + m.source};
}

Mold mold_of(const MoldFields& fields) {
  return Mold(shape_of(fields), fields.extent);
}

MoldFields mold_fields(const Mold& mold, const std::string& source) {
  MoldFields m;
  m.shape = int(mold.shape().index());
  m.extent = mold.extent();
  if (const auto* plane = std::get_if<PlaneShape>(&mold.shape())) m.angle = plane->angle;
  if (const auto* polynomial = std::get_if<PolynomialShape>(&mold.shape())) m.terms = polynomial->terms;
  if (const auto* sphere = std::get_if<SphereShape>(&mold.shape())) {
    m.centre = sphere->centre;
    m.radius = sphere->radius;
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&mold.shape())) {
    m.centre = cylinder->centre;
    m.azimuth = cylinder->azimuth;
    m.radius = cylinder->radius;
  }
  if (const auto* spline = std::get_if<SplineShape>(&mold.shape())) {
    m.origin = spline->origin;
    m.spacing = spline->spacing;
    m.columns = int(spline->coefficients.rows());
    m.rows = int(spline->coefficients.cols());
    m.coefficients = coefficient_text(spline->coefficients);
    m.source = source;
  }
  return m;
}

}  // namespace drapeplan
