#include "mapping/surface/upper_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mapping/surface/fit.hpp"

namespace drapeplan {
namespace {

constexpr double kMillimetre = 1e-3;

// Tessellations of neighbouring patches lap by their height of arc, and a thin sheet is one surface: hits
// nearer than this share of the size of the whole are one.
constexpr double kMerged = 1e-3;
// Coordinates are often stored in single precision.
constexpr double kSlack = 1e-6;     // of the size
constexpr double kSteepest = 5.67;  // slope of 80 degrees: beyond it the surface is a wall

// Places that are looked at: half the spacing of the vertices apart, within these bounds, along the longer
// side.
constexpr double kFewestPlaces = 60, kMostPlaces = 400;

// Of a vertex, in cells with vertices in or beside them: facets then tell planes from waves, but the fit must
// not follow their edges. Other cells have no better data than their facets: these count fully.
constexpr double kFacetWeight = 1e-4;
constexpr double kSmoothing =
    0.2;                           // of a cell: waves of four cells keep all but a thousandth of their height
constexpr double kFirstCells = 2;  // cell over spacing of vertices
constexpr int kFewestCells = 8;    // along the longer side
constexpr int kMostCoefficients = 16000;     // about a second of one core for the last fit
constexpr double kCellGrowth = 1.05;         // towards cells that are not too many
constexpr double kLeastShrinkage = 0.8;      // cells that are hardly smaller are not tried
constexpr int kCoefficientsBeyondCells = 3;  // along one side of a cubic spline
constexpr double kExact = 1e-6;           // [m] vertices that are met so well are met exactly
constexpr double kWellBelowFacets = 0.05;
// Halved cells must lower what is missed at least so much: of vertices, and of facets, where an edge that is
// rounded off gets half as wide.
constexpr double kWorthHalving = 0.5, kWorthForFacets = 0.8;
// What the user is told of: a tenth and a half of the smallest gap that drapes are usually judged by, 1 mm.
constexpr double kMissedVertex = 1e-4, kMissedFacet = 5e-4;  // [m]

std::string place_text(const Eigen::Vector2d& at) {
  return fmt::format("x = {:.1f} mm, y = {:.1f} mm", at.x() / kMillimetre, at.y() / kMillimetre);
}

std::string extent_text(const Extent& e) {
  return fmt::format("x from {:.1f} to {:.1f} mm and y from {:.1f} to {:.1f} mm", e.lower.x() / kMillimetre,
                     e.upper.x() / kMillimetre, e.lower.y() / kMillimetre, e.upper.y() / kMillimetre);
}

bool covers(const Extent& outer, const Extent& inner, double slack) {
  return ((inner.lower - outer.lower).array() >= -slack).all() &&
         ((outer.upper - inner.upper).array() >= -slack).all();
}

// Places of one kind of fault: the first one is named, and how many there are.
struct FaultPlaces {
  int count = 0;
  Eigen::Vector2d first{0, 0};
  double extreme = 0;

  void add(const Eigen::Vector2d& at, double value) {
    if (count++ == 0 || value > extreme) {
      first = at;
      extreme = value;
    }
  }
};

// What a spline of so many cells is fitted to.
struct CellSamples {
  std::vector<FitPoint> points;
  bool any_far = false;  ///< a cell has no vertex in it nor beside it
};

class SurfaceFitter {
 public:
  SurfaceFitter(const Triangles& triangles, const std::optional<Extent>& wanted)
      : triangles_(triangles), box_(bounding_box(triangles)), lines_(triangles) {
    result_.extent = wanted.value_or(box_);
    size_ = (box_.upper - box_.lower).norm();
  }

  UpperSurface fit() {
    if (!is_covered()) return std::move(result_);
    find_vertices();
    look_at_places();
    if (!result_.faults.empty()) return std::move(result_);
    find_facets();
    refine();
    warn();
    return std::move(result_);
  }

 private:
  void fault(std::string text) { result_.faults.push_back(std::move(text)); }

  [[nodiscard]] bool inside(const Eigen::Vector2d& at) const {
    return covers(result_.extent, {at, at}, kSlack * size_);
  }

  bool is_covered() {
    const Extent& extent = result_.extent;
    if (covers(box_, extent, kSlack * size_)) return true;
    std::string hint;
    for (const auto& [factor, unit] :
         {std::pair(1e3, "a thousand times as long"), std::pair(1e-3, "a thousandth"),
          std::pair(25.4, "25.4 times as long (inches)")}) {
      if (covers({factor * box_.lower, factor * box_.upper}, extent, factor * kSlack * size_) && hint.empty())
        hint = fmt::format("; with a unit {} it would: is `unit` wrong?", unit);
    }
    fault(fmt::format("the surface covers {}, which is not all of the extent, {}{}", extent_text(box_),
                      extent_text(extent), hint));
    return false;
  }

  /// Whether nothing lies above a point of the surface. The line stands a hair inwards: on the rim of a solid
  /// it hits the upper surface whatever the rounding.
  [[nodiscard]] bool seen_from_above(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d middle = 0.5 * (box_.lower + box_.upper), at = point.head<2>();
    const Eigen::Vector2d line = at + 0.5 * kSlack * size_ * (middle - at).normalized();
    return !(lines_.top(line.x(), line.y()) - point.z() > 10 * kSlack * size_);
  }

  /// Vertices that are seen from above.
  void find_vertices() {
    std::vector<Eigen::Vector3d> seen;
    for (const Eigen::Vector3d& vertex : triangles_.vertices) {
      if (inside(vertex.head<2>()) && seen_from_above(vertex)) seen.push_back(vertex);
    }
    // Files of triangles name a vertex once for each of its facets.
    const auto key = [](const Eigen::Vector3d& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
    std::sort(seen.begin(), seen.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    const double area = (result_.extent.upper - result_.extent.lower).prod();
    vertex_area_ = area / double(std::max<size_t>(seen.size(), 1));
    for (const Eigen::Vector3d& vertex : seen) vertices_.push_back({vertex, vertex_area_});
  }

  /// Holes, folds and walls, at places of a regular lattice over the extent, its edges included.
  void look_at_places() {
    const Extent& extent = result_.extent;
    const Eigen::Vector2d size = extent.upper - extent.lower;
    const double longer = size.maxCoeff();
    const double step = longer / std::clamp(2 * longer / std::sqrt(vertex_area_), kFewestPlaces, kMostPlaces);
    const int nx = int(std::ceil(size.x() / step)) + 1, ny = int(std::ceil(size.y() / step)) + 1;
    Eigen::MatrixXd top(nx, ny);
    Eigen::MatrixXi layers(nx, ny);
    const auto at = [&](int i, int j) -> Eigen::Vector2d {
      const Eigen::Array2d share(double(i) / (nx - 1), double(j) / (ny - 1));
      // A hair inside, where the outermost triangles are hit whatever the rounding.
      return extent.lower.array() + size.array() * (kSlack + (1 - 2 * kSlack) * share);
    };
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        const Eigen::Vector2d place = at(i, j);
        const std::vector<double> heights = lines_.heights(place.x(), place.y(), kMerged * size_);
        layers(i, j) = int(heights.size());
        top(i, j) = heights.empty() ? 0 : heights.front();
        if (!heights.empty()) facets_.push_back({{place.x(), place.y(), top(i, j)}, 1});
      }
    }
    FaultPlaces holes, folds, walls;
    const int usual = usual_layers(layers);
    const Eigen::Array2d steps(size.x() / (nx - 1), size.y() / (ny - 1));
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        if (layers(i, j) == 0) holes.add(at(i, j), 0);
        if (layers(i, j) > usual) folds.add(at(i, j), layers(i, j));
        const auto wall = [&](int k, int l, double apart) {
          if (k >= nx || l >= ny || layers(i, j) == 0 || layers(k, l) == 0) return;
          const double step_up = std::abs(top(k, l) - top(i, j));
          if (step_up > kSteepest * apart) walls.add(0.5 * (at(i, j) + at(k, l)), step_up);
        };
        wall(i + 1, j, steps.x());
        wall(i, j + 1, steps.y());
      }
    }
    report(holes, folds, walls, nx * ny, steps.maxCoeff());
  }

  /// Once, or twice for a solid; what most places have, so that the rest can be told from it.
  static int usual_layers(const Eigen::MatrixXi& layers) {
    return (layers.array() >= 2).count() > (layers.array() == 1).count() ? 2 : 1;
  }

  void report(const FaultPlaces& holes, const FaultPlaces& folds, const FaultPlaces& walls, int places,
              double step) {
    if (holes.count > 0)
      fault(fmt::format(
          "there is no surface at {} ({} of {} places in the extent have none): close the hole, or give "
          "an `extent` that the surface covers, {} at most",
          place_text(holes.first), holes.count, places, extent_text(box_)));
    if (folds.count > 0)
      fault(fmt::format(
          "{:.0f} surfaces lie above one another at {} ({} of {} places): a fold, an overhang, or parts "
          "below the mold; a mold is one height field, or a solid with one bottom",
          folds.extreme, place_text(folds.first), folds.count, places));
    if (walls.count > 0)
      fault(fmt::format(
          "a wall: the surface falls by {:.1f} mm within {:.1f} mm at {} ({} places are steeper than 80 "
          "degrees)",
          walls.extreme / kMillimetre, step / kMillimetre, place_text(walls.first), walls.count));
  }

  /// Middles of the facets that are seen from above, beside the places that were looked at.
  void find_facets() {
    for (const std::array<int, 3>& corners : triangles_.corners) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const int corner : corners) middle += triangles_.vertices[size_t(corner)] / 3;
      if (inside(middle.head<2>()) && seen_from_above(middle)) facets_.push_back({middle, 1});
    }
  }

  /// Fits with smaller and smaller cells.
  void refine() {
    const Eigen::Vector2d size = result_.extent.upper - result_.extent.lower;
    double cell = std::min(kFirstCells * std::sqrt(vertex_area_), size.maxCoeff() / kFewestCells);
    while (coefficients_for(cell) > kMostCoefficients) cell *= kCellGrowth;
    for (bool first = true;; first = false) {
      const Eigen::Vector2i cells = cells_for(cell).cast<int>();
      const CellSamples samples = samples_for(cells);
      SplineShape spline = fit_spline(samples.points, result_.extent, cells, kSmoothing * cell);
      const SplinePatches patches(spline);
      const Deviation vertices = deviation(patches, vertices_), facets = deviation(patches, facets_);
      if (first || is_worth(vertices, facets)) {
        result_.spline = std::move(spline);
        result_.vertices = vertices;
        result_.facets = facets;
        if (are_met(vertices, facets) && (!samples.any_far || facets.largest <= kExact)) return;
      } else if (!samples.any_far || result_.facets.largest <= kMissedFacet) {
        return;
      }
      double next = cell / 2;
      while (coefficients_for(next) > kMostCoefficients) next *= kCellGrowth;
      if (next > kLeastShrinkage * cell) return;
      cell = next;
    }
  }

  static bool are_met(const Deviation& vertices, const Deviation& facets) {
    return vertices.largest <= std::max(kExact, kWellBelowFacets * facets.largest);
  }

  /// Whether smaller cells brought vertices nearer that were not met yet, or the middles of facets.
  [[nodiscard]] bool is_worth(const Deviation& vertices, const Deviation& facets) const {
    const Deviation &v = result_.vertices, &f = result_.facets;
    return (!are_met(v, f) && vertices.largest < kWorthHalving * v.largest) ||
           facets.largest < kWorthForFacets * f.largest;
  }

  /// Along x and y, of this size at most.
  [[nodiscard]] Eigen::Vector2d cells_for(double cell) const {
    return ((result_.extent.upper - result_.extent.lower) / cell).array().ceil().max(1.0);
  }

  [[nodiscard]] double coefficients_for(double cell) const {
    return (cells_for(cell).array() + (2 * kSplineMargin + kCoefficientsBeyondCells)).prod();
  }

  /// The vertices, and the surface in the middle of every cell: with little weight where vertices are near.
  [[nodiscard]] CellSamples samples_for(const Eigen::Vector2i& cells) const {
    CellSamples samples{vertices_, false};
    const Eigen::Vector2d lower = result_.extent.lower;
    const Eigen::Vector2d size = (result_.extent.upper - lower).cwiseQuotient(cells.cast<double>());
    Eigen::MatrixXi near = Eigen::MatrixXi::Zero(cells.x(), cells.y());
    for (const FitPoint& vertex : vertices_) {
      const Eigen::Vector2d at = (vertex.place.head<2>() - lower).cwiseQuotient(size);
      const int i = std::clamp(int(at.x()), 0, cells.x() - 1), j = std::clamp(int(at.y()), 0, cells.y() - 1);
      const int i0 = std::max(i - 1, 0), j0 = std::max(j - 1, 0);
      near.block(i0, j0, std::min(i + 2, cells.x()) - i0, std::min(j + 2, cells.y()) - j0).setOnes();
    }
    for (int i = 0; i < cells.x(); ++i) {
      for (int j = 0; j < cells.y(); ++j) {
        const Eigen::Vector2d at = lower + size.cwiseProduct(Eigen::Vector2d(i + 0.5, j + 0.5));
        const double top = lines_.top(at.x(), at.y());
        const double weight = near(i, j) != 0 ? kFacetWeight : 1;
        if (std::isfinite(top)) samples.points.push_back({{at.x(), at.y(), top}, weight * size.prod()});
        samples.any_far = samples.any_far || near(i, j) == 0;
      }
    }
    return samples;
  }

  static Deviation deviation(const SplinePatches& patches, const std::vector<FitPoint>& points) {
    Deviation result;
    double squares = 0;
    for (const FitPoint& point : points) {
      const Jet jet = patches.jet(point.place.x(), point.place.y());
      const double off = std::abs(point.place.z() - jet.z) / std::sqrt(1 + jet.zx * jet.zx + jet.zy * jet.zy);
      squares += off * off;
      if (off > result.largest) {
        result.largest = off;
        result.at = point.place.head<2>();
      }
    }
    result.places = int(points.size());
    if (!points.empty()) result.rms = std::sqrt(squares / double(points.size()));
    return result;
  }

  void warn() {
    const Deviation &v = result_.vertices, &f = result_.facets;
    if (v.largest > kMissedVertex)
      result_.warnings.push_back(
          fmt::format("the smooth surface misses a vertex by {:.2f} mm at {}: an edge there is "
                      "rounded off, or the data are rough",
                      v.largest / kMillimetre, place_text(v.at)));
    if (f.largest > kMissedFacet)
      result_.warnings.push_back(
          fmt::format("a facet is {:.2f} mm off the smooth surface at {}: an edge "
                      "there is rounded off, or the facets are coarse",
                      f.largest / kMillimetre, place_text(f.at)));
  }

  const Triangles& triangles_;
  Extent box_;
  VerticalLines lines_;
  double size_ = 0;         ///< diagonal of the bounding box in plan [m]
  double vertex_area_ = 0;  ///< of the extent, for each vertex [m^2]
  std::vector<FitPoint> vertices_, facets_;
  UpperSurface result_;
};

}  // namespace

UpperSurface upper_surface(const Triangles& triangles, const std::optional<Extent>& wanted) {
  UpperSurface nothing;
  if (wanted) nothing.extent = *wanted;
  if (triangles.corners.empty() || triangles.vertices.empty()) {
    nothing.faults.emplace_back("has no triangles");
    return nothing;
  }
  for (const Eigen::Vector3d& vertex : triangles.vertices) {
    if (vertex.allFinite()) continue;
    nothing.faults.push_back(
        fmt::format("a vertex ({}, {}, {}) is not finite", vertex.x(), vertex.y(), vertex.z()));
    return nothing;
  }
  const Extent box = bounding_box(triangles);
  if (!((box.upper - box.lower).array() > 0).all()) {
    nothing.faults.push_back("covers no area in plan: " + extent_text(box));
    return nothing;
  }
  return SurfaceFitter(triangles, wanted).fit();
}

}  // namespace drapeplan
