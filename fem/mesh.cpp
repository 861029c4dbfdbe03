#include "fem/mesh.hpp"

#include <cmath>
#include <stdexcept>

namespace drapeplan {

namespace {

/// Appends equal cells from the last line to `end`.
void divide(std::vector<double>& lines, double end, double mesh_size) {
  constexpr double kSlack = 1e-9;  // so that 100 mm / 10 mm gives 10 cells, not 11
  const double start = lines.back();
  if (end - start <= kSlack * mesh_size) return;  // a place on the edge
  const int cells = std::max(1, int(std::ceil((end - start) / mesh_size - kSlack)));
  for (int k = 1; k <= cells; ++k) lines.push_back(k == cells ? end : start + (end - start) * k / cells);
}

/// Mesh lines over [-length/2, length/2] through `places`.
std::vector<double> mesh_lines(double length, double mesh_size, const std::vector<double>& places) {
  std::vector<double> lines{-0.5 * length};
  for (const double place : places) divide(lines, place, mesh_size);
  divide(lines, 0.5 * length, mesh_size);
  if (places.empty()) return lines;
  if (lines.size() > 3 && lines[1] - lines[0] < 0.5 * (lines[2] - lines[1])) lines.erase(lines.begin() + 1);
  const size_t last = lines.size() - 1;
  if (last > 2 && lines[last] - lines[last - 1] < 0.5 * (lines[last - 1] - lines[last - 2]))
    lines.erase(lines.end() - 2);
  return lines;
}

}  // namespace

Mesh rectangle_mesh(double width, double height, double mesh_size) {
  return rectangle_mesh(width, height, mesh_size, {}, {});
}

Mesh rectangle_mesh(double width, double height, double mesh_size, const std::vector<double>& u,
                    const std::vector<double>& v) {
  if (!(width > 0 && height > 0 && mesh_size > 0))
    throw std::invalid_argument("rectangle_mesh: lengths must be positive");
  const std::vector<double> x = mesh_lines(width, mesh_size, u), y = mesh_lines(height, mesh_size, v);
  const int nx = int(x.size()) - 1, ny = int(y.size()) - 1;
  const auto node = [nx](int i, int j) { return i + j * (nx + 1); };
  Mesh mesh;
  for (const double yj : y) {
    for (const double xi : x) mesh.rest.emplace_back(xi, yj);
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i)
      mesh.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  }
  for (int i = 0; i < nx; ++i) mesh.outline.push_back(node(i, 0));
  for (int j = 0; j < ny; ++j) mesh.outline.push_back(node(nx, j));
  for (int i = nx; i > 0; --i) mesh.outline.push_back(node(i, ny));
  for (int j = ny; j > 0; --j) mesh.outline.push_back(node(0, j));
  return mesh;
}

std::vector<double> nodal_areas(const Mesh& mesh) {
  std::vector<double> areas(mesh.rest.size(), 0.0);
  for (const auto& quad : mesh.quads) {
    const Eigen::Vector2d ac = mesh.rest[size_t(quad[2])] - mesh.rest[size_t(quad[0])];
    const Eigen::Vector2d bd = mesh.rest[size_t(quad[3])] - mesh.rest[size_t(quad[1])];
    const double area = 0.5 * (ac.x() * bd.y() - ac.y() * bd.x());
    for (const int corner : quad) areas[size_t(corner)] += 0.25 * area;
  }
  return areas;
}

}  // namespace drapeplan
