#include "mapping/net.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Geometry>

#include "mapping/cell.hpp"
#include "mapping/error.hpp"
#include "mapping/geodesic.hpp"
#include "mapping/polyline.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRoundOff = 1e-9;  // of a ply side: a shorter rest is no cell of its own
constexpr double kMostNodes = 4e6;  // a net beyond this is a typing error in the cell size

// Directions in the x-y plane of the four half lines: +warp, +weft, -warp, -weft.
using HalfLines = std::array<Eigen::Vector2d, 4>;

// Points of a line in the x-y plane.
using Track = std::vector<Eigen::Vector2d>;

[[noreturn]] void throw_at(const char* what, const Eigen::Vector3d& at) {
  throw NotFinished(fmt::format("mapping: {} (x, y) = ({:g}, {:g}) m", what, at.x(), at.y()));
}

void check(const Ply& ply, const MappingOptions& options) {
  if (ply.outline.empty() && !(std::min(ply.width, ply.height) > 0)) {
    throw WrongInput("mapping: the ply's width and height must be > 0 m");
  }
  const Eigen::AlignedBox2d box = bounding_box(corners_of(ply));
  if (!(box.sizes().minCoeff() > 0) || !box.sizes().allFinite())
    throw WrongInput("mapping: the ply has no area");
  if (!std::isfinite(ply.angle)) throw WrongInput("mapping: the ply's angle is not finite");
  if (!(options.cell_size > 0)) throw WrongInput("mapping: cell_size must be > 0 m");
  const Eigen::Vector2d cells = box.sizes() / options.cell_size;
  if (!((cells.x() + 3) * (cells.y() + 3) <= kMostNodes)) {
    throw WrongInput(
        fmt::format("mapping: cell_size {:f} m gives a net of too many nodes", options.cell_size));
  }
  const Eigen::Vector2d from_middle = (options.ply_start - box.center()).cwiseAbs();
  if (!((from_middle - (0.5 + kRoundOff) * box.sizes()).maxCoeff() <= 0)) {
    throw WrongInput("mapping: ply_start lies outside the ply");
  }
}

// Net lines across one ply direction: one exactly at `start`, equal cells on each side of it up to the edges.
struct Lines {
  std::vector<double> at;  // increasing [m]
  int start = 0;           // index of the line through the start point
};

Lines net_lines(double lower, double upper, double start, double cell_size) {
  const double side = upper - lower;
  const auto cells = [&](double length) {
    return length <= kRoundOff * side ? 0 : static_cast<int>(std::ceil(length / cell_size * (1 - kRoundOff)));
  };
  const int before = cells(start - lower), after = cells(upper - start);
  Lines lines{{}, before};
  for (int k = 0; k < before; ++k) lines.at.push_back(lower + (start - lower) * k / before);
  lines.at.push_back(start);
  for (int k = 1; k <= after; ++k)
    lines.at.push_back(k == after ? upper : start + (upper - start) * k / after);
  return lines;
}

// Of the extent's mid-sides in counter-clockwise order, the rotation of the order that follows the fibres
// best.
HalfLines mid_side_directions(const Mold& mold, const Eigen::Vector2d& start, const HalfLines& fibres) {
  const Extent& extent = mold.extent();
  const Eigen::Vector2d middle = (extent.lower + extent.upper) / 2;
  const HalfLines mid_sides = {
      Eigen::Vector2d(extent.upper.x(), middle.y()), Eigen::Vector2d(middle.x(), extent.upper.y()),
      Eigen::Vector2d(extent.lower.x(), middle.y()), Eigen::Vector2d(middle.x(), extent.lower.y())};
  const auto agreement = [&](size_t turn) {
    double sum = 0;
    for (size_t k = 0; k < 4; ++k) sum += fibres[k].dot((mid_sides[(k + turn) % 4] - start).normalized());
    return sum;
  };
  size_t best = 0;
  for (size_t turn = 1; turn < 4; ++turn) best = agreement(turn) > agreement(best) ? turn : best;
  HalfLines directions;
  for (size_t k = 0; k < 4; ++k) directions[k] = geodesic_direction(mold, start, mid_sides[(k + best) % 4]);
  return directions;
}

// Projection of what is at right angles to the left of a direction on the surface.
Eigen::Vector2d square_to(const Mold& mold, const Eigen::Vector2d& at, const Eigen::Vector2d& direction) {
  const Jet f = mold.jet(at.x(), at.y());
  const Eigen::Vector3d tangent(direction.x(), direction.y(), f.zx * direction.x() + f.zy * direction.y());
  return Eigen::Vector3d(-f.zx, -f.zy, 1).cross(tangent).head<2>();
}

// The half of a line that leaves the start towards its last point; the start alone if the line ends there. Points
// within the tolerance of the one before are left out.
Track half_of(const Track& line, const Eigen::Vector2d& start) {
  const OnPolyline<Eigen::Vector2d> at = nearest_on_polyline(start, line);
  Track half{start};
  for (size_t k = at.segment + 1; k < line.size(); ++k) {
    if ((line[k] - half.back()).norm() > kOffLine) half.push_back(line[k]);
  }
  return half;
}

// The four tracks of steered generators, in the order of HalfLines; empty where the generator is a geodesic.
std::array<Track, 4> steered_tracks(const MappingOptions& options) {
  std::array<Track, 4> tracks;
  if (options.generators != Generators::steered) return tracks;
  for (const size_t way : {size_t(0), size_t(1)}) {
    const Track& line = way == 0 ? options.warp_line : options.weft_line;
    if (line.empty()) continue;
    tracks[way] = half_of(line, options.start);
    tracks[way + 2] = half_of(Track(line.rbegin(), line.rend()), options.start);
  }
  return tracks;
}

// Where a half of a line has no length, the generator goes straight on.
HalfLines steered_directions(const Mold& mold, const MappingOptions& options) {
  const std::array<Track, 4> tracks = steered_tracks(options);
  HalfLines directions;
  directions.fill(Eigen::Vector2d::Zero());
  for (size_t k = 0; k < 4; ++k) {
    const Track &own = tracks[k], &other = tracks[(k + 2) % 4];
    if (own.size() > 1) directions[k] = (own[1] - own[0]).normalized();
    else if (other.size() > 1) directions[k] = -(other[1] - other[0]).normalized();
    else if (!own.empty()) throw WrongInput("mapping: a line of steered generators has no length");
  }
  for (const size_t k : {size_t(0), size_t(2)}) {
    if (options.weft_line.empty()) directions[k + 1] = square_to(mold, options.start, directions[k]);
  }
  for (const size_t k : {size_t(1), size_t(3)}) {
    if (options.warp_line.empty()) directions[k - 1] = -square_to(mold, options.start, directions[k]);
  }
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
  for (size_t k = 0; k < 4; ++k) {
    if (!(cross(directions[k], directions[(k + 1) % 4]) > 0))
      throw WrongInput("mapping: weft_line must cross warp_line from right to left at the start");
  }
  return directions;
}

void check_lines(const MappingOptions& options) {
  if (options.generators != Generators::steered) return;
  if (options.warp_line.empty() && options.weft_line.empty())
    throw WrongInput("mapping: steered generators need a warp_line or a weft_line");
  for (const Track* line : {&options.warp_line, &options.weft_line}) {
    if (line->empty()) continue;
    if (line->size() < 2) throw WrongInput("mapping: a line of steered generators needs two points at least");
    const double beside = (nearest_on_polyline(options.start, *line).place - options.start).norm();
    if (!(beside <= kOffLine))
      throw WrongInput(fmt::format("mapping: start lies {:g} m beside a line of steered generators", beside));
  }
}

HalfLines generator_directions(const Mold& mold, double angle, const MappingOptions& options) {
  const Eigen::Vector2d& start = options.start;
  const Eigen::Vector2d warp(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d weft(-warp.y(), warp.x());
  if (options.generators == Generators::steered) return steered_directions(mold, options);
  if (options.generators == Generators::axes) return {warp, weft, -warp, -weft};
  if (options.generators == Generators::mid_sides) {
    return mid_side_directions(mold, start, {warp, weft, -warp, -weft});
  }
  const Eigen::Vector2d square = square_to(mold, start, warp);
  return {warp, square, -warp, -square};
}

// One node further along a geodesic. The net's edges are chords, so the arc is stretched until the chord has
// the length of the flat edge: with arcs on the generators and chords elsewhere the first row of cells would
// show a shear of the order of the cell size.
Geodesic chord_step(const Mold& mold, const Eigen::Vector3d& from, const Eigen::Vector2d& direction,
                    double chord) {
  constexpr double kTolerance = 1e-15;  // round-off of places below 1 m [m]
  constexpr int kMaxIterations = 40;
  double arc = chord;
  for (int k = 0; k < kMaxIterations; ++k) {
    Geodesic line = shoot_geodesic(mold, from.head<2>(), direction, arc, 1);
    const double reached = (line.points.back() - from).norm();
    if (std::abs(reached - chord) <= kTolerance) return line;
    arc *= chord / reached;
  }
  throw_at("the mold ends, or is too curved for the cells, beyond", from);
}

// One of the four lines of nodes from the start.
struct HalfLine {
  Eigen::Vector2d direction;  // at the start, in the x-y plane
  int di = 0, dj = 0;         // to the next node
  int count = 0;              // of nodes after the start
  double chord = 0;           // between nodes [m]
  Track track = {};           // that it follows; empty: a geodesic
};

// The first so many nodes of a half line along a geodesic.
void lay_geodesic(const Mold& mold, const HalfLine& line, int count, int i0, int j0, Net& net) {
  Eigen::Vector2d heading = line.direction;
  for (int k = 1; k <= std::min(count, line.count); ++k) {
    const int i = i0 + k * line.di, j = j0 + k * line.dj;
    const Geodesic step = chord_step(mold, net.node(i - line.di, j - line.dj), heading, line.chord);
    net.nodes[size_t(i) + size_t(j) * net.u.size()] = step.points.back();
    heading = step.end_direction.head<2>();
  }
}

// The nodes of a half line along its track; where that ends, along the geodesic that goes on from it.
void lay_track(const Mold& mold, const HalfLine& line, int i0, int j0, Net& net) {
  TrackWalker walker(mold, line.track);
  for (int k = 1; k <= line.count; ++k) {
    const int i = i0 + k * line.di, j = j0 + k * line.dj;
    net.nodes[size_t(i) + size_t(j) * net.u.size()] =
        walker.next(net.node(i - line.di, j - line.dj), line.chord);
    if (!walker.ended()) continue;
    const HalfLine rest{walker.heading(), line.di, line.dj, line.count - k, line.chord};
    return lay_geodesic(mold, rest, rest.count, i, j, net);
  }
}

// True for the mirrored solution, which folds the cell over its diagonal, and for a cell sheared to a line,
// where the two solutions meet and no fabric follows.
bool is_collapsed(const Cell& cell, const Eigen::Vector3d& corner) {
  constexpr double kSmallestSine = 0.01745;  // of the angle between the fibres: 1 degree, shear of 89 degrees
  const Eigen::Vector3d normal = (cell.first - cell.base).cross(cell.second - cell.base).normalized();
  const Eigen::Vector3d a = corner - cell.second, b = corner - cell.first;
  return !(a.cross(b).dot(normal) > kSmallestSine * a.norm() * b.norm());
}

bool has_node(const Net& net, int i, int j) {
  return i >= 0 && j >= 0 && i < static_cast<int>(net.u.size()) && j < static_cast<int>(net.v.size());
}

// Places the node (i, j) as the free corner of the cell with the base (i - di, j - dj).
void place_node(const Mold& mold, int i, int j, int di, int dj, Net& net) {
  const Cell cell{net.node(i - di, j - dj), net.node(i, j - dj), net.node(i - di, j),
                  std::abs(net.u[size_t(i)] - net.u[size_t(i - di)]),
                  std::abs(net.v[size_t(j)] - net.v[size_t(j - dj)])};
  const FreeCorner corner = place_free_corner(mold, cell);
  if (!corner.point.allFinite()) throw_at("the mold ends beyond", cell.base);
  if (is_collapsed(cell, corner.point))
    throw_at("the net collapses, its shear reaches 90 degrees, beyond", cell.base);
  net.converged = net.converged && corner.converged;
  net.nodes[size_t(i) + size_t(j) * net.u.size()] = corner.point;
}

// The angle by which a step has to turn so that a squared shear is least [rad]: the lowest point of a parabola through
// three, of smaller and smaller steps.
template <class SquaredShear>
double least_shear_angle(const SquaredShear& shear_at) {
  constexpr double kFirstStep = 0.02, kLastStep = 1e-5, kFiner = 0.1;  // [rad]
  constexpr double kLongestShift = 10;                                 // steps
  double angle = 0;
  for (double step = kFirstStep; step > kLastStep; step *= kFiner) {
    const double before = shear_at(angle - step), here = shear_at(angle), after = shear_at(angle + step);
    const double bend = before - 2 * here + after;
    const double shift = bend > 0 ? 0.5 * (before - after) / bend : 0;
    angle += step * std::clamp(shift, -kLongestShift, kLongestShift);
  }
  return angle;
}

// Squared shear of the cell between the nodes (i, j) and (i + a, j + b).
double squared_shear(const Net& net, int i, int j, int a, int b) {
  return std::pow(middle_shear(net.node(i, j), net.node(i + a, j), net.node(i, j + b), net.node(i + a, j + b)), 2);
}

// Lays a half line whose cells on one side are sheared least, and with it the row on that side.
class LeastShearLine {
 public:
  // (a, b) is the step from the line to the row beside it.
  LeastShearLine(const Mold& mold, const HalfLine& line, int a, int b, Net& net)
      : mold_(mold), line_(line), a_(a), b_(b), net_(net) {}

  // Lays the node after (i, j), whose predecessor and whose neighbour in the row are there.
  void lay_after(int i, int j) {
    const Eigen::Vector3d from = net_.node(i - line_.di, j - line_.dj);
    const Eigen::Vector2d heading = (net_.node(i, j) - from).head<2>().normalized();
    place(i, j, heading, least_shear_angle([&](double angle) { return shear_at(i, j, heading, angle); }));
  }

 private:
  // Squared shear of the cell beside the step, which is laid for it.
  double shear_at(int i, int j, const Eigen::Vector2d& heading, double angle) {
    place(i, j, heading, angle);
    return squared_shear(net_, i, j, line_.di + a_, line_.dj + b_);
  }

  void place(int i, int j, const Eigen::Vector2d& heading, double angle) {
    const int di = line_.di, dj = line_.dj;
    const Geodesic step =
        chord_step(mold_, net_.node(i, j), Eigen::Rotation2Dd(angle) * heading, line_.chord);
    net_.nodes[size_t(i + di) + size_t(j + dj) * net_.u.size()] = step.points.back();
    place_node(mold_, i + di + a_, j + dj + b_, di + a_, dj + b_, net_);
  }

  const Mold& mold_;
  const HalfLine& line_;
  int a_, b_;
  Net& net_;
};

// Lays the lines through the start where they shear least: the first cell is that of the first steps forwards
// (or backwards, where the start lies at the ply's edge), the weft turned so that it is not sheared; the lines go on
// from it in all four directions.
void lay_least_shear(const Mold& mold, const std::array<HalfLine, 4>& lines, int i0, int j0, Net& net) {
  const size_t warp = lines[0].count > 0 ? 0 : 2, weft = lines[1].count > 0 ? 1 : 3;
  const int a = lines[warp].di, b = lines[weft].dj;
  lay_geodesic(mold, lines[warp], 1, i0, j0, net);
  const auto first_cell = [&](double angle) {
    HalfLine turned = lines[weft];
    turned.direction = Eigen::Rotation2Dd(angle) * turned.direction;
    lay_geodesic(mold, turned, 1, i0, j0, net);
    place_node(mold, i0 + a, j0 + b, a, b, net);
    return squared_shear(net, i0, j0, a, b);
  };
  first_cell(least_shear_angle(first_cell));
  for (size_t k = 0; k < lines.size(); ++k) {
    const HalfLine& line = lines[k];
    LeastShearLine least(mold, line, k % 2 == 0 ? 0 : a, k % 2 == 0 ? b : 0, net);
    for (int n = k == warp || k == weft ? 1 : 0; n < line.count; ++n)
      least.lay_after(i0 + n * line.di, j0 + n * line.dj);
  }
}

// Fills the quadrant that lies in the direction (di, dj) from the start node, element by element.
void fill_quadrant(const Mold& mold, int i0, int j0, int di, int dj, Net& net) {
  for (int j = j0 + dj; has_node(net, i0, j); j += dj) {
    for (int i = i0 + di; has_node(net, i, j); i += di) place_node(mold, i, j, di, dj, net);
  }
}

}  // namespace

Polygon corners_of(const Ply& ply) {
  if (!ply.outline.empty()) return counter_clockwise(ply.outline);
  const double u = ply.width / 2, v = ply.height / 2;
  return {{-u, -v}, {u, -v}, {u, v}, {-u, v}};
}

Net map_ply(const Mold& mold, const Ply& ply, const MappingOptions& options) {
  check(ply, options);
  check_lines(options);
  const Eigen::AlignedBox2d box = bounding_box(corners_of(ply));
  const Lines u = net_lines(box.min().x(), box.max().x(), options.ply_start.x(), options.cell_size);
  const Lines v = net_lines(box.min().y(), box.max().y(), options.ply_start.y(), options.cell_size);
  const size_t nu = u.at.size(), nv = v.at.size();
  Net net{u.at, v.at, std::vector<Eigen::Vector3d>(nu * nv, Eigen::Vector3d::Constant(kNaN)), true};

  const size_t start = size_t(u.start) + size_t(v.start) * nu;
  net.nodes[start] = mold.point(options.start.x(), options.start.y());
  if (!net.nodes[start].allFinite()) throw_at("no mold at the start", net.nodes[start]);

  const HalfLines directions = generator_directions(mold, ply.angle, options);
  const std::array<Track, 4> tracks = steered_tracks(options);
  std::array<HalfLine, 4> half_lines;
  for (size_t k = 0; k < 4; ++k) {
    const Lines& lines = k % 2 == 0 ? u : v;
    const int way = k < 2 ? 1 : -1, count = way > 0 ? static_cast<int>(lines.at.size()) - 1 - lines.start : lines.start;
    const double whole = std::abs((way > 0 ? lines.at.back() : lines.at.front()) - lines.at[size_t(lines.start)]);
    half_lines[k] = {directions[k], k % 2 == 0 ? way : 0,           k % 2 == 0 ? 0 : way,
                     count,         whole / std::max(count, 1), tracks[k]};
  }
  if (options.generators == Generators::minimum_shear) {
    lay_least_shear(mold, half_lines, u.start, v.start, net);
  } else {
    const auto all = static_cast<int>(net.nodes.size());
    for (const HalfLine& line : half_lines) {
      if (line.track.size() > 1)
        lay_track(mold, line, u.start, v.start, net);
      else
        lay_geodesic(mold, line, all, u.start, v.start, net);
    }
  }
  for (const int dj : {1, -1}) {
    for (const int di : {1, -1}) fill_quadrant(mold, u.start, v.start, di, dj, net);
  }
  return net;
}

}  // namespace drapeplan
