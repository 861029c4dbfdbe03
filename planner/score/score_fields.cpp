#include "planner/score/score_fields.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "mapping/polyline.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr Eigen::Index kExtremes = 4;  ///< fields at the end: lag, shear, tension, duration

/// A point near a polyline's node has its foot within so many segments of it: a fold of the edge is shorter
/// than three cells, and the boundary is cut about three times as fine.
constexpr int kNearOnEdge = 3, kNearOnBoundary = 9;

/// Distance from a closed polyline (first point repeated at the end), sought around one of its nodes.
double distance_near(const Eigen::Vector3d& p, const Points& line, int node, int reach) {
  const int segments = int(line.size()) - 1;
  double smallest = std::numeric_limits<double>::infinity();
  for (int offset = -reach; offset < reach; ++offset) {
    const auto k = size_t(((node + offset) % segments + segments) % segments);
    smallest = std::min(smallest, (nearest_on_segment(p, line[k], line[k + 1]).place - p).squaredNorm());
  }
  return std::sqrt(smallest);
}

int nearest_node(const Eigen::Vector3d& p, const Points& line) {
  const auto nearest = std::min_element(line.begin(), line.end() - 1, [&](const auto& a, const auto& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  });
  return int(nearest - line.begin());
}

/// Weights of the corners at local coordinates in [-1, 1]^2.
Eigen::Vector4d bilinear(double r, double s) {
  return Eigen::Vector4d((1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)) / 4;
}

/// Newton's method for the local coordinates of a point in a quadrilateral; outside, and in a triangle (a
/// repeated node), only about right: the caller looks at how well the weights meet the point.
Eigen::Vector4d weights_in(const std::array<Eigen::Vector2d, 4>& corner, const Eigen::Vector2d& p) {
  constexpr int kIterations = 8;  // quadratic convergence from the middle: four suffice for convex cells
  Eigen::Vector2d at(0, 0);
  for (int k = 0; k < kIterations; ++k) {
    const Eigen::Vector4d w = bilinear(at[0], at[1]);
    Eigen::Vector2d miss = -p;
    for (int c = 0; c < 4; ++c) miss += w[c] * corner[size_t(c)];
    Eigen::Matrix2d slope;
    slope.col(0) = ((1 - at[1]) * (corner[1] - corner[0]) + (1 + at[1]) * (corner[2] - corner[3])) / 4;
    slope.col(1) = ((1 - at[0]) * (corner[3] - corner[0]) + (1 + at[0]) * (corner[2] - corner[1])) / 4;
    if (!(std::abs(slope.determinant()) > 0)) break;
    at = (at - slope.inverse() * miss).cwiseMax(-1).cwiseMin(1);
  }
  return bilinear(at[0], at[1]);
}

}  // namespace

ScoreFields::ScoreFields(Mesh reference, const Mold& mold, Points prescribed_boundary, double thickness,
                         const ScoreOptions& options)
    : reference_(std::move(reference)),
      mold_(mold),
      boundary_(std::move(prescribed_boundary)),
      thickness_(thickness),
      options_(options),
      areas_(nodal_areas(reference_)),
      area_(std::accumulate(areas_.begin(), areas_.end(), 0.0)) {}

Eigen::Index ScoreFields::size() const {
  return 2 * reference_.node_count() + 3 * Eigen::Index(reference_.outline.size()) + kExtremes;
}

Eigen::VectorXd ScoreFields::scale() const {
  const Eigen::Index nodes = reference_.node_count(), edge = 3 * Eigen::Index(reference_.outline.size());
  Eigen::VectorXd scale(size());
  scale << Eigen::VectorXd::Constant(nodes, options_.target_gap), Eigen::VectorXd::Constant(nodes, 1e-3),
      Eigen::VectorXd::Constant(edge, options_.target_boundary_offset),
      Eigen::Vector4d(options_.target_gap, 1, 1e-3, 1);
  return scale;
}

ScoreFields::Sampling ScoreFields::sampling(const Mesh& mesh) const {
  Sampling sampling;
  for (const Eigen::Vector2d& rest : reference_.rest) {
    double smallest = std::numeric_limits<double>::infinity();
    std::pair<std::array<int, 4>, Eigen::Vector4d> best;
    for (const std::array<int, 4>& quad : mesh.quads) {
      std::array<Eigen::Vector2d, 4> corner;
      for (size_t c = 0; c < 4; ++c) corner[c] = mesh.rest[size_t(quad[c])];
      const double size2 = (corner[2] - corner[0]).squaredNorm();
      if ((corner[0] - rest).squaredNorm() > 4 * size2) continue;
      const Eigen::Vector4d weights = weights_in(corner, rest);
      Eigen::Vector2d miss = -rest;
      for (int c = 0; c < 4; ++c) miss += weights[c] * corner[size_t(c)];
      if (miss.squaredNorm() < smallest) smallest = miss.squaredNorm(), best = {quad, weights};
    }
    sampling.push_back(best);
  }
  return sampling;
}

std::vector<float> ScoreFields::measure(const Mesh& mesh, const Sampling& sampling, const Snapshot& end,
                                        const Score& score) const {
  const std::vector<double> gaps = signed_gaps(end, mold_, thickness_);
  const std::vector<double> strains = bridging_strain(mesh, end, mold_);
  std::vector<float> fields;
  fields.reserve(size_t(size()));
  for (const std::vector<double>* field : {&gaps, &strains}) {
    for (const auto& [node, weight] : sampling) {
      double value = 0;
      for (int c = 0; c < 4; ++c) value += weight[c] * (*field)[size_t(node[size_t(c)])];
      fields.push_back(float(value));
    }
  }
  for (const int corner : reference_.outline) {
    const auto& [node, weight] = sampling[size_t(corner)];
    Eigen::Vector3d place(0, 0, 0);
    for (int c = 0; c < 4; ++c) {
      const auto n = size_t(node[size_t(c)]);
      place += weight[c] * (end.position[n] - 0.5 * thickness_ * end.director[n]);
    }
    for (const double x : place) fields.push_back(float(x));
  }
  for (const double extreme : {score.max_lag, score.max_shear_deg, score.max_fibre_strain, score.duration})
    fields.push_back(float(extreme));
  return fields;
}

Points ScoreFields::edge_of(const Eigen::VectorXd& fields) const {
  Points edge;
  for (size_t k = 0; k < reference_.outline.size(); ++k)
    edge.emplace_back(fields.segment<3>(2 * reference_.node_count() + 3 * Eigen::Index(k)));
  edge.push_back(edge.front());
  return edge;
}

ScoreFields::Neighbours ScoreFields::neighbours(const Points& edge) const {
  Neighbours near;
  for (const Eigen::Vector3d& p : edge) near.on_boundary.push_back(nearest_node(p, boundary_));
  for (const Eigen::Vector3d& p : boundary_) near.on_edge.push_back(nearest_node(p, edge));
  return near;
}

double ScoreFields::objective(const Eigen::VectorXd& fields) const {
  return objective(fields, neighbours(edge_of(fields)));
}

std::function<double(const Eigen::VectorXd&)> ScoreFields::objective_near(
    const Eigen::VectorXd& fields) const {
  return [this, near = neighbours(edge_of(fields))](const Eigen::VectorXd& other) {
    return objective(other, near);
  };
}

double ScoreFields::objective(const Eigen::VectorXd& fields, const Neighbours& near) const {
  const Eigen::Index nodes = reference_.node_count();
  Score score;
  double integral = 0;
  for (Eigen::Index n = 0; n < nodes; ++n) {
    const double gap = std::max(fields[n], 0.0), area = areas_[size_t(n)];
    const bool bridges = fields[nodes + n] > 0;
    score.max_gap = std::max(score.max_gap, gap);
    integral += area * gap * gap;
    if (gap > options_.wrinkle_threshold && !bridges) score.wrinkled_area += area;
  }
  score.rms_gap = std::sqrt(integral / area_);
  const Points edge = edge_of(fields);
  double length = 0, squares = 0, last = 0;
  for (size_t k = 0; k < edge.size(); ++k) {
    const double offset = distance_near(edge[k], boundary_, near.on_boundary[k], kNearOnBoundary);
    score.max_boundary_offset = std::max(score.max_boundary_offset, offset);
    if (k > 0) {
      const double segment = (edge[k] - edge[k - 1]).norm();
      squares += segment * 0.5 * (offset * offset + last * last);
      length += segment;
    }
    last = offset;
  }
  score.rms_boundary_offset = length > 0 ? std::sqrt(squares / length) : 0;
  for (size_t k = 0; k < boundary_.size(); ++k) {
    score.max_boundary_offset =
        std::max(score.max_boundary_offset, distance_near(boundary_[k], edge, near.on_edge[k], kNearOnEdge));
  }
  const auto extremes = fields.tail<kExtremes>();
  score.max_lag = extremes[0];
  score.max_shear_deg = extremes[1];
  score.max_fibre_strain = extremes[2];
  score.duration = extremes[3];
  return drapeplan::objective(score, options_, area_);
}

}  // namespace drapeplan
