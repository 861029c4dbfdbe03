#include "planner/reach/floor.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "planner/reach/floor_edge.hpp"
#include "planner/reach/floor_nlp.hpp"
#include "planner/reach/ipopt.hpp"

namespace drapeplan {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLengthTolerance = 1e-6;  // [m]: a solution that misses a constraint by more is none
constexpr double kSameGap = 2e-5;          // [m]: gaps that differ by less are the same local solution
/// Of optimality and constraints, in units of the spacing: 0.1 um at 100 mm.
constexpr double kTolerance = 1e-6;
constexpr int kMaxIterations = 400;
constexpr double kMaxCpuSeconds = 60;  // of the whole process, all threads: a guard against a hang only
constexpr double kFirstGap = 1e-3;     // [m]: of all nodes in a start; inside its bound, as Ipopt likes it
/// [spacing]: largest shift of a pad, per axis, for a random start (as in reach.cpp).
constexpr double kPerturbation = 0.15;
constexpr int kRounds = 4;                // of linearising the boundary
constexpr double kSameLimit = 2e-5;       // [m]: limits that say the same of a node to this are the same

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Why the problem cannot be posed; empty if it can.
std::string check_floor(const FloorProblem& problem) {
  const RigOptions& rig = problem.rig;
  const size_t nodes = problem.net.rest.size();
  if (rig.count() < 1 || int(problem.held.size()) != rig.count()) return "no grippers, or not those of the rig";
  if (!(rig.spacing > 0 && std::isfinite(rig.spacing))) return "the spacing is not positive";
  if (nodes == 0 || problem.mapped.size() != nodes || problem.flat.size() != nodes)
    return "the net and its mapping do not fit";
  if (problem.boundary.size() < 2) return "the prescribed boundary is empty";
  for (int k = 0; k < rig.count(); ++k) {
    if (problem.held[size_t(k)].empty()) return "gripper " + rig.name(k) + " holds no node of the net";
  }
  for (const Eigen::Vector3d& place : problem.mapped) {
    if (!problem.mold.normal(place.x(), place.y()).allFinite()) return "the mold is not defined below the mapped ply";
  }
  return "";
}

/// Nodes at the given x-y, just above the mold, with pads as near to their nodes as can be.
FloorShape shape_of(const FloorProblem& problem, const std::vector<Eigen::Vector2d>& xy) {
  FloorShape shape;
  shape.xy = xy;
  shape.gap.assign(xy.size(), kFirstGap);
  const double above = kFirstGap + 0.5 * problem.thickness;
  for (int k = 0; k < problem.rig.count(); ++k) {
    Eigen::Vector3d centre(0, 0, 0), warp(0, 0, 0), weft(0, 0, 0), normal(0, 0, 0);
    Eigen::Vector2d middle(0, 0);
    const std::vector<int>& held = problem.held[size_t(k)];
    for (const int n : held) {
      const Eigen::Vector2d& at = xy[size_t(n)];
      centre += problem.mold.point(at.x(), at.y()) + above * problem.mold.normal(at.x(), at.y());
      normal += problem.mold.normal(at.x(), at.y());
      middle += problem.net.rest[size_t(n)] - problem.rig.place(k);
    }
    centre /= double(held.size()), middle /= double(held.size());
    normal.normalize();
    for (const int n : held) {
      const Eigen::Vector2d& at = xy[size_t(n)];
      const Eigen::Vector2d offset = problem.net.rest[size_t(n)] - problem.rig.place(k) - middle;
      const Eigen::Vector3d arm = problem.mold.point(at.x(), at.y()) - centre;
      warp += offset.x() * arm, weft += offset.y() * arm;
    }
    // Of a pad that holds one node or a line of nodes: any direction along the mold.
    warp -= warp.dot(normal) * normal, weft -= weft.dot(normal) * normal;
    Eigen::Vector3d mean = warp.stableNormalized() + weft.stableNormalized().cross(normal);
    if (!(mean.norm() > 1e-3)) mean = Eigen::Vector3d::UnitX() - normal.x() * normal;
    shape.warp.push_back(mean.normalized());
    shape.weft.push_back(normal.cross(shape.warp.back()));
    shape.pad.push_back(centre - middle.x() * shape.warp.back() - middle.y() * shape.weft.back());
  }
  return shape;
}

/// The mapped net, the flat one seen from above, then mapped ones with every node shifted at random. Own
/// mapping of the generator's bits to [-1, 1): the library's distributions differ between compilers.
std::vector<FloorShape> starts(const FloorProblem& problem, const FloorOptions& options) {
  std::vector<Eigen::Vector2d> mapped;
  for (const Eigen::Vector3d& place : problem.mapped) mapped.emplace_back(place.head<2>());
  std::vector<FloorShape> all{shape_of(problem, mapped), shape_of(problem, problem.flat)};
  std::mt19937 bits(options.seed);
  const auto uniform = [&bits] { return double(bits()) / 2147483648.0 - 1; };
  if (options.random_starts == -2) all.pop_back();
  for (int k = 0; k < options.random_starts; ++k) {
    // One shift per pad, spread over the net by distance: neighbours move together.
    std::vector<Eigen::Vector2d> shift, xy = mapped;
    for (int g = 0; g < problem.rig.count(); ++g) {
      const double dx = uniform(), dy = uniform();
      shift.push_back(kPerturbation * problem.rig.spacing * Eigen::Vector2d(dx, dy));
    }
    for (size_t n = 0; n < xy.size(); ++n) {
      Eigen::Vector2d sum(0, 0);
      double total = 0;
      for (int g = 0; g < problem.rig.count(); ++g) {
        const double far = (problem.net.rest[n] - problem.rig.place(g)).norm() / problem.rig.spacing;
        const double weight = std::exp(-2 * far * far);
        sum += weight * shift[size_t(g)], total += weight;
      }
      const Eigen::Vector2d moved = xy[n] + sum / total;
      if (problem.mold.normal(moved.x(), moved.y()).allFinite()) xy[n] = moved;
    }
    all.push_back(shape_of(problem, xy));
  }
  return all;
}

struct Solved {
  FloorPoint point;
  Eigen::VectorXd variables, multipliers;
};

FloorPoint point_of(const FloorProblem& problem, const FloorNlp& nlp, const IpoptOutcome& outcome) {
  FloorPoint point;
  const Eigen::VectorXd& v = outcome.variables;
  point.violation = violation(nlp, v) * nlp.unit();
  point.converged = outcome.converged && point.violation <= kLengthTolerance;
  point.status = outcome.status;
  point.iterations = outcome.iterations;
  point.nodes = nlp.nodes_at(v);
  point.joints = nlp.joints_at(v);
  const FloorShape shape = nlp.shape_at(v);
  point.gaps = shape.gap;
  point.pads = shape.pad;
  const std::vector<double> areas = nodal_areas(problem.net);
  double area = 0, squares = 0;
  for (size_t n = 0; n < areas.size(); ++n) area += areas[n], squares += areas[n] * shape.gap[n] * shape.gap[n];
  point.gap = point.converged ? nlp.largest_gap(v) : kNaN;
  point.rms_gap = point.converged ? std::sqrt(squares / area) : kNaN;
  return point;
}

/// One tolerance from one start; the boundary's tangents are taken again until they stay.
Solved solve_from(const FloorProblem& problem, const FloorShape& start, double tolerance, double barrier) {
  const auto begin = std::chrono::steady_clock::now();
  Solved solved;
  FloorShape shape = start;
  std::vector<Eigen::Vector3d> nodes;
  int iterations = 0;
  for (int round = 0; round < kRounds; ++round) {
    if (nodes.empty()) {
      const std::vector<EdgeLimit> none;
      const FloorNlp free(problem, none);
      nodes = free.nodes_at(free.variables_at(shape));
    }
    const std::vector<EdgeLimit> limits = edge_limits(problem, nodes, tolerance);
    const FloorNlp nlp(problem, limits);
    IpoptSettings settings;
    settings.tolerance = kTolerance;
    settings.max_iterations = kMaxIterations;
    settings.max_cpu_seconds = kMaxCpuSeconds;
    settings.barrier = barrier;
    settings.push = barrier < 1e-3 ? 1e-4 : 1e-2;
    const IpoptOutcome outcome = minimise(nlp, nlp.variables_at(shape), settings);
    iterations += outcome.iterations;
    solved.point = point_of(problem, nlp, outcome);
    solved.variables = outcome.variables;
    solved.multipliers = outcome.multipliers;
    if (!solved.point.converged) break;
    nodes = solved.point.nodes;
    if (limit_change(limits, edge_limits(problem, nodes, tolerance), nodes) <= kSameLimit) break;
    shape = nlp.shape_at(outcome.variables);
  }
  solved.point.boundary_tolerance = tolerance;
  solved.point.boundary_offset = edge_offset(problem, solved.point.nodes);
  solved.point.iterations = iterations;
  solved.point.wall_seconds = seconds_since(begin);
  return solved;
}

}  // namespace

FloorFront solve_floor(const FloorProblem& problem, const FloorOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  FloorFront front;
  if (const std::string why = check_floor(problem); !why.empty()) {
    for (const double tolerance : options.tolerances) {
      FloorPoint point;
      point.boundary_tolerance = tolerance;
      point.status = why;
      point.gap = point.rms_gap = point.boundary_offset = kNaN;
      front.points.push_back(point);
    }
    return front;
  }
  const std::vector<FloorShape> from = starts(problem, options);
  for (const double tolerance : options.tolerances) {
    Solved best;
    for (const FloorShape& shape : from) {
      const Solved solved = solve_from(problem, shape, tolerance, 0.1);
      std::fprintf(stderr, "B %.1f mm: %s gap %.4f rms %.4f offset %.3f viol %.2g it %d %.2f s\n", tolerance * 1e3,
                   solved.point.status.c_str(), 1e3 * solved.point.gap, 1e3 * solved.point.rms_gap,
                   1e3 * solved.point.boundary_offset, 1e3 * solved.point.violation, solved.point.iterations,
                   solved.point.wall_seconds);
      if (best.variables.size() == 0 || !(solved.point.gap >= best.point.gap)) best = solved;
    }
    front.points.push_back(best.point);
  }
  front.wall_seconds = seconds_since(begin);
  return front;
}

}  // namespace drapeplan
