#include "mapping/surface/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drapeplan {
namespace {

// Bins for each triangle: with one, a line looks at a handful of triangles.
constexpr double kBinsPerTriangle = 1;
constexpr int kMostBins = 2000;  // along one side

// Weights of the corners may be so far below 0: a line through an edge hits at least one of its two
// triangles.
constexpr double kOnEdge = 1e-7;

}  // namespace

Extent bounding_box(const Triangles& triangles) {
  Extent box{triangles.vertices.front().head<2>(), triangles.vertices.front().head<2>()};
  for (const Eigen::Vector3d& vertex : triangles.vertices) {
    box.lower = box.lower.cwiseMin(vertex.head<2>());
    box.upper = box.upper.cwiseMax(vertex.head<2>());
  }
  return box;
}

VerticalLines::VerticalLines(const Triangles& triangles)
    : triangles_(triangles), box_(bounding_box(triangles)) {
  const Eigen::Vector2d size = (box_.upper - box_.lower).cwiseMax(1e-9);
  const double bins = kBinsPerTriangle * double(triangles.corners.size()) + 1;
  const double side = std::sqrt(size.x() * size.y() / bins);
  columns_ = int(std::clamp(size.x() / side, 1.0, double(kMostBins)));
  rows_ = int(std::clamp(size.y() / side, 1.0, double(kMostBins)));
  per_metre_ = Eigen::Vector2d(columns_ / size.x(), rows_ / size.y());

  const auto for_each_bin = [&](const std::array<int, 3>& corners, const auto& visit) {
    Eigen::Vector2d lower = triangles.vertices[size_t(corners[0])].head<2>(), upper = lower;
    for (const int corner : corners) {
      lower = lower.cwiseMin(triangles.vertices[size_t(corner)].head<2>());
      upper = upper.cwiseMax(triangles.vertices[size_t(corner)].head<2>());
    }
    // Wider by the tolerance of a hit, so that a line beside an edge finds its triangle.
    const Eigen::Vector2d slack = Eigen::Vector2d::Constant(2 * kOnEdge * (upper - lower).maxCoeff());
    lower -= slack;
    upper += slack;
    for (int i = column(lower.x()); i <= column(upper.x()); ++i) {
      for (int j = row(lower.y()); j <= row(upper.y()); ++j) visit(size_t(i * rows_ + j));
    }
  };
  first_.assign(size_t(columns_ * rows_) + 1, 0);
  for (const auto& corners : triangles.corners) for_each_bin(corners, [&](size_t bin) { ++first_[bin + 1]; });
  for (size_t bin = 1; bin < first_.size(); ++bin) first_[bin] += first_[bin - 1];
  members_.resize(size_t(first_.back()));
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (size_t t = 0; t < triangles.corners.size(); ++t)
    for_each_bin(triangles.corners[t], [&](size_t bin) { members_[size_t(next[bin]++)] = int(t); });
}

int VerticalLines::column(double x) const {
  return int(std::clamp((x - box_.lower.x()) * per_metre_.x(), 0.0, double(columns_ - 1)));
}

int VerticalLines::row(double y) const {
  return int(std::clamp((y - box_.lower.y()) * per_metre_.y(), 0.0, double(rows_ - 1)));
}

template <class Visit>
void VerticalLines::for_each_hit(double x, double y, const Visit& visit) const {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  const auto bin = size_t(column(x) * rows_ + row(y));
  for (int k = first_[bin]; k < first_[bin + 1]; ++k) {
    const std::array<int, 3>& corners = triangles_.corners[size_t(members_[size_t(k)])];
    const Eigen::Vector3d& a = triangles_.vertices[size_t(corners[0])];
    const Eigen::Vector3d& b = triangles_.vertices[size_t(corners[1])];
    const Eigen::Vector3d& c = triangles_.vertices[size_t(corners[2])];
    const double twice_area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    const double wb = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / twice_area;
    const double wc = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / twice_area;
    // False for a vertical triangle, whose weights are infinite or NaN.
    if (wb >= -kOnEdge && wc >= -kOnEdge && wb + wc <= 1 + kOnEdge)
      visit(a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z()));
  }
}

std::vector<double> VerticalLines::heights(double x, double y, double merged) const {
  std::vector<double> all;
  for_each_hit(x, y, [&all](double z) { all.push_back(z); });
  std::sort(all.begin(), all.end(), std::greater<>());
  all.erase(std::unique(all.begin(), all.end(),
                        [merged](double above, double below) { return above - below < merged; }),
            all.end());
  return all;
}

double VerticalLines::top(double x, double y) const {
  double highest = std::numeric_limits<double>::quiet_NaN();
  for_each_hit(x, y, [&highest](double z) { highest = std::fmax(highest, z); });
  return highest;
}

}  // namespace drapeplan
