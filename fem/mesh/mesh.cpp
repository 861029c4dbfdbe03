#include "fem/mesh/mesh.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/mesh/lines.hpp"
#include "mapping/error.hpp"

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

}  // namespace

std::vector<double> mesh_lines(double lower, double upper, double mesh_size,
                               const std::vector<double>& places) {
  constexpr double kNarrow = 0.75;  // of the next cell
  std::vector<double> lines{lower};
  for (const double place : places) {
    if (place < upper) divide(lines, place, mesh_size);  // what lies before the last line is passed over
  }
  divide(lines, upper, mesh_size);
  if (places.empty()) return lines;
  if (lines.size() > 3 && lines[1] - lines[0] < kNarrow * (lines[2] - lines[1]))
    lines.erase(lines.begin() + 1);
  const size_t last = lines.size() - 1;
  if (last > 2 && lines[last] - lines[last - 1] < kNarrow * (lines[last - 1] - lines[last - 2]))
    lines.erase(lines.end() - 2);
  return lines;
}

Mesh rectangle_mesh(double width, double height, double mesh_size) {
  return rectangle_mesh(width, height, mesh_size, {}, {});
}

Mesh rectangle_mesh(double width, double height, double mesh_size, const std::vector<double>& u,
                    const std::vector<double>& v) {
  if (!(width > 0 && height > 0 && mesh_size > 0))
    throw WrongInput("rectangle_mesh: lengths must be positive");
  const std::vector<double> x = mesh_lines(-0.5 * width, 0.5 * width, mesh_size, u);
  const std::vector<double> y = mesh_lines(-0.5 * height, 0.5 * height, mesh_size, v);
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
    // In a triangle the repeated node counts once.
    const auto repeats = [&quad](size_t c) { return quad[c] == quad[(c + 3) % 4]; };
    const bool triangle = repeats(0) || repeats(1) || repeats(2) || repeats(3);
    for (size_t c = 0; c < 4; ++c) {
      if (!repeats(c)) areas[size_t(quad[c])] += area / (triangle ? 3 : 4);
    }
  }
  return areas;
}

}  // namespace drapeplan
