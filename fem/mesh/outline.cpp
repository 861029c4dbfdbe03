// Fibre-aligned meshes of arbitrary outlines.
//
// A grid along the fibres is laid over the polygon. Then nodes move onto the outline until no grid line
// between two nodes crosses it: first the node nearest to each sharp corner, then, crossing by crossing,
// shortest move first, the inner node outwards or the outer one inwards along the grid line. Cells whose
// nodes all lie inside or on the outline are kept; where one node is left outside, the three others are kept
// as a triangle, a quadrilateral whose inner node is repeated: its two short edges run along the fibres, so
// it cannot lock. Where inner nodes give way to outer ones, and whether lines run through corners, is tried
// in a few ways: the mesh that allows the largest time step is taken.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "fem/mesh/lines.hpp"
#include "fem/mesh/mesh.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;

/// A corner that turns by more is met by a node whatever the mesh size; flatter ones are taken for a curve.
constexpr double kSharpTurn = 20 * std::numbers::pi / 180;
/// An inner node moves outwards by up to this share of a cell, an outer one inwards by the rest: with 0.6,
/// edges that end on the outline are between 0.6 and 1.6 cells long.
constexpr std::array<double, 3> kOutwards{0.6, 0.7, 0.5};
/// A mesh line through a corner keeps this share of the mesh size from others, or the corner gets none.
constexpr double kLineDistance = 2.0 / 3;
/// Nearer than this share of the mesh size a node is on the outline: decides ties, far above round-off.
constexpr double kOnOutline = 1e-6;
/// Smallest area of the triangle at an element's corner, over the square of the mesh size.
constexpr double kSmallestCorner = 0.01;

/// Smallest stable step over that of a grid of full cells: below it the outline would set the price of a run.
constexpr double kSmallestStep = 0.3;

enum class Side { out, on, in };

[[noreturn]] void too_coarse(const std::string& why, const Vector2d& at, double mesh_size) {
  throw WrongInput(fmt::format(
      "outline_mesh: {} near ({:f}, {:f}) mm: the mesh size {:f} mm is too large for this outline", why,
      1e3 * at.x(), 1e3 * at.y(), 1e3 * mesh_size));
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<size_t> sharp_corners(const Polygon& polygon) {
  std::vector<size_t> sharp;
  const size_t n = polygon.size();
  for (size_t k = 0; k < n; ++k) {
    const Vector2d in = polygon[k] - polygon[(k + n - 1) % n], out = polygon[(k + 1) % n] - polygon[k];
    if (std::abs(std::atan2(cross(in, out), in.dot(out))) > kSharpTurn) sharp.push_back(k);
  }
  return sharp;
}

/// `places` and, where there is room, the corners' coordinates; increasing.
std::vector<double> with_corners(std::vector<double> places, const Polygon& polygon,
                                 const std::vector<size_t>& corners, Eigen::Index axis, double lower,
                                 double upper, double mesh_size) {
  for (const size_t corner : corners) {
    const double at = polygon[corner][axis];
    const auto near = [&](double line) { return std::abs(line - at) < kLineDistance * mesh_size; };
    if (near(lower) || near(upper) || std::any_of(places.begin(), places.end(), near)) continue;
    places.push_back(at);
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// Size of square cells that fit between all lines of both directions, at most `mesh_size` and at least half
/// of it; 0 if there is none, or no side of the polygon at 45 degrees that would gain: such a side then runs
/// through nodes, and so do the fibres from one corner to another.
double common_cell(const Polygon& polygon, double mesh_size, const std::vector<double>& u,
                   const std::vector<double>& v) {
  constexpr double kRounding = 1e-4;  // of a cell: places in files are rounded
  bool diagonal = false;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d edge = (polygon[(k + 1) % polygon.size()] - polygon[k]).cwiseAbs();
    diagonal = diagonal || std::abs(edge.x() - edge.y()) <= kRounding * mesh_size;
  }
  if (!diagonal) return 0;
  const auto fits = [](const std::vector<double>& lines, double cell) {
    for (size_t k = 1; k < lines.size(); ++k) {
      const double cells = (lines[k] - lines[k - 1]) / cell;
      if (std::abs(cells - std::round(cells)) > kRounding) return false;
    }
    return true;
  };
  const double gap = u[1] - u[0];
  for (double cells = std::ceil(gap / mesh_size - kRounding); gap / cells >= 0.5 * mesh_size; ++cells) {
    if (fits(u, gap / cells) && fits(v, gap / cells)) return gap / cells;
  }
  return 0;
}

/// The grid over the bounding box while its nodes move onto the outline.
class OutlineGrid {
 public:
  OutlineGrid(const Polygon& polygon, double mesh_size, double outwards, const std::vector<double>& u,
              const std::vector<double>& v)
      : polygon_(polygon),
        mesh_size_(mesh_size),
        outwards_(outwards),
        nu_(int(u.size())),
        nv_(int(v.size())) {
    for (const double vj : v) {
      for (const double ui : u) place_.emplace_back(ui, vj);
    }
    for (Vector2d& at : place_) {
      const Vector2d nearest = nearest_on_edges(polygon_, at);
      const bool on = (nearest - at).norm() <= kOnOutline * mesh_size_;
      side_.push_back(on ? Side::on : contains(polygon_, at) ? Side::in : Side::out);
      if (on) at = nearest;  // corners in files are rounded
    }
    grid_ = place_;
  }

  void meet_corners(const std::vector<size_t>& corners);
  void meet_edges();
  [[nodiscard]] Mesh kept_cells() const;

 private:
  /// A grid line between an inner and an outer node, and where it leaves the polygon.
  struct Crossing {
    int in, out;
    double share;  ///< from the inner node, in units of the line's length
  };

  [[nodiscard]] int node(int i, int j) const { return i + j * nu_; }
  [[nodiscard]] double first_exit(const Vector2d& from, const Vector2d& to) const;
  [[nodiscard]] bool keep(const std::array<int, 4>& nodes) const;

  const Polygon& polygon_;
  double mesh_size_, outwards_;
  int nu_, nv_;
  std::vector<Vector2d> grid_, place_;  ///< before and after moving [m]
  std::vector<Side> side_;
};

void OutlineGrid::meet_corners(const std::vector<size_t>& corners) {
  std::vector<char> taken(place_.size(), 0);
  for (const size_t corner : corners) {
    const Vector2d& at = polygon_[corner];
    size_t nearest = 0;
    for (size_t n = 1; n < grid_.size(); ++n) {
      if ((grid_[n] - at).squaredNorm() < (grid_[nearest] - at).squaredNorm()) nearest = n;
    }
    if (taken[nearest]) too_coarse("two corners are as close as a cell", at, mesh_size_);
    taken[nearest] = 1;
    place_[nearest] = at;
    side_[nearest] = Side::on;
  }
}

/// Share of the way from an inner place to an outer one at which the outline is met first.
double OutlineGrid::first_exit(const Vector2d& from, const Vector2d& to) const {
  const Vector2d way = to - from;
  double first = 1;
  for (size_t k = 0; k < polygon_.size(); ++k) {
    const Vector2d &a = polygon_[k], edge = polygon_[(k + 1) % polygon_.size()] - a;
    const double slope = cross(way, edge);
    if (slope == 0) continue;
    const double along = cross(a - from, edge) / slope, at = cross(a - from, way) / slope;
    if (at >= 0 && at <= 1 && along >= 0) first = std::min(first, along);
  }
  return first;
}

void OutlineGrid::meet_edges() {
  std::vector<Crossing> crossings;
  const auto look = [&](int p, int q) {
    if (side_[size_t(p)] == Side::out) std::swap(p, q);
    if (side_[size_t(p)] != Side::in || side_[size_t(q)] != Side::out) return;
    crossings.push_back({p, q, first_exit(grid_[size_t(p)], grid_[size_t(q)])});
  };
  for (int j = 0; j < nv_; ++j) {
    for (int i = 0; i + 1 < nu_; ++i) look(node(i, j), node(i + 1, j));
  }
  for (int j = 0; j + 1 < nv_; ++j) {
    for (int i = 0; i < nu_; ++i) look(node(i, j), node(i, j + 1));
  }
  // Ties in the order above, whatever the round-off: along 45 degrees all nodes move the same way.
  const auto rank = [this](const Crossing& c) {
    return std::llround((c.share < outwards_ ? c.share : 1 - c.share) / kOnOutline);
  };
  std::stable_sort(crossings.begin(), crossings.end(),
                   [&](const Crossing& a, const Crossing& b) { return rank(a) < rank(b); });
  for (const Crossing& c : crossings) {
    if (side_[size_t(c.in)] != Side::in || side_[size_t(c.out)] != Side::out) continue;  // done by another
    const auto moved = size_t(c.share < outwards_ ? c.in : c.out);
    place_[moved] = grid_[size_t(c.in)] + c.share * (grid_[size_t(c.out)] - grid_[size_t(c.in)]);
    side_[moved] = Side::on;
  }
}

/// Nodes in or on the outline: whether the piece between them belongs to the ply.
bool OutlineGrid::keep(const std::array<int, 4>& nodes) const {
  Vector2d middle(0, 0);
  for (const int n : nodes) {
    if (side_[size_t(n)] == Side::in) return true;
    middle += 0.25 * place_[size_t(n)];
  }
  return contains(polygon_, middle);
}

Mesh OutlineGrid::kept_cells() const {
  Mesh mesh;
  std::vector<int> name(place_.size(), -1);
  for (int j = 0; j + 1 < nv_; ++j) {
    for (int i = 0; i + 1 < nu_; ++i) {
      std::array<int, 4> quad{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
      const auto out = [this](int n) { return side_[size_t(n)] == Side::out; };
      const auto outside = std::count_if(quad.begin(), quad.end(), out);
      if (outside > 1) continue;
      if (outside == 1) {  // the corner opposite the outer one takes its place too
        const auto k = size_t(std::find_if(quad.begin(), quad.end(), out) - quad.begin());
        quad = {quad[(k + 1) % 4], quad[(k + 2) % 4], quad[(k + 2) % 4], quad[(k + 3) % 4]};
      }
      if (!keep(quad)) continue;
      for (const int n : quad) name[size_t(n)] = 0;
      mesh.quads.push_back(quad);
    }
  }
  for (size_t n = 0; n < place_.size(); ++n) {
    if (name[n] < 0) continue;
    name[n] = mesh.node_count();
    mesh.rest.push_back(place_[n]);
  }
  for (auto& quad : mesh.quads) {
    for (int& n : quad) n = name[size_t(n)];
  }
  return mesh;
}

/// Nodes of the mesh's edge, counter-clockwise from the one nearest to `start`.
std::vector<int> edge_of(const Mesh& mesh, const Vector2d& start, double mesh_size) {
  std::map<std::pair<int, int>, int> sides;  // directed sides of elements; those without a partner are edge
  for (const auto& quad : mesh.quads) {
    for (size_t c = 0; c < 4; ++c) {
      const int from = quad[c], to = quad[(c + 1) % 4];
      if (from == to) continue;
      if (const auto partner = sides.find({to, from}); partner != sides.end()) {
        sides.erase(partner);
      } else {
        sides[{from, to}] = 1;
      }
    }
  }
  std::map<int, int> next;
  for (const auto& [side, unused] : sides) {
    if (!next.emplace(side.first, side.second).second)
      too_coarse("the mesh touches itself", mesh.rest[size_t(side.first)], mesh_size);
  }
  if (next.empty()) too_coarse("nothing is left", start, mesh_size);
  const auto nearer = [&](const auto& a, const auto& b) {
    return (mesh.rest[size_t(a.first)] - start).squaredNorm() <
           (mesh.rest[size_t(b.first)] - start).squaredNorm();
  };
  const int first = std::min_element(next.begin(), next.end(), nearer)->first;
  std::vector<int> edge{first};
  for (int n = next.at(first); n != first; n = next.at(n)) edge.push_back(n);
  if (edge.size() != next.size()) too_coarse("the mesh falls apart", mesh.rest[size_t(first)], mesh_size);
  return edge;
}

/// Bound of the area that a mesh of an outline with flat corners may lose: its sides cut such corners off.
double lost_area(const Mesh& mesh, const Polygon& polygon) {
  double lost = 0;
  for (size_t k = 0; k < mesh.outline.size(); ++k) {
    const Vector2d& a = mesh.rest[size_t(mesh.outline[k])];
    const Vector2d& b = mesh.rest[size_t(mesh.outline[(k + 1) % mesh.outline.size()])];
    const Vector2d middle = 0.5 * (a + b);
    lost += (b - a).norm() * (nearest_on_edges(polygon, middle) - middle).norm();
  }
  return lost;
}

void check_elements(const Mesh& mesh, const Polygon& polygon, bool all_sharp, double mesh_size) {
  double area = 0;
  for (const auto& quad : mesh.quads) {
    for (size_t c = 0; c < 4; ++c) {
      const size_t before = size_t(quad[(c + 3) % 4]), here = size_t(quad[c]),
                   after = size_t(quad[(c + 1) % 4]);
      if (here == before || here == after) continue;
      const double corner =
          0.5 * cross(mesh.rest[after] - mesh.rest[here], mesh.rest[before] - mesh.rest[here]);
      if (!(corner > kSmallestCorner * mesh_size * mesh_size))
        too_coarse("an element is too flat", mesh.rest[here], mesh_size);
    }
    const Vector2d ac = mesh.rest[size_t(quad[2])] - mesh.rest[size_t(quad[0])];
    area += 0.5 * cross(ac, mesh.rest[size_t(quad[3])] - mesh.rest[size_t(quad[1])]);
  }
  constexpr double kRoundOff = 1e-9;  // of the ply's area
  const double whole = signed_area(polygon);
  const double lost = all_sharp ? 0 : lost_area(mesh, polygon);
  if (!(std::abs(area - whole) <= lost + kRoundOff * whole))
    too_coarse("the outline is missed", polygon.front(), mesh_size);
}

/// Stable step for fibre stiffness alone, over that of a grid of squares as large as the mesh size, by
/// sums of absolute rows over the mass: good enough to compare meshes, whatever bound the run uses.
double step_share(const Mesh& mesh, double mesh_size) {
  std::vector<double> rows(mesh.rest.size(), 0.0);
  for (const auto& quad : mesh.quads) {
    const Vector2d ac = mesh.rest[size_t(quad[2])] - mesh.rest[size_t(quad[0])];
    const Vector2d bd = mesh.rest[size_t(quad[3])] - mesh.rest[size_t(quad[1])];
    const double area = 0.5 * cross(ac, bd);
    const Vector2d even = bd.cwiseAbs() / (2 * area), odd = ac.cwiseAbs() / (2 * area);
    for (size_t c = 0; c < 4; ++c) {
      const Vector2d& own = c % 2 == 0 ? even : odd;
      rows[size_t(quad[c])] += area * own.cwiseProduct(2 * (even + odd)).maxCoeff();
    }
  }
  const std::vector<double> areas = nodal_areas(mesh);
  double largest = 0;
  for (size_t n = 0; n < rows.size(); ++n) largest = std::max(largest, rows[n] / areas[n]);
  constexpr double kSquares = 4;  // rows over area of the grid, times the square of the mesh size
  return std::sqrt(kSquares / largest) / mesh_size;
}

/// The method, on one grid.
Mesh fitted_mesh(const Polygon& polygon, const std::vector<size_t>& corners, double mesh_size,
                 double outwards, const std::array<std::vector<double>, 2>& lines) {
  OutlineGrid grid(polygon, mesh_size, outwards, lines[0], lines[1]);
  grid.meet_corners(corners);
  grid.meet_edges();
  Mesh mesh = grid.kept_cells();
  mesh.outline = edge_of(mesh, polygon.front(), mesh_size);
  check_elements(mesh, polygon, corners.size() == polygon.size(), mesh_size);
  return mesh;
}

}  // namespace

Mesh outline_mesh(const Polygon& outline, double mesh_size, const std::vector<double>& u,
                  const std::vector<double>& v) {
  if (outline.size() < 3 || crossing_edges(outline) || !(mesh_size > 0))
    throw WrongInput("outline_mesh: needs a simple polygon and a positive mesh size");
  const Polygon polygon = counter_clockwise(outline);
  const Eigen::AlignedBox2d box = bounding_box(polygon);
  const std::vector<size_t> corners = sharp_corners(polygon);
  const auto lines = [&](bool through_corners, Eigen::Index axis) {
    const std::vector<double>& places = axis == 0 ? u : v;
    const double lower = box.min()[axis], upper = box.max()[axis];
    std::vector<double> all{lower};
    const auto inner =
        through_corners ? with_corners(places, polygon, corners, axis, lower, upper, mesh_size) : places;
    all.insert(all.end(), inner.begin(), inner.end());
    all.push_back(upper);
    return all;
  };
  const double square = common_cell(polygon, mesh_size, lines(true, 0), lines(true, 1));
  std::optional<Mesh> best;
  std::optional<WrongInput> fault;
  double largest = 0;
  for (const bool through_corners : {true, false}) {
    if (best && square > 0) break;
    const double cell = through_corners && square > 0 ? square * (1 + kOnOutline) : mesh_size;
    std::array<std::vector<double>, 2> grid_lines;
    for (const Eigen::Index axis : {0, 1}) {
      const std::vector<double> all = lines(through_corners, axis);
      grid_lines[size_t(axis)] = mesh_lines(all.front(), all.back(), cell, {all.begin() + 1, all.end() - 1});
    }
    for (const double outwards : kOutwards) {
      try {
        Mesh mesh = fitted_mesh(polygon, corners, mesh_size, outwards, grid_lines);
        const double share = step_share(mesh, mesh_size);
        if (!(share > kSmallestStep)) too_coarse("a sliver sets the time step", polygon.front(), mesh_size);
        if (share <= largest) continue;
        largest = share;
        best = std::move(mesh);
      } catch (const WrongInput& error) {
        if (!fault) fault = error;
      }
    }
  }
  if (!best) throw WrongInput(fault->what());
  return std::move(*best);
}

}  // namespace drapeplan
