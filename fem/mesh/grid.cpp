#include "fem/mesh/grid.hpp"

namespace drapeplan {

Mesh grid_mesh(int nu, int nv, std::vector<Eigen::Vector2d> rest) {
  Mesh mesh;
  mesh.rest = std::move(rest);
  const auto node = [nu](int i, int j) { return j * (nu + 1) + i; };
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i)
      mesh.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  }
  for (int i = 0; i < nu; ++i) mesh.outline.push_back(node(i, 0));
  for (int j = 0; j < nv; ++j) mesh.outline.push_back(node(nu, j));
  for (int i = nu; i > 0; --i) mesh.outline.push_back(node(i, nv));
  for (int j = nv; j > 0; --j) mesh.outline.push_back(node(0, j));
  return mesh;
}

Mesh grid_mesh(int nu, int nv, const std::function<Eigen::Vector2d(double, double)>& place) {
  std::vector<Eigen::Vector2d> rest;
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) rest.push_back(place(double(i) / nu, double(j) / nv));
  }
  return grid_mesh(nu, nv, std::move(rest));
}

}  // namespace drapeplan
