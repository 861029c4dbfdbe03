#include "planner/score/scoring.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "mapping/polyline.hpp"

namespace drapeplan {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// A mold flatter than a radius of 10 m hides no gap of interest: 0.1 mm below a chord of 100 mm.
constexpr double kHollowCurvature = 0.1;  // [1/m]
/// A fibre counts as taut above this strain: some N/m in carbon fabric, what a span of 100 mm needs to carry
/// its own weight at 1 mm of sag.
constexpr double kTautStrain = 1e-5;  // [-]
/// The bridging strain where the mold has no hollow: that of a fibre which is far from taut.
constexpr double kNoHollow = -0.01;  // [-]
/// The distance from a polyline changes by at most 1 m per m along the other one, so this bounds the error of
/// the largest offset by half of it.
constexpr double kEdgeSample = 0.0005;  // [m]
/// Reference of the wrinkled area: this share of the ply's area.
constexpr double kWrinkledShare = 0.01;  // [-]
constexpr double kLagUnit = 0.001;       // [m], of the weight of lag above its tolerance
constexpr double kDegrees = 180 / std::numbers::pi;

/// Means over the elements around each node.
struct NodalFibres {
  std::vector<Eigen::Vector2d> warp, weft;  ///< sums of the deformed directions, seen from above; any length
  std::vector<double> warp_strain, weft_strain;  ///< means [-]
};

NodalFibres nodal_fibres(const Mesh& mesh, const Snapshot& end) {
  const size_t n = mesh.rest.size();
  NodalFibres fibres{std::vector<Eigen::Vector2d>(n, {0, 0}), std::vector<Eigen::Vector2d>(n, {0, 0}),
                     std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  std::vector<int> around(n, 0);
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    // The mean deformation gradient of the element, from its diagonals: F maps u, v of the rest shape to x,
    // y.
    const auto& quad = mesh.quads[e];
    Eigen::Matrix2d rest, now;
    for (int d = 0; d < 2; ++d) {
      const size_t from = size_t(quad[size_t(d)]), to = size_t(quad[size_t(d) + 2]);
      rest.col(d) = mesh.rest[to] - mesh.rest[from];
      now.col(d) = (end.position[to] - end.position[from]).head<2>();
    }
    const Eigen::Matrix2d gradient = now * rest.inverse();
    for (const int corner : quad) {
      const size_t node = size_t(corner);
      fibres.warp[node] += gradient.col(0);
      fibres.weft[node] += gradient.col(1);
      fibres.warp_strain[node] += end.warp_strain[e];
      fibres.weft_strain[node] += end.weft_strain[e];
      ++around[node];
    }
  }
  for (size_t node = 0; node < n; ++node) {
    if (around[node] == 0) continue;
    fibres.warp_strain[node] /= around[node];
    fibres.weft_strain[node] /= around[node];
  }
  return fibres;
}

struct OneWay {
  double max = 0, rms = 0;
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
};

/// Calls visit(from, to, weight) at places along `line`: each with its nearest place on `other` and the
/// length that it stands for by the trapezoidal rule.
template <class Visit>
void sample_distances(const Points& line, const Points& other, const Visit& visit) {
  for (size_t k = 1; k < line.size(); ++k) {
    const double segment = (line[k] - line[k - 1]).norm();
    const int parts = std::max(1, int(std::ceil(segment / kEdgeSample)));
    for (int part = 0; part <= parts; ++part) {
      const Eigen::Vector3d from = line[k - 1] + (line[k] - line[k - 1]) * (double(part) / parts);
      const double share = part == 0 || part == parts ? 0.5 : 1.0;
      visit(from, nearest_on_polyline(from, other).place, share * segment / parts);
    }
  }
}

/// Distance of `line` from `other`.
OneWay one_way(const Points& line, const Points& other) {
  OneWay result{-1, 0, {0, 0, 0}, {0, 0, 0}};
  double length = 0, integral = 0;
  sample_distances(line, other, [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight) {
    const double distance = (to - from).norm();
    if (distance > result.max) result = {distance, 0, from, to};
    integral += distance * distance * weight;
    length += weight;
  });
  result.rms = length > 0 ? std::sqrt(integral / length) : 0;
  return result;
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Largest value times sign, at least 0.
double largest(const std::vector<double>& values, double sign) {
  double most = 0;
  for (const double value : values) most = std::max(most, sign * value);
  return most;
}

void check_sizes(const Mesh& mesh, const Snapshot& end, const Points& boundary) {
  const size_t nodes = mesh.rest.size(), elements = mesh.quads.size();
  if (end.position.size() != nodes || end.director.size() != nodes || end.shear.size() != elements ||
      end.warp_strain.size() != elements || end.weft_strain.size() != elements) {
    throw std::invalid_argument(
        fmt::format("score_drape: the snapshot has {} nodes and {} elements, the mesh {} and {}",
                    end.position.size(), end.shear.size(), nodes, elements));
  }
  if (elements == 0 || mesh.outline.size() < 3 || boundary.size() < 2) {
    throw std::invalid_argument("score_drape: the ply or the prescribed boundary is empty");
  }
}

/// What is not finite, if anything: "position of node 12".
std::optional<std::string> not_finite(const Snapshot& end, const RunExtremes& run, const Points& boundary) {
  const auto bad_point = [](const Points& points) {
    return std::find_if(points.begin(), points.end(), [](const auto& p) { return !p.allFinite(); }) -
           points.begin();
  };
  const auto bad_number = [](const std::vector<double>& values) {
    return std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }) -
           values.begin();
  };
  const auto name = [](const char* what, auto place) { return fmt::format("{} {}", what, place); };
  if (const auto k = bad_point(end.position); size_t(k) < end.position.size())
    return name("position of node", k);
  if (const auto k = bad_point(end.director); size_t(k) < end.director.size())
    return name("director of node", k);
  if (const auto k = bad_point(boundary); size_t(k) < boundary.size())
    return name("prescribed boundary, point", k);
  if (const auto k = bad_number(end.shear); size_t(k) < end.shear.size()) return name("shear of element", k);
  if (const auto k = bad_number(end.warp_strain); size_t(k) < end.warp_strain.size()) {
    return name("warp strain of element", k);
  }
  if (const auto k = bad_number(end.weft_strain); size_t(k) < end.weft_strain.size()) {
    return name("weft strain of element", k);
  }
  if (!std::isfinite(run.max_actuator_force)) return "actuator force";
  if (!std::isfinite(run.max_lag + run.saturated)) return "lag of a joint";
  if (!std::isfinite(run.max_fibre_strain + run.max_fibre_compression)) return "fibre strain of the run";
  if (!std::isfinite(run.duration)) return "duration";
  return std::nullopt;
}

/// Gap parts of the score; false where the mold is not defined below a node (`node` says which).
bool score_gap(const Mesh& mesh, const Snapshot& end, const Mold& mold, double thickness,
               const ScoreOptions& options, Score& score, size_t& node) {
  const std::vector<double> gaps = nodal_gaps(end, mold, thickness);
  const std::vector<double> areas = nodal_areas(mesh);
  const std::vector<bool> bridges = bridging(mesh, end, mold);
  double area = 0, integral = 0;
  for (node = 0; node < gaps.size(); ++node) {
    if (!std::isfinite(gaps[node])) return false;
    score.max_gap = std::max(score.max_gap, gaps[node]);
    integral += areas[node] * gaps[node] * gaps[node];
    area += areas[node];
    if (gaps[node] > options.wrinkle_threshold && !bridges[node]) score.wrinkled_area += areas[node];
  }
  score.rms_gap = std::sqrt(integral / area);
  return true;
}

}  // namespace

double signed_gap(const Eigen::Vector3d& place, const Mold& mold, double thickness) {
  const ClosestPoint closest = mold.closest(place);
  const bool good = closest.converged && std::isfinite(closest.signed_distance);
  return (good ? closest.signed_distance : place.z() - mold.height(place.x(), place.y())) - 0.5 * thickness;
}

std::vector<double> signed_gaps(const Snapshot& end, const Mold& mold, double thickness) {
  std::vector<double> gaps;
  gaps.reserve(end.position.size());
  for (const Eigen::Vector3d& place : end.position) gaps.push_back(signed_gap(place, mold, thickness));
  return gaps;
}

std::vector<double> nodal_gaps(const Snapshot& end, const Mold& mold, double thickness) {
  std::vector<double> gaps = signed_gaps(end, mold, thickness);
  for (double& gap : gaps) gap = gap > 0 || std::isnan(gap) ? gap : 0.0;
  return gaps;
}

std::vector<double> bridging_strain(const Mesh& mesh, const Snapshot& end, const Mold& mold) {
  const NodalFibres fibres = nodal_fibres(mesh, end);
  std::vector<double> result(mesh.rest.size(), kNoHollow);
  for (size_t node = 0; node < result.size(); ++node) {
    const Eigen::Vector3d foot = mold.closest(end.position[node]).foot;
    const auto consider = [&](const Eigen::Vector2d& direction, double strain) {
      const bool hollow = mold.normal_curvature(foot.x(), foot.y(), direction) > kHollowCurvature;
      if (hollow) result[node] = std::max(result[node], strain - kTautStrain);
    };
    consider(fibres.warp[node], fibres.warp_strain[node]);
    consider(fibres.weft[node], fibres.weft_strain[node]);
  }
  return result;
}

std::vector<bool> bridging(const Mesh& mesh, const Snapshot& end, const Mold& mold) {
  std::vector<bool> result;
  for (const double strain : bridging_strain(mesh, end, mold)) result.push_back(strain > 0);
  return result;
}

BoundaryOffset boundary_offset(const std::vector<Eigen::Vector3d>& edge,
                               const std::vector<Eigen::Vector3d>& boundary) {
  const OneWay out = one_way(edge, boundary);
  const OneWay back = one_way(boundary, edge);
  if (out.max >= back.max) return {out.max, out.rms, out.from, out.to};
  return {back.max, out.rms, back.to, back.from};
}

double share_beyond(const std::vector<Eigen::Vector3d>& edge, const std::vector<Eigen::Vector3d>& boundary,
                    double limit) {
  double length = 0, beyond = 0;
  sample_distances(edge, boundary,
                   [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight) {
                     if ((to - from).norm() > limit) beyond += weight;
                     length += weight;
                   });
  return length > 0 ? beyond / length : 0;
}

std::vector<Eigen::Vector3d> ply_edge(const Mesh& mesh, const Snapshot& end, double thickness) {
  std::vector<Eigen::Vector3d> edge;
  edge.reserve(mesh.outline.size() + 1);
  for (const int corner : mesh.outline) {
    const size_t node = size_t(corner);
    edge.push_back(end.position[node] - 0.5 * thickness * end.director[node]);
  }
  if (!edge.empty()) edge.push_back(edge.front());
  return edge;
}

Score score_drape(const Mesh& mesh, const Snapshot& end, const Mold& mold,
                  const std::vector<Eigen::Vector3d>& prescribed_boundary, double thickness,
                  const ScoreOptions& options, const RunExtremes& run) {
  check_sizes(mesh, end, prescribed_boundary);
  if (const auto bad = not_finite(end, run, prescribed_boundary)) return failed_score("not finite: " + *bad);
  Score score;
  size_t node = 0;
  if (!score_gap(mesh, end, mold, thickness, options, score, node)) {
    return failed_score(fmt::format("the mold is not defined below node {}", node));
  }
  const BoundaryOffset offset = boundary_offset(ply_edge(mesh, end, thickness), prescribed_boundary);
  score.max_boundary_offset = offset.max;
  score.rms_boundary_offset = offset.rms;
  score.max_shear_deg = largest_magnitude(end.shear) * kDegrees;
  score.max_fibre_strain =
      std::max({run.max_fibre_strain, largest(end.warp_strain, 1), largest(end.weft_strain, 1)});
  score.max_fibre_compression =
      std::max({run.max_fibre_compression, largest(end.warp_strain, -1), largest(end.weft_strain, -1)});
  score.max_actuator_force = run.max_actuator_force;
  score.max_lag = run.max_lag;
  score.saturated = run.saturated;
  score.followed = run.max_lag <= options.lag_tolerance;
  score.duration = run.duration;
  const std::vector<double> areas = nodal_areas(mesh);
  score.objective = objective(score, options, std::accumulate(areas.begin(), areas.end(), 0.0));
  const double parts =
      score.max_gap + score.rms_gap + score.max_boundary_offset + score.rms_boundary_offset + score.objective;
  if (!std::isfinite(parts)) return failed_score("the ply is too far away: its score is not finite");
  score.valid = true;
  return score;
}

Score failed_score(const std::string& reason) {
  Score score;
  score.objective = kFailedObjective;
  score.valid = false;
  score.reason = reason;
  return score;
}

double objective(const Score& score, const ScoreOptions& options, double ply_area) {
  const auto excess = [](double value, double limit) { return std::max(0.0, value - limit); };
  const double sum =
      options.weight_max_gap * score.max_gap / options.target_gap +
      options.weight_rms_gap * score.rms_gap / options.target_gap +
      options.weight_wrinkled_area * score.wrinkled_area / (kWrinkledShare * ply_area) +
      options.weight_max_boundary_offset * score.max_boundary_offset / options.target_boundary_offset +
      options.weight_rms_boundary_offset * score.rms_boundary_offset / options.target_boundary_offset +
      options.weight_shear * excess(score.max_shear_deg, options.locking_angle_deg) +
      options.weight_shear * excess(score.max_fibre_strain, options.strain_limit) / options.strain_limit +
      options.weight_lag * excess(score.max_lag, options.lag_tolerance) / kLagUnit +
      options.weight_duration * score.duration;
  return std::min(sum, kLargestValidObjective);
}

}  // namespace drapeplan
