#include "fem/mesh/foot.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

using Eigen::Vector2d;

/// Where the point lies in the quadrilateral; nothing if outside.
std::optional<std::array<double, 4>> weights_in(const std::array<Vector2d, 4>& x, const Vector2d& at) {
  constexpr int kIterations = 12;
  constexpr double kSlack = 1e-9;  // [m]
  const auto inside = [](double low, double high, double value) { return low <= value && value <= high; };
  for (const Eigen::Index axis : {0, 1}) {
    const auto [low, high] = std::minmax({x[0][axis], x[1][axis], x[2][axis], x[3][axis]});
    if (!inside(low - kSlack, high + kSlack, at[axis])) return std::nullopt;
  }
  Vector2d s(0.5, 0.5);
  std::array<double, 4> w{};
  for (int k = 0; k < kIterations; ++k) {
    w = {(1 - s.x()) * (1 - s.y()), s.x() * (1 - s.y()), s.x() * s.y(), (1 - s.x()) * s.y()};
    const Vector2d miss = w[0] * x[0] + w[1] * x[1] + w[2] * x[2] + w[3] * x[3] - at;
    Eigen::Matrix2d slope;
    slope.col(0) = (1 - s.y()) * (x[1] - x[0]) + s.y() * (x[2] - x[3]);
    slope.col(1) = (1 - s.x()) * (x[3] - x[0]) + s.x() * (x[2] - x[1]);
    if (!(std::abs(slope.determinant()) > 0)) break;
    s -= slope.inverse() * miss;
  }
  constexpr double kRim = 1e-6;  // of a cell
  if (!inside(-kRim, 1 + kRim, s.x()) || !inside(-kRim, 1 + kRim, s.y())) return std::nullopt;
  return w;
}

std::optional<Foot> foot_in(const Mesh& mesh, size_t element, const std::vector<Vector2d>& place,
                            const Vector2d& at) {
  std::array<Vector2d, 4> corner;
  for (size_t c = 0; c < 4; ++c) corner[c] = place[size_t(mesh.quads[element][c])];
  const auto weight = weights_in(corner, at);
  return weight ? std::optional(Foot{element, *weight}) : std::nullopt;
}

}  // namespace

std::vector<Foot> feet_of(const Mesh& mesh, const std::vector<Vector2d>& place, const Vector2d& at) {
  std::vector<Foot> feet;
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    if (const auto foot = foot_in(mesh, e, place, at)) feet.push_back(*foot);
  }
  return feet;
}

std::optional<Foot> foot_of(const Mesh& mesh, const Vector2d& at) {
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    if (const auto foot = foot_in(mesh, e, mesh.rest, at)) return foot;
  }
  return std::nullopt;
}

Foot nearest_foot(const Mesh& mesh, const Vector2d& at) {
  if (const auto foot = foot_of(mesh, at)) return *foot;
  const auto nearer = [&at](const Vector2d& a, const Vector2d& b) {
    return (a - at).norm() < (b - at).norm();
  };
  const auto node = int(std::min_element(mesh.rest.begin(), mesh.rest.end(), nearer) - mesh.rest.begin());
  Foot foot;
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    const auto corner = std::find(mesh.quads[e].begin(), mesh.quads[e].end(), node);
    if (corner == mesh.quads[e].end()) continue;
    foot.element = e;
    foot.weight[size_t(corner - mesh.quads[e].begin())] = 1;
    break;
  }
  return foot;
}

Eigen::Vector3d place_of(const Mesh& mesh, const Foot& foot, const std::vector<Eigen::Vector3d>& position) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (size_t c = 0; c < 4; ++c) place += foot.weight[c] * position[size_t(mesh.quads[foot.element][c])];
  return place;
}

}  // namespace drapeplan
