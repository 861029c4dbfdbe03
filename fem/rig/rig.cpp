#include "fem/rig/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mapping/polygon.hpp"

namespace drapeplan {
namespace {

/// Lines through pads whose centres are at `centres`: see column_places().
std::vector<double> lines_through(const std::vector<double>& centres, double radius, double mesh_size) {
  const double disc = std::numbers::pi * radius * radius;
  const int most = std::max(1, int(std::ceil(radius / mesh_size - 1e-9)));
  Polygon lattice;
  for (int i = -most; i <= most; ++i) {
    for (int j = -most; j <= most; ++j) {
      if (std::hypot(i, j) <= most + (std::sqrt(2.0) - 1) * (1 + 1e-9)) lattice.emplace_back(i, j);
    }
  }
  const double cell = std::sqrt(disc / signed_area(convex_hull(lattice)));
  std::vector<double> lines;
  for (const double centre : centres) {
    for (int k = -most; k <= most; ++k) {
      const double line = centre + k * cell;
      // Pads that all but touch: two lines of theirs that are close become one, or a sliver would set the
      // step.
      if (!lines.empty() && line - lines.back() < 0.5 * cell) {
        lines.back() = 0.5 * (lines.back() + line);
      } else {
        lines.push_back(line);
      }
    }
  }
  return lines;
}

}  // namespace

double reach_of_pads(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest) {
  const double disc = std::numbers::pi * rig.pad_radius * rig.pad_radius;
  constexpr double kFarthest = 1.3, kSame = 1e-6;  // of the radius; a lattice of 3 x 3 nodes reaches to 1.25
  Polygon fullest;                                 // offsets of the nodes near the pad that has most of them
  for (int g = 0; g < rig.count(); ++g) {
    Polygon near;
    for (const Eigen::Vector2d& node : rest) {
      if ((node - rig.place(g)).norm() <= kFarthest * rig.pad_radius) near.push_back(node - rig.place(g));
    }
    if (near.size() > fullest.size()) fullest = near;
  }
  std::sort(fullest.begin(), fullest.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  double reach = rig.pad_radius, miss = std::numeric_limits<double>::infinity();
  Polygon inside;
  for (size_t k = 0; k < fullest.size(); ++k) {
    inside.push_back(fullest[k]);
    const double norm = fullest[k].norm();
    if (k + 1 < fullest.size() && fullest[k + 1].norm() < norm + kSame * rig.pad_radius) continue;
    const double area = inside.size() > 2 ? signed_area(convex_hull(inside)) : 0;
    if (std::abs(area - disc) < miss) miss = std::abs(area - disc), reach = norm;
  }
  return reach * (1 + 2 * kSame);
}

std::vector<double> column_places(const RigOptions& rig, double mesh_size) {
  std::vector<double> places;
  for (int i = 0; i < rig.columns; ++i) places.push_back(rig.place(i).x());
  return lines_through(places, rig.pad_radius, mesh_size);
}

std::vector<double> row_places(const RigOptions& rig, double mesh_size) {
  std::vector<double> places;
  for (int j = 0; j < rig.rows; ++j) places.push_back(rig.place(j * rig.columns).y());
  return lines_through(places, rig.pad_radius, mesh_size);
}

std::string RigOptions::name(int gripper) const {
  const auto [i, j] = indices(gripper);
  return fmt::format("[{}, {}]", i, j);
}

double interlink_length(const RigOptions& rig, size_t index) {
  return rig.interlinks->lengths.empty() ? rig.spacing : rig.interlinks->lengths[index];
}

std::vector<std::array<int, 2>> interlinks(const RigOptions& rig) {
  std::vector<std::array<int, 2>> pairs;
  if (!rig.interlinks) return pairs;
  for (int j = 0; j < rig.rows; ++j) {
    for (int i = 0; i + 1 < rig.columns; ++i) pairs.push_back({j * rig.columns + i, j * rig.columns + i + 1});
  }
  for (int j = 0; j + 1 < rig.rows; ++j) {
    for (int i = 0; i < rig.columns; ++i) pairs.push_back({j * rig.columns + i, (j + 1) * rig.columns + i});
  }
  return pairs;
}

}  // namespace drapeplan
