#include "planner/reach/floor.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
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
constexpr int kMaxIterations = 150;
constexpr double kMaxCpuSeconds = 60;  // of the whole process, all threads: a guard against a hang only
constexpr double kFirstGap = 1e-3;     // [m]: of all nodes in a start; inside its bound, as Ipopt likes it
/// [spacing]: largest shift of a pad, per axis, for a random start (as in reach.cpp).
constexpr double kPerturbation = 0.15;
constexpr int kRounds = 4;           // of linearising the boundary
constexpr double kSameLimit = 5e-5;  // [m]: limits that say the same of a node to this are the same
/// First barrier parameter, and how far starts are moved from their bounds, at most. Larger ones lift the
/// whole net off the mold first, from where it finds its way back slowly, or to a poor local minimum.
constexpr double kBarrier = 1e-5;
constexpr double kPush = 1e-3;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Why the problem cannot be posed; empty if it can.
std::string check_floor(const FloorProblem& problem) {
  const RigOptions& rig = problem.rig;
  const size_t nodes = problem.net.rest.size();
  if (rig.count() < 1 || int(problem.held.size()) != rig.count())
    return "no grippers, or not those of the rig";
  if (!(rig.spacing > 0 && std::isfinite(rig.spacing))) return "the spacing is not positive";
  if (nodes == 0 || problem.mapped.size() != nodes || problem.flat.size() != nodes)
    return "the net and its mapping do not fit";
  if (problem.boundary.size() < 2) return "the prescribed boundary is empty";
  for (int k = 0; k < rig.count(); ++k) {
    if (problem.held[size_t(k)].empty()) return "gripper " + rig.name(k) + " holds no node of the net";
  }
  for (const Eigen::Vector3d& place : problem.mapped) {
    if (!problem.mold.normal(place.x(), place.y()).allFinite())
      return "the mold is not defined below the mapped ply";
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

using Nodes = std::vector<Eigen::Vector3d>;

struct Solved {
  FloorPoint point;
  FloorShape shape;
};

FloorPoint point_of(const FloorProblem& problem, const FloorNlp& nlp, const IpoptOutcome& outcome) {
  FloorPoint point;
  const Eigen::VectorXd& v = outcome.variables;
  point.violation = violation(nlp, v) * nlp.unit();
  point.converged = outcome.converged && point.violation <= kLengthTolerance;
  point.status = outcome.infeasible ? "no net keeps fibres, interlinks, tilt limits and boundary at once"
                                    : outcome.status;
  point.iterations = outcome.iterations;
  point.nodes = nlp.nodes_at(v);
  point.joints = nlp.joints_at(v);
  const FloorShape shape = nlp.shape_at(v);
  point.gaps = shape.gap;
  point.pads = shape.pad;
  const std::vector<double> areas = nodal_areas(problem.net);
  double area = 0, squares = 0;
  for (size_t n = 0; n < areas.size(); ++n)
    area += areas[n], squares += areas[n] * shape.gap[n] * shape.gap[n];
  point.gap = point.converged ? nlp.largest_gap(v) : kNaN;
  if (point.converged) point.spans = taut_spans(problem, nlp.fibres(), point.nodes, outcome.multipliers);
  point.rms_gap = point.converged ? std::sqrt(squares / area) : kNaN;
  return point;
}

/// One tolerance; the boundary's tangents are taken again until they stay.
class Solver {
 public:
  Solver(const FloorProblem& problem, double tolerance) : problem_(problem), tolerance_(tolerance) {}

  /// @param nodes  where the tangents are taken first [m].
  Solved solve(const FloorShape& start, const Nodes& nodes, int rounds = kRounds) const {
    const auto begin = std::chrono::steady_clock::now();
    Solved solved;
    int iterations = 0;
    FloorShape shape = start;
    std::vector<EdgeLimit> limits = edge_limits(problem_, nodes, tolerance_);
    for (int round = 0; round < rounds; ++round) {
      const FloorNlp nlp(problem_, limits);
      const IpoptOutcome outcome = minimise(nlp, nlp.variables_at(shape), settings());
      iterations += outcome.iterations;
      solved = {point_of(problem_, nlp, outcome), nlp.shape_at(outcome.variables)};
      if (!solved.point.converged || std::isinf(tolerance_)) break;
      std::vector<EdgeLimit> next = edge_limits(problem_, solved.point.nodes, tolerance_);
      if (limit_change(limits, next, solved.point.nodes) <= kSameLimit) break;
      limits = std::move(next);
      shape = solved.shape;
    }
    solved.point.boundary_tolerance = tolerance_;
    solved.point.boundary_offset = edge_offset(problem_, solved.point.nodes);
    solved.point.iterations = iterations;
    solved.point.wall_seconds = seconds_since(begin);
    return solved;
  }

 private:
  static IpoptSettings settings() {
    IpoptSettings settings;
    settings.tolerance = kTolerance;
    settings.max_iterations = kMaxIterations;
    settings.max_cpu_seconds = kMaxCpuSeconds;
    settings.barrier = kBarrier;
    settings.push = kPush;
    settings.long_dual_steps = settings.minimum_degree = true;
    return settings;
  }

  const FloorProblem& problem_;
  double tolerance_;
};

bool better(const Solved& a, const Solved& b) {
  if (a.point.converged != b.point.converged) return a.point.converged;
  return a.point.converged ? a.point.gap < b.point.gap : a.point.violation < b.point.violation;
}

/// One tolerance from all starts; the best of them goes on. All have the same tangents at first, so their
/// gaps compare.
Solved solve_first(const FloorProblem& problem, double tolerance, const FloorOptions& options,
                   FloorFront& front) {
  const Solver solver(problem, tolerance);
  std::vector<Solved> solved;
  for (const FloorShape& start : starts(problem, options))
    solved.push_back(solver.solve(start, problem.mapped, 1));
  const Solved& best = *std::min_element(solved.begin(), solved.end(), better);
  front.starts = int(solved.size());
  for (const Solved& one : solved) {
    if (!one.point.converged) continue;
    ++front.converged;
    front.agreed += one.point.gap <= best.point.gap + kSameGap ? 1 : 0;
    front.start_spread = std::max(front.start_spread, one.point.gap - best.point.gap);
  }
  if (!best.point.converged || std::isinf(tolerance)) return best;
  const Solved last = solver.solve(best.shape, best.point.nodes);
  return last.point.converged ? last : best;
}

/// A tolerance beside one that is solved: from there; if that fails, from the mapped net.
Solved solve_next(const FloorProblem& problem, double tolerance, const Solved& neighbour,
                  const FloorShape& mapped) {
  const Solver solver(problem, tolerance);
  if (!neighbour.point.converged) return solver.solve(mapped, problem.mapped);
  Solved solved = solver.solve(neighbour.shape, neighbour.point.nodes);
  if (solved.point.converged) return solved;
  return solver.solve(mapped, problem.mapped);
}

/// What a tighter tolerance allows a looser one allows, too: where its solution is better, the looser one's
/// is a poor local minimum.
void take_tighter(const FloorPoint& tighter, FloorPoint& looser) {
  if (!tighter.converged || (looser.converged && looser.gap <= tighter.gap)) return;
  const FloorPoint own = looser;
  looser = tighter;
  looser.boundary_tolerance = own.boundary_tolerance;
  looser.iterations = own.iterations;
  looser.wall_seconds = own.wall_seconds;
  looser.status = "the net of a tighter boundary";
}

FloorPoint failed_point(double tolerance, const std::string& why) {
  FloorPoint point;
  point.boundary_tolerance = tolerance;
  point.status = why;
  point.gap = point.rms_gap = point.boundary_offset = kNaN;
  return point;
}

}  // namespace

double net_strain(const FloorProblem& problem, const std::vector<Eigen::Vector3d>& nodes) {
  double largest = -1;
  for (const Fibre& fibre : fibres_of(problem)) {
    Eigen::Vector3d along(0, 0, 0);
    for (size_t c = 0; c < size_t(fibre.count); ++c)
      along += fibre.coefficient[c] * nodes[size_t(fibre.corner[c])];
    largest = std::max(largest, along.norm() - 1);
  }
  return largest;
}

FloorFront solve_floor(const FloorProblem& problem, const FloorOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  FloorFront front;
  const std::string why = check_floor(problem);
  for (const double tolerance : options.tolerances) front.points.push_back(failed_point(tolerance, why));
  if (!why.empty()) return front;

  // All starts in the middle of the front; then each tolerance from the solution of its neighbour.
  std::vector<size_t> order(options.tolerances.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return options.tolerances[a] < options.tolerances[b]; });
  if (order.empty()) return front;
  std::vector<Solved> solved(order.size());
  const size_t middle = order.size() / 2;
  solved[middle] = solve_first(problem, options.tolerances[order[middle]], options, front);
  const FloorShape mapped = starts(problem, options).front();
  for (size_t k = middle; k-- > 0;)
    solved[k] = solve_next(problem, options.tolerances[order[k]], solved[k + 1], mapped);
  for (size_t k = middle + 1; k < order.size(); ++k)
    solved[k] = solve_next(problem, options.tolerances[order[k]], solved[k - 1], mapped);
  for (size_t k = 1; k < order.size(); ++k) take_tighter(solved[k - 1].point, solved[k].point);
  for (size_t k = 0; k < order.size(); ++k) front.points[order[k]] = std::move(solved[k].point);
  front.wall_seconds = seconds_since(begin);
  return front;
}

}  // namespace drapeplan
