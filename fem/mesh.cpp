#include "fem/mesh.hpp"

#include <cmath>
#include <stdexcept>

namespace drapeplan {

Mesh rectangle_mesh(double width, double height, double mesh_size) {
  if (!(width > 0 && height > 0 && mesh_size > 0)) throw std::invalid_argument("rectangle_mesh: lengths must be positive");
  constexpr double kSlack = 1e-9;  // so that 100 mm / 10 mm gives 10 cells, not 11
  const int nx = std::max(1, int(std::ceil(width / mesh_size - kSlack)));
  const int ny = std::max(1, int(std::ceil(height / mesh_size - kSlack)));
  const auto node = [nx](int i, int j) { return i + j * (nx + 1); };
  Mesh mesh;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) mesh.rest.emplace_back(width * (double(i) / nx - 0.5), height * (double(j) / ny - 0.5));
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) mesh.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
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
