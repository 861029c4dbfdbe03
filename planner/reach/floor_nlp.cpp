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
/// Weight of mean square gap and distance from the mapped net against the largest gap, all in units of the
/// spacing. With means of (5 mm)^2 and a spacing of 100 mm the optimum moves by less than 0.3 um.
constexpr double kRegularisation = 1e-3;

struct Recorder {
  SmoothProgram::Pattern& pattern;
  void operator()(int row, int column, double) { pattern.emplace_back(row, column); }
};

struct Writer {
  Eigen::VectorXd& values;
  int at = 0;
  void operator()(int, int, double value) { values[at++] = value; }
};

std::vector<int> pad_of_nodes(const FloorProblem& problem) {
  std::vector<int> pad(problem.net.rest.size(), -1);
  for (size_t k = 0; k < problem.held.size(); ++k) {
    for (const int node : problem.held[k]) pad[size_t(node)] = int(k);
  }
  return pad;
}

/// Turns entries to the lower triangle.
template <class Sink>
struct Lower {
  Sink& sink;
  void operator()(int row, int column, double value) {
    sink(std::max(row, column), std::min(row, column), value);
  }
};

/// Signed distance from the mold with its derivatives by the place, in units of `unit`.
struct DistanceJet {
  double value;
  Eigen::Vector3d first;
  Eigen::Matrix3d second;
};

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

}  // namespace

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

  const Eigen::VectorXd any = Eigen::VectorXd::Zero(variables_);
  Recorder jacobian_places{jacobian_pattern_}, hessian_places{hessian_pattern_};
  jacobian(any, jacobian_places);
  hessian(any, 0, Eigen::VectorXd::Zero(row_.count), hessian_places);
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
  for (size_t c = 0; c < size_t(of.count); ++c) sum += of.coefficient[c] * unit_ * all[size_t(of.corner[c])].value;
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

template <class Sink>
void FloorNlp::add_place(Sink& sink, int row, int node, const NodeJet& jet,
                         const Eigen::Vector3d& by_place) const {
  if (is_held(node)) {
    const Eigen::Vector3d w = weights(node);
    const int at = pad_at(pad_[size_t(node)]);
    for (int r = 0; r < 9; ++r) sink(row, at + r, w[r / 3] * by_place[r % 3]);
    return;
  }
  const Eigen::Vector3d values = jet.first.transpose() * by_place;
  for (int r = 0; r < 3; ++r) sink(row, first_[size_t(node)] + r, values[r]);
}

template <class Sink>
void FloorNlp::jacobian(const VectorRef& v, Sink& sink) const {
  const std::vector<NodeJet> all = jets(v);
  for (size_t k = 0; k < fibres_.size(); ++k) {
    const Fibre& cell = fibres_[k];
    const Eigen::Vector3d along = fibre(cell, all) * cell.length;
    for (size_t c = 0; c < size_t(cell.count); ++c)
      add_place(sink, int(k), cell.corner[c], all[size_t(cell.corner[c])], cell.coefficient[c] * along);
  }
  int row = row_.gap;
  for (int n = 0; n < nodes_; ++n) {
    sink(row_.level + n, gap_of(n), 1);
    sink(row_.level + n, level_, -1);
    if (!is_held(n)) continue;
    const NodeJet& jet = all[size_t(n)];
    add_place(sink, row, n, jet, distance_jet(problem_->mold, jet.value, unit_).first);
    sink(row++, gap_of(n), -1);
  }
  const double offset = problem_->rig.joint_offset / unit_;
  for (int k = 0; k < pads_; ++k) {
    const int at = pad_at(k), frame = row_.frame + 3 * k, joint = row_.joint + 3 * k;
    const Eigen::Vector3d a = v.segment<3>(at + 3), b = v.segment<3>(at + 6);
    for (int r = 0; r < 3; ++r) {
      const int s = (r + 1) % 3, u = (r + 2) % 3;  // (a x b)_r = a_s b_u - a_u b_s
      sink(frame, at + 3 + r, a[r]);
      sink(frame + 1, at + 6 + r, b[r]);
      sink(frame + 2, at + 3 + r, b[r]);
      sink(frame + 2, at + 6 + r, a[r]);
      sink(joint + r, at + 9 + r, 1);
      sink(joint + r, at + r, -1);
      sink(joint + r, at + 3 + s, -offset * b[u]);
      sink(joint + r, at + 3 + u, offset * b[s]);
      sink(joint + r, at + 6 + u, -offset * a[s]);
      sink(joint + r, at + 6 + s, offset * a[u]);
    }
    if (!tilt_limited_) continue;
    sink(row_.tilt + k, at + 3, b.y());
    sink(row_.tilt + k, at + 4, -b.x());
    sink(row_.tilt + k, at + 7, a.x());
    sink(row_.tilt + k, at + 6, -a.y());
  }
  for (size_t k = 0; k < links_.size(); ++k) {
    const int i = pad_at(links_[k][0]) + 9, j = pad_at(links_[k][1]) + 9;
    const Eigen::Vector3d way = v.segment<3>(j) - v.segment<3>(i);
    for (int r = 0; r < 3; ++r) {
      sink(row_.link + int(k), j + r, way[r]);
      sink(row_.link + int(k), i + r, -way[r]);
    }
  }
  for (size_t k = 0; k < limits_->size(); ++k) {
    const EdgeLimit& limit = (*limits_)[k];
    add_place(sink, row_.limit + int(k), limit.node, all[size_t(limit.node)], limit.direction);
  }
}

template <class Sink>
void FloorNlp::add_pair(Sink& sink, int p, int q, const std::vector<NodeJet>& all, double weight) const {
  const bool p_held = is_held(p), q_held = is_held(q);
  const int from = p_held ? pad_at(pad_[size_t(p)]) : first_[size_t(p)];
  const int to = q_held ? pad_at(pad_[size_t(q)]) : first_[size_t(q)];
  const Eigen::Vector3d p_weights = p_held ? weights(p) : Eigen::Vector3d::Zero();
  const Eigen::Vector3d q_weights = q_held ? weights(q) : Eigen::Vector3d::Zero();
  const Eigen::Matrix3d &p_first = all[size_t(p)].first, &q_first = all[size_t(q)].first;
  for (int r = 0; r < (q_held ? 9 : 3); ++r) {
    for (int c = 0; c < (p_held ? 9 : 3); ++c) {
      if (p_held && q_held && r % 3 != c % 3) continue;
      double product = 0;
      if (p_held && q_held) product = q_weights[r / 3] * p_weights[c / 3];
      if (p_held && !q_held) product = q_first(c % 3, r) * p_weights[c / 3];
      if (!p_held && q_held) product = q_weights[r / 3] * p_first(r % 3, c);
      if (!p_held && !q_held) product = q_first.col(r).dot(p_first.col(c));
      sink(to + r, from + c, weight * product);
    }
  }
}

template <class Sink>
void FloorNlp::hessian(const VectorRef& v, double sigma, const VectorRef& multipliers, Sink& out) const {
  Lower<Sink> sink{out};
  const std::vector<NodeJet> all = jets(v);
  // What edges and limits do at a node: H = stiffness J'J + force . (second derivatives of its place).
  std::vector<double> stiffness(size_t(nodes_), 0.0);
  std::vector<Eigen::Vector3d> force(size_t(nodes_), {0, 0, 0});
  std::vector<Eigen::Matrix<double, 9, 9>> pads(size_t(pads_), Eigen::Matrix<double, 9, 9>::Zero());
  for (size_t k = 0; k < fibres_.size(); ++k) {
    const Fibre& cell = fibres_[k];
    const double tension = multipliers[int(k)] * cell.length * unit_;
    const Eigen::Vector3d pull = tension / unit_ * fibre(cell, all);
    for (size_t i = 0; i < size_t(cell.count); ++i) {
      const int p = cell.corner[i];
      const double first = cell.coefficient[i];
      force[size_t(p)] += first * pull;
      stiffness[size_t(p)] += tension * first * first;
      for (size_t j = 0; j < i; ++j) {
        const int q = cell.corner[j];
        const double weight = tension * first * cell.coefficient[j];
        if (p == q) {  // of a triangle
          stiffness[size_t(p)] += 2 * weight;
        } else if (is_held(p) && pad_[size_t(p)] == pad_[size_t(q)]) {
          const Eigen::Vector3d wp = weights(p), wq = weights(q);
          for (int r = 0; r < 9; ++r) {
            for (int c = r % 3; c < 9; c += 3)
              pads[size_t(pad_[size_t(p)])](r, c) += weight * (wp[r / 3] * wq[c / 3] + wq[r / 3] * wp[c / 3]);
          }
        } else {
          add_pair(sink, p, q, all, weight);
        }
      }
    }
  }
  for (size_t k = 0; k < limits_->size(); ++k)
    force[size_t((*limits_)[k].node)] += multipliers[row_.limit + int(k)] * (*limits_)[k].direction;

  const double weight = 2 * sigma * kRegularisation / nodes_;
  int row = row_.gap;
  for (int n = 0; n < nodes_; ++n) {
    const size_t node = size_t(n);
    const NodeJet& jet = all[node];
    if (is_held(n)) {
      sink(gap_of(n), gap_of(n), weight);
      const Eigen::Matrix3d block =
          stiffness[node] * Eigen::Matrix3d::Identity() +
          multipliers[row++] * distance_jet(problem_->mold, jet.value, unit_).second;
      const Eigen::Vector3d w = weights(n);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
          pads[size_t(pad_[node])].block<3, 3>(3 * r, 3 * c) += w[r] * w[c] * block;
      }
      continue;
    }
    size_t at = 0;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c <= r; ++c) {
        sink(first_[node] + r, first_[node] + c,
             stiffness[node] * jet.first.col(r).dot(jet.first.col(c)) + force[node].dot(jet.second[at++]) +
                 (r == c ? weight : 0));
      }
    }
  }
  const double offset = problem_->rig.joint_offset / unit_;
  for (int k = 0; k < pads_; ++k) {
    auto& pad = pads[size_t(k)];
    const Eigen::Vector3d frame = multipliers.segment<3>(row_.frame + 3 * k);
    Eigen::Vector3d turn = -offset * multipliers.segment<3>(row_.joint + 3 * k);
    if (tilt_limited_) turn.z() += multipliers[row_.tilt + k];
    pad.block<3, 3>(3, 3).diagonal().array() += frame[0];
    pad.block<3, 3>(6, 6).diagonal().array() += frame[1];
    // turn . (a x b) has the second derivative turn_m eps_mrs by a_r, b_s.
    Eigen::Matrix3d across;  // by b (rows) and a (columns)
    across << 0, -turn.z(), turn.y(), turn.z(), 0, -turn.x(), -turn.y(), turn.x(), 0;
    pad.block<3, 3>(6, 3) += across + frame[2] * Eigen::Matrix3d::Identity();
    for (int r = 0; r < 9; ++r) {
      for (int c = 0; c <= r; ++c) sink(pad_at(k) + r, pad_at(k) + c, pad(r, c));
    }
  }
  for (size_t k = 0; k < links_.size(); ++k) {
    const int i = pad_at(links_[k][0]) + 9, j = pad_at(links_[k][1]) + 9;
    const double tension = multipliers[row_.link + int(k)];
    for (int r = 0; r < 3; ++r) {
      sink(i + r, i + r, tension);
      sink(j + r, j + r, tension);
      sink(j + r, i + r, -tension);
    }
  }
}

Eigen::VectorXd FloorNlp::jacobian_values(const VectorRef& v) const {
  Eigen::VectorXd values(int(jacobian_pattern_.size()));
  Writer writer{values};
  jacobian(v, writer);
  return values;
}

Eigen::VectorXd FloorNlp::hessian_values(const VectorRef& v, double sigma, const VectorRef& multipliers) const {
  Eigen::VectorXd values(int(hessian_pattern_.size()));
  Writer writer{values};
  hessian(v, sigma, multipliers, writer);
  return values;
}

}  // namespace drapeplan
