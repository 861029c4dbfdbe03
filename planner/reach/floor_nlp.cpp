#include "planner/reach/floor_nlp.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "planner/reach/nlp.hpp"

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAligned = 1e-9;  // [m]: ends of a fibre differ by less across it

std::vector<int> pad_of_nodes(const FloorProblem& problem) {
  std::vector<int> pad(problem.net.rest.size(), -1);
  for (size_t k = 0; k < problem.held.size(); ++k) {
    for (const int node : problem.held[k]) pad[size_t(node)] = int(k);
  }
  return pad;
}

}  // namespace

/// With the foot P(x, y) and the normal n: d(distance) = n . dX, and dX = (P,a + w n,a) dxy^a + n dw.
DistanceJet distance_jet(const Mold& mold, const Eigen::Vector3d& place, double unit) {
  const ClosestPoint closest = mold.closest(place * unit);
  if (!closest.converged) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return {kNaN, Eigen::Vector3d::Constant(kNaN), Eigen::Matrix3d::Constant(kNaN)};
  }
  const double distance = closest.signed_distance / unit;
  const GripperJet jet = gripper_jet(mold, closest.foot.head<2>() / unit, distance, unit);
  Eigen::Matrix<double, 3, 2> tangent, moved, turned;
  tangent << jet.pad.x, jet.pad.y;
  moved << jet.joint.x, jet.joint.y;
  turned << jet.normal.x, jet.normal.y;
  const Eigen::Matrix2d metric = tangent.transpose() * moved;
  return {distance, closest.normal, turned * metric.inverse() * tangent.transpose()};
}

std::vector<Fibre> fibres_of(const FloorProblem& problem) {
  const std::vector<int> pad = pad_of_nodes(problem);
  const std::vector<Eigen::Vector2d>& rest = problem.net.rest;
  std::vector<bool> outline(rest.size(), false);
  for (const int node : problem.net.outline) outline[size_t(node)] = true;
  std::map<std::array<int, 2>, int> edges;  // and how many cells they have
  std::vector<Fibre> fibres;
  for (const auto& quad : problem.net.quads) {
    bool rigid = true, middle = false;
    for (size_t c = 0; c < 4; ++c) {
      const int i = quad[c], j = quad[(c + 1) % 4];
      rigid = rigid && pad[size_t(i)] >= 0 && pad[size_t(i)] == pad[size_t(quad[0])];
      middle = middle || outline[size_t(i)] || i == j;
      if (i != j) ++edges[{std::min(i, j), std::max(i, j)}];
    }
    if (rigid || !middle) continue;
    // The mean deformation gradient maps both flat diagonals to the deformed ones.
    Eigen::Matrix2d flat;
    for (size_t d = 0; d < 2; ++d) flat.col(int(d)) = rest[size_t(quad[d + 2])] - rest[size_t(quad[d])];
    const Eigen::Matrix2d inverse = flat.inverse();
    for (const int weft : {0, 1}) {
      const double first = inverse(0, weft), second = inverse(1, weft);
      const double length = 1 / (std::abs(first) + std::abs(second));  // of a rectangle: its side
      fibres.push_back({4, quad, {-first, -second, first, second}, weft == 1, length});
    }
  }
  for (const auto& [ends, cells] : edges) {
    const auto i = size_t(ends[0]), j = size_t(ends[1]);
    const Eigen::Vector2d way = rest[j] - rest[i];
    const bool warp = std::abs(way.y()) <= kAligned, weft = std::abs(way.x()) <= kAligned;
    const bool same_pad = pad[i] >= 0 && pad[i] == pad[j];
    if (cells < 2 || warp == weft || same_pad) continue;
    const double length = way.norm();
    fibres.push_back({2, {ends[0], ends[1], -1, -1}, {-1 / length, 1 / length, 0, 0}, weft, length});
  }
  return fibres;
}

FloorNlp::FloorNlp(const FloorProblem& problem, const std::vector<EdgeLimit>& limits)
    : problem_(&problem),
      limits_(&limits),
      unit_(problem.rig.spacing),
      half_(0.5 * problem.thickness / problem.rig.spacing),
      fibres_(fibres_of(problem)),
      pad_(pad_of_nodes(problem)),
      nodes_(problem.net.node_count()),
      pads_(problem.rig.count()),
      tilt_limited_(problem.rig.tilt_limit < std::numbers::pi / 2) {
  if (problem.rig.interlinks && !problem.rig.interlinks->stiffness) links_ = interlinks(problem.rig);
  for (int n = 0; n < nodes_; ++n) {
    first_.push_back(variables_);
    variables_ += is_held(n) ? 1 : 3;
    held_ += is_held(n) ? 1 : 0;
  }
  first_pad_ = variables_;
  level_ = first_pad_ + 12 * pads_;
  variables_ = level_ + 1;
  row_.level = int(fibres_.size());
  row_.gap = row_.level + nodes_;
  row_.frame = row_.gap + held_;
  row_.joint = row_.frame + 3 * pads_;
  row_.tilt = row_.joint + 3 * pads_;
  row_.link = row_.tilt + (tilt_limited_ ? pads_ : 0);
  row_.limit = row_.link + int(links_.size());
  row_.count = row_.limit + int(limits.size());

  build_patterns();
}

// ---- shapes

Eigen::VectorXd FloorNlp::variables_at(const FloorShape& shape) const {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(variables_);
  for (int n = 0; n < nodes_; ++n) {
    if (!is_held(n)) v.segment<2>(first_[size_t(n)]) = shape.xy[size_t(n)] / unit_;
    v[gap_of(n)] = shape.gap[size_t(n)] / unit_;
    v[level_] = std::max(v[level_], v[gap_of(n)]);
  }
  for (int k = 0; k < pads_; ++k) {
    const size_t pad = size_t(k);
    const Eigen::Vector3d arm = problem_->rig.joint_offset * shape.warp[pad].cross(shape.weft[pad]);
    v.segment<12>(pad_at(k)) << shape.pad[pad] / unit_, shape.warp[pad], shape.weft[pad],
        (shape.pad[pad] + arm) / unit_;
  }
  return v;
}

FloorShape FloorNlp::shape_at(const VectorRef& v) const {
  FloorShape shape;
  for (int n = 0; n < nodes_; ++n) {
    const Eigen::Vector2d xy = is_held(n) ? problem_->mold.closest(held_place(v, n) * unit_).foot.head<2>()
                                          : Eigen::Vector2d(v.segment<2>(first_[size_t(n)]) * unit_);
    shape.xy.push_back(xy);
    shape.gap.push_back(v[gap_of(n)] * unit_);
  }
  for (int k = 0; k < pads_; ++k) {
    shape.pad.emplace_back(v.segment<3>(pad_at(k)) * unit_);
    shape.warp.emplace_back(v.segment<3>(pad_at(k) + 3));
    shape.weft.emplace_back(v.segment<3>(pad_at(k) + 6));
  }
  return shape;
}

std::vector<Eigen::Vector3d> FloorNlp::nodes_at(const VectorRef& v) const {
  std::vector<Eigen::Vector3d> places;
  for (const NodeJet& jet : jets(v)) places.push_back(jet.value * unit_);
  return places;
}

std::vector<Eigen::Vector3d> FloorNlp::joints_at(const VectorRef& v) const {
  std::vector<Eigen::Vector3d> joints;
  for (int k = 0; k < pads_; ++k) joints.emplace_back(v.segment<3>(pad_at(k) + 9) * unit_);
  return joints;
}

Eigen::Vector3d FloorNlp::fibre(const Fibre& of, const std::vector<NodeJet>& all) const {
  Eigen::Vector3d sum(0, 0, 0);
  for (size_t c = 0; c < size_t(of.count); ++c)
    sum += of.coefficient[c] * unit_ * all[size_t(of.corner[c])].value;
  return sum;
}

Eigen::Vector3d FloorNlp::weights(int node) const {
  const Eigen::Vector2d offset =
      (problem_->net.rest[size_t(node)] - problem_->rig.place(pad_[size_t(node)])) / unit_;
  return {1, offset.x(), offset.y()};
}

Eigen::Vector3d FloorNlp::held_place(const VectorRef& v, int node) const {
  const int at = pad_at(pad_[size_t(node)]);
  const Eigen::Vector3d w = weights(node);
  return v.segment<3>(at) + w[1] * v.segment<3>(at + 3) + w[2] * v.segment<3>(at + 6);
}

std::vector<FloorNlp::NodeJet> FloorNlp::jets(const VectorRef& v) const {
  std::vector<NodeJet> all(static_cast<size_t>(nodes_));
  for (int n = 0; n < nodes_; ++n) {
    NodeJet& jet = all[size_t(n)];
    if (is_held(n)) {
      jet.value = held_place(v, n);
      continue;
    }
    const Eigen::Vector3d at = v.segment<3>(first_[size_t(n)]);
    const GripperJet mold = gripper_jet(problem_->mold, at.head<2>(), at.z() + half_, unit_);
    jet.value = mold.joint.value;
    jet.first << mold.joint.x, mold.joint.y, mold.normal.value;
    jet.second = {mold.joint.xx, mold.joint.xy, mold.joint.yy,
                  mold.normal.x, mold.normal.y, Eigen::Vector3d::Zero()};
  }
  return all;
}

// ---- the program

SmoothProgram::Form FloorNlp::form() const {
  Bounds x{Eigen::VectorXd::Constant(variables_, -kInfinity),
           Eigen::VectorXd::Constant(variables_, kInfinity)};
  Eigen::Vector2d lower = problem_->mold.extent().lower, upper = problem_->mold.extent().upper;
  for (const Eigen::Vector3d& place : problem_->mapped) {
    lower = lower.cwiseMin(place.head<2>());
    upper = upper.cwiseMax(place.head<2>());
  }
  for (int n = 0; n < nodes_; ++n) {
    x.lower[gap_of(n)] = 0;
    if (is_held(n)) continue;
    x.lower.segment<2>(first_[size_t(n)]) = lower / unit_;
    x.upper.segment<2>(first_[size_t(n)]) = upper / unit_;
  }
  if (problem_->rig.fixed) {
    const int joint = pad_at(problem_->rig.gripper_at(*problem_->rig.fixed)) + 9;
    x.lower.segment<2>(joint) = x.upper.segment<2>(joint) = problem_->fixed_place / unit_;
  }
  x.lower[level_] = 0;

  Bounds c{Eigen::VectorXd::Zero(row_.count), Eigen::VectorXd::Zero(row_.count)};
  c.lower.head(row_.gap).setConstant(-kInfinity);
  const double stretch = 1 + problem_->fibre_strain;
  for (size_t k = 0; k < fibres_.size(); ++k)
    c.upper[int(k)] = 0.5 * stretch * stretch * fibres_[k].length / unit_;
  for (int k = 0; k < pads_; ++k) {
    const Eigen::Vector3d ones(0.5, 0.5, 0);  // halves of the squared lengths of a and b, and a . b
    c.lower.segment<3>(row_.frame + 3 * k) = c.upper.segment<3>(row_.frame + 3 * k) = ones;
    if (!tilt_limited_) continue;
    c.lower[row_.tilt + k] = std::cos(problem_->rig.tilt_limit);
    c.upper[row_.tilt + k] = kInfinity;
  }
  for (size_t k = 0; k < links_.size(); ++k) {
    const double length = interlink_length(problem_->rig, k) / unit_;
    const Eigen::Vector2d play = problem_->rig.interlinks->play / unit_;
    c.lower[row_.link + int(k)] = 0.5 * std::pow(std::max(0.0, length - play[0]), 2);
    c.upper[row_.link + int(k)] = 0.5 * std::pow(length + play[1], 2);
  }
  for (size_t k = 0; k < limits_->size(); ++k) {
    c.lower[row_.limit + int(k)] = (*limits_)[k].lower / unit_;
    c.upper[row_.limit + int(k)] = (*limits_)[k].upper / unit_;
  }
  return {x, c, jacobian_pattern_, hessian_pattern_};
}

double FloorNlp::objective(const VectorRef& v, Eigen::VectorXd* gradient) const {
  if (gradient != nullptr) *gradient = Eigen::VectorXd::Zero(variables_);
  const double weight = kRegularisation / nodes_;
  double value = v[level_];
  for (int n = 0; n < nodes_; ++n) {
    const double gap = v[gap_of(n)];
    value += weight * gap * gap;
    if (gradient != nullptr) (*gradient)[gap_of(n)] = 2 * weight * gap;
    if (is_held(n)) continue;
    const int at = first_[size_t(n)];
    const Eigen::Vector2d off = v.segment<2>(at) - problem_->mapped[size_t(n)].head<2>() / unit_;
    value += weight * off.squaredNorm();
    if (gradient != nullptr) gradient->segment<2>(at) = 2 * weight * off;
  }
  if (gradient != nullptr) (*gradient)[level_] = 1;
  return value;
}

Eigen::VectorXd FloorNlp::constraint_values(const VectorRef& v) const {
  const std::vector<NodeJet> all = jets(v);
  Eigen::VectorXd c(row_.count);
  for (size_t k = 0; k < fibres_.size(); ++k)
    c[int(k)] = 0.5 * fibre(fibres_[k], all).squaredNorm() * fibres_[k].length / unit_;
  int row = row_.gap;
  for (int n = 0; n < nodes_; ++n) {
    c[row_.level + n] = v[gap_of(n)] - v[level_];
    if (!is_held(n)) continue;
    c[row++] = distance_jet(problem_->mold, all[size_t(n)].value, unit_).value - half_ - v[gap_of(n)];
  }
  const double offset = problem_->rig.joint_offset / unit_;
  for (int k = 0; k < pads_; ++k) {
    const Eigen::Vector3d a = v.segment<3>(pad_at(k) + 3), b = v.segment<3>(pad_at(k) + 6);
    c.segment<3>(row_.frame + 3 * k) << 0.5 * a.squaredNorm(), 0.5 * b.squaredNorm(), a.dot(b);
    c.segment<3>(row_.joint + 3 * k) =
        v.segment<3>(pad_at(k) + 9) - v.segment<3>(pad_at(k)) - offset * a.cross(b);
    if (tilt_limited_) c[row_.tilt + k] = a.cross(b).z();
  }
  for (size_t k = 0; k < links_.size(); ++k) {
    const auto [i, j] = links_[k];
    c[row_.link + int(k)] = 0.5 * (v.segment<3>(pad_at(j) + 9) - v.segment<3>(pad_at(i) + 9)).squaredNorm();
  }
  for (size_t k = 0; k < limits_->size(); ++k) {
    const EdgeLimit& limit = (*limits_)[k];
    c[row_.limit + int(k)] = limit.direction.dot(all[size_t(limit.node)].value - limit.place / unit_);
  }
  return c;
}

}  // namespace drapeplan
