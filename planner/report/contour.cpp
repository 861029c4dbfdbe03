#include "planner/report/contour.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

constexpr double kGrid =
    20;  // points of outlines lie on a raster of 1/20 pixel, so that shared edges match exactly

using Point = std::array<int, 2>;
using Edge = std::array<Point, 2>;

Point snapped(const Eigen::Vector2d& p) {
  return {int(std::lround(p.x() * kGrid)), int(std::lround(p.y() * kGrid))};
}

/// The part of a triangle where the field is >= level: 0, 3 or 4 corners in the order of the triangle.
std::vector<Point> part_above(const Triangles& t, const std::array<int, 3>& corners, double level) {
  std::vector<Point> polygon;
  for (size_t k = 0; k < 3; ++k) {
    const size_t a = size_t(corners[k]), b = size_t(corners[(k + 1) % 3]);
    const bool a_in = t.value[a] >= level, b_in = t.value[b] >= level;
    if (a_in) polygon.push_back(snapped(t.place[a]));
    if (a_in == b_in) continue;
    // Both triangles at this edge must find the same bits: start from the smaller node number.
    const size_t low = std::min(a, b), high = std::max(a, b);
    const double share = (level - t.value[low]) / (t.value[high] - t.value[low]);
    polygon.push_back(snapped(t.place[low] + share * (t.place[high] - t.place[low])));
  }
  return polygon;
}

std::string coordinates(const Point& p) {
  return fmt::format("{} {}", fixed(p[0] / kGrid, 2), fixed(p[1] / kGrid, 2));
}

/// Joins directed edges to closed loops; every point has as many edges in as out, so each walk returns to its
/// start.
std::string loops(const std::map<Edge, int>& edges) {
  std::map<Point, std::vector<Point>> next;
  for (const auto& [edge, count] : edges) {
    for (int k = 0; k < count; ++k) next[edge[0]].push_back(edge[1]);
  }
  std::string path;
  for (auto& [start, ends] : next) {
    while (!ends.empty()) {
      path += "M" + coordinates(start);
      for (Point at = start;;) {
        std::vector<Point>& out = next[at];
        const Point to = out.back();
        out.pop_back();
        if (to == start) break;
        path += "L" + coordinates(to);
        at = to;
      }
      path += "Z";
    }
  }
  return path;
}

}  // namespace

Triangles refine(const std::vector<Eigen::Vector2d>& place, const std::vector<double>& value,
                 const std::vector<std::array<int, 4>>& quads, int parts) {
  Triangles result;
  const int row = parts + 1;
  for (const auto& quad : quads) {
    const int first = int(result.place.size());
    for (int j = 0; j <= parts; ++j) {
      for (int i = 0; i <= parts; ++i) {
        const double s = double(i) / parts, t = double(j) / parts;
        const std::array<double, 4> weight{(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
        Eigen::Vector2d p(0, 0);
        double v = 0;
        for (size_t corner = 0; corner < 4; ++corner) {
          p += weight[corner] * place[size_t(quad[corner])];
          v += weight[corner] * value[size_t(quad[corner])];
        }
        result.place.push_back(p);
        result.value.push_back(v);
      }
    }
    for (int j = 0; j < parts; ++j) {
      for (int i = 0; i < parts; ++i) {
        const int a = first + i + j * row, b = a + 1, c = b + row, d = a + row;
        if ((i + j) % 2 == 0) {
          result.corners.insert(result.corners.end(), {{a, b, c}, {a, c, d}});
        } else {
          result.corners.insert(result.corners.end(), {{a, b, d}, {b, c, d}});
        }
      }
    }
  }
  return result;
}

std::string region_above(const Triangles& triangles, double level) {
  std::map<Edge, int> edges;  // ordered: the same picture has the same bytes
  for (const auto& corners : triangles.corners) {
    const std::vector<Point> polygon = part_above(triangles, corners, level);
    for (size_t k = 0; k < polygon.size(); ++k) {
      const Point& from = polygon[k];
      const Point& to = polygon[(k + 1) % polygon.size()];
      if (from == to) continue;
      const auto opposite = edges.find({to, from});
      if (opposite == edges.end()) {
        ++edges[{from, to}];
      } else if (--opposite->second == 0) {
        edges.erase(opposite);
      }
    }
  }
  return loops(edges);
}

}  // namespace drapeplan
