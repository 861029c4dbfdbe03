#include "planner/molds/mold_file.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "planner/molds/height_file.hpp"
#include "planner/molds/triangle_file.hpp"

namespace drapeplan {
namespace {

/// In micrometres or millimetres, with three digits.
std::string length_text(double length) {
  constexpr double kMillimetre = 1e-3, kMicrometre = 1e-6;
  return length < 0.1 * kMillimetre ? fmt::format("{:.3g} um", length / kMicrometre)
                                    : fmt::format("{:.3g} mm", length / kMillimetre);
}

void place(Triangles& triangles, const MoldFile& options) {
  const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(options.rotate.z(), Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(options.rotate.y(), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(options.rotate.x(), Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  for (Eigen::Vector3d& vertex : triangles.vertices)
    vertex = rotation * (options.unit * vertex) + options.translate;
}

std::string fit_text(const std::string& name, size_t triangles, const MoldFile& options,
                     const UpperSurface& s) {
  return fmt::format(
      "{}: {} triangles{}, {} vertices seen from above; a smooth surface of {} x {} coefficients misses them "
      "by {} at "
      "most ({} r.m.s.) and the facets by {} at most ({} r.m.s.)",
      name, triangles, options.heights ? " of a grid" : "", s.vertices.places, s.spline.coefficients.rows(),
      s.spline.coefficients.cols(), length_text(s.vertices.largest), length_text(s.vertices.rms),
      length_text(s.facets.largest), length_text(s.facets.rms));
}

}  // namespace

MoldReading read_mold_file(const std::filesystem::path& file, const std::string& name,
                           const MoldFile& options) {
  TriangleReading read = options.heights ? read_heights(file) : read_triangles(file);
  MoldReading reading;
  reading.errors = std::move(read.errors);
  if (!reading.errors.empty()) return reading;
  place(read.triangles, options);
  try {
    reading.surface = upper_surface(read.triangles, options.extent);
  } catch (const std::runtime_error& error) {
    reading.errors.push_back({file.string(), 0, "", error.what()});
  }
  for (const std::string& fault : reading.surface.faults)
    reading.errors.push_back({file.string(), 0, "", fault});
  if (reading.errors.empty())
    reading.text = fit_text(name, read.triangles.corners.size(), options, reading.surface);
  return reading;
}

}  // namespace drapeplan
