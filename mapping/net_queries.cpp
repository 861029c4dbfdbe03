// What is read from a mapped net: places of ply points, outline, corners, shear.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "mapping/cell.hpp"
#include "mapping/net.hpp"

namespace drapeplan {
namespace {

constexpr double kRoundOff = 1e-12;  // by which a ply point may lie outside [m]

// Lagrange weights of up to four neighbouring net lines, cubic where there are four.
struct Stencil {
  int first = 0, count = 0;
  double weight[4] = {};
};

Stencil stencil_at(const std::vector<double>& lines, double at, const char* name) {
  if (!(at >= lines.front() - kRoundOff && at <= lines.back() + kRoundOff)) {
    throw std::out_of_range(fmt::format("mapped_point: {} = {:f} m lies outside the ply", name, at));
  }
  const int n = static_cast<int>(lines.size());
  Stencil stencil;
  stencil.count = std::min(n, 4);
  const int right = static_cast<int>(std::upper_bound(lines.begin(), lines.end(), at) - lines.begin());
  stencil.first = std::clamp(right - 2, 0, n - stencil.count);
  for (int a = 0; a < stencil.count; ++a) {
    const double line = lines[size_t(stencil.first + a)];
    stencil.weight[a] = 1;
    for (int b = 0; b < stencil.count; ++b) {
      const double other = lines[size_t(stencil.first + b)];
      if (b != a) stencil.weight[a] *= (at - other) / (line - other);
    }
  }
  return stencil;
}

}  // namespace

Eigen::Vector3d mapped_point(const Net& net, const Mold& mold, const Eigen::Vector2d& uv) {
  const Stencil su = stencil_at(net.u, uv.x(), "u");
  const Stencil sv = stencil_at(net.v, uv.y(), "v");
  Eigen::Vector2d at(0, 0);
  for (int b = 0; b < sv.count; ++b) {
    for (int a = 0; a < su.count; ++a) {
      at += su.weight[a] * sv.weight[b] * net.node(su.first + a, sv.first + b).head<2>();
    }
  }
  return mold.point(at.x(), at.y());
}

std::vector<Eigen::Vector3d> prescribed_boundary(const Net& net) {
  const int nu = static_cast<int>(net.u.size()), nv = static_cast<int>(net.v.size());
  std::vector<Eigen::Vector3d> outline;
  outline.reserve(2 * (net.u.size() + net.v.size()));
  for (int i = 0; i < nu - 1; ++i) outline.push_back(net.node(i, 0));
  for (int j = 0; j < nv - 1; ++j) outline.push_back(net.node(nu - 1, j));
  for (int i = nu - 1; i > 0; --i) outline.push_back(net.node(i, nv - 1));
  for (int j = nv - 1; j >= 0; --j) outline.push_back(net.node(0, j));
  return outline;
}

std::vector<Eigen::Vector3d> prescribed_boundary(const Net& net, const Mold& mold, const Ply& ply) {
  if (ply.outline.empty()) return prescribed_boundary(net);
  double widest = 0;
  for (const auto* lines : {&net.u, &net.v}) {
    for (size_t k = 1; k < lines->size(); ++k) widest = std::max(widest, (*lines)[k] - (*lines)[k - 1]);
  }
  const Polygon corners = corners_of(ply);
  std::vector<Eigen::Vector3d> boundary;
  for (size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d from = corners[k], edge = corners[(k + 1) % corners.size()] - from;
    const int parts = std::max(1, int(std::ceil(edge.norm() / widest)));
    for (int part = 0; part < parts; ++part)
      boundary.push_back(mapped_point(net, mold, from + edge * (double(part) / parts)));
  }
  boundary.push_back(boundary.front());
  return boundary;
}

std::vector<Eigen::Vector3d> mapped_corners(const Net& net) {
  const int i = static_cast<int>(net.u.size()) - 1, j = static_cast<int>(net.v.size()) - 1;
  return {net.node(0, 0), net.node(i, 0), net.node(i, j), net.node(0, j)};
}

std::vector<double> shear_field(const Net& net) {
  const int nu = static_cast<int>(net.u.size()), nv = static_cast<int>(net.v.size());
  std::vector<double> shear;
  shear.reserve(net.nodes.size());
  for (int j = 0; j + 1 < nv; ++j) {
    for (int i = 0; i + 1 < nu; ++i) {
      shear.push_back(
          middle_shear(net.node(i, j), net.node(i + 1, j), net.node(i, j + 1), net.node(i + 1, j + 1)));
    }
  }
  return shear;
}

}  // namespace drapeplan
