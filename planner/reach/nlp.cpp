#include "planner/reach/nlp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace drapeplan {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The same surface with all lengths in units of `unit`.
Jet in_units(Jet s, double unit) {
  s.z /= unit;
  for (double* second : {&s.zxx, &s.zxy, &s.zyy}) *second *= unit;
  for (double* third : {&s.zxxx, &s.zxxy, &s.zxyy, &s.zyyy}) *third *= unit * unit;
  return s;
}

/// Unit normal n(a, b) = (-a, -b, 1) / sqrt(1 + a^2 + b^2) of the slopes a = z,x and b = z,y, by the chain
/// rule.
VectorJet normal_jet(const Jet& s) {
  const double a = s.zx, b = s.zy;
  const double r = 1 / std::sqrt(1 + a * a + b * b), r3 = r * r * r, r5 = r3 * r * r;
  const double ra = -a * r3, rb = -b * r3;
  const Eigen::Vector3d m(-a, -b, 1), ma(-1, 0, 0), mb(0, -1, 0);
  const Eigen::Vector3d na = ra * m + r * ma, nb = rb * m + r * mb;
  const Eigen::Vector3d naa = (3 * a * a * r5 - r3) * m + 2 * ra * ma;
  const Eigen::Vector3d nab = 3 * a * b * r5 * m + ra * mb + rb * ma;
  const Eigen::Vector3d nbb = (3 * b * b * r5 - r3) * m + 2 * rb * mb;

  VectorJet n;
  n.value = r * m;
  n.x = na * s.zxx + nb * s.zxy;
  n.y = na * s.zxy + nb * s.zyy;
  n.xx =
      naa * (s.zxx * s.zxx) + nab * (2 * s.zxx * s.zxy) + nbb * (s.zxy * s.zxy) + na * s.zxxx + nb * s.zxxy;
  n.xy = naa * (s.zxx * s.zxy) + nab * (s.zxx * s.zyy + s.zxy * s.zxy) + nbb * (s.zxy * s.zyy) + na * s.zxxy +
         nb * s.zxyy;
  n.yy =
      naa * (s.zxy * s.zxy) + nab * (2 * s.zxy * s.zyy) + nbb * (s.zyy * s.zyy) + na * s.zxyy + nb * s.zyyy;
  return n;
}

/// p + factor * q
VectorJet sum(const VectorJet& p, const VectorJet& q, double factor) {
  return {p.value + factor * q.value, p.x + factor * q.x,   p.y + factor * q.y,
          p.xx + factor * q.xx,       p.xy + factor * q.xy, p.yy + factor * q.yy};
}

/// Lower triangle of a symmetric 2-by-2 matrix, in the order in which it stands in the patterns.
constexpr std::array<std::array<int, 2>, 3> kLower{{{0, 0}, {1, 0}, {1, 1}}};

}  // namespace

GripperJet gripper_jet(const Mold& mold, const Eigen::Vector2d& place, double offset, double unit) {
  const Jet s = in_units(mold.jet(place.x() * unit, place.y() * unit), unit);
  GripperJet jet;
  jet.pad = {
      {place.x(), place.y(), s.z}, {1, 0, s.zx}, {0, 1, s.zy}, {0, 0, s.zxx}, {0, 0, s.zxy}, {0, 0, s.zyy}};
  jet.normal = normal_jet(s);
  jet.joint = sum(jet.pad, jet.normal, offset);
  return jet;
}

ReachNlp::ReachNlp(const ReachProblem& problem, ReachGoal goal, bool free_links)
    : problem_(&problem),
      goal_(goal),
      free_links_(free_links),
      tilt_limited_(problem.rig.tilt_limit < std::numbers::pi / 2),
      count_(problem.rig.count()),
      unit_(problem.rig.spacing),
      links_(interlinks(problem.rig)) {
  variables_ = 2 * count_;
  if (goal_ == ReachGoal::max) level_ = variables_++;
  if (free_links_) length_ = variables_++;

  if (problem.rig.fixed) {
    fixed_ = problem.rig.gripper_at(*problem.rig.fixed);
  }
  fixed_row_ = int(links_.size());
  tilt_row_ = fixed_row_ + (fixed_ >= 0 ? 2 : 0);
  level_row_ = tilt_row_ + (tilt_limited_ ? count_ : 0);
  rows_ = level_row_ + (goal_ == ReachGoal::max ? count_ : 0);
  build_patterns();
}

void ReachNlp::build_patterns() {
  const auto row = [this](int r, std::initializer_list<int> columns) {
    for (int c : columns) jacobian_pattern_.emplace_back(r, c);
  };
  for (int k = 0; k < int(links_.size()); ++k) {
    const auto [i, j] = links_[size_t(k)];
    row(k, {2 * i, 2 * i + 1, 2 * j, 2 * j + 1});
    if (free_links_) row(k, {length_});
  }
  if (fixed_ >= 0) {
    for (int a : {0, 1}) row(fixed_row_ + a, {2 * fixed_, 2 * fixed_ + 1});
  }
  for (int i = 0; tilt_limited_ && i < count_; ++i) row(tilt_row_ + i, {2 * i, 2 * i + 1});
  for (int i = 0; level_ >= 0 && i < count_; ++i) row(level_row_ + i, {2 * i, 2 * i + 1, level_});

  for (int i = 0; i < count_; ++i) {
    for (const auto& [a, b] : kLower) hessian_pattern_.emplace_back(2 * i + a, 2 * i + b);
  }
  for (const auto& [i, j] : links_) {
    for (int a : {0, 1}) {
      for (int b : {0, 1}) hessian_pattern_.emplace_back(2 * j + a, 2 * i + b);
    }
  }
}

ReachNlp::Bounds ReachNlp::variable_bounds() const {
  // One spacing beyond the mold: far outside, a polynomial's extrapolation has nothing to do with the mold.
  const Eigen::Vector2d lower = problem_->mold.extent().lower / unit_ - Eigen::Vector2d::Ones();
  const Eigen::Vector2d upper = problem_->mold.extent().upper / unit_ + Eigen::Vector2d::Ones();
  Bounds bounds{Eigen::VectorXd::Constant(variables_, 0), Eigen::VectorXd::Constant(variables_, kInfinity)};
  for (int i = 0; i < count_; ++i) {
    bounds.lower.segment<2>(2 * i) = lower;
    bounds.upper.segment<2>(2 * i) = upper;
  }
  return bounds;
}

ReachNlp::Bounds ReachNlp::constraint_bounds() const {
  Bounds bounds{Eigen::VectorXd::Zero(rows_), Eigen::VectorXd::Zero(rows_)};
  for (size_t k = 0; k < links_.size() && !free_links_; ++k) {
    const InterlinkOptions& link = *problem_->rig.interlinks;
    const double length = link_length(k), most = length + link.play[1] / unit_;
    const double least = std::max(0.0, length - link.play[0] / unit_);
    bounds.lower[int(k)] = link.stiffness ? -kInfinity : 0.5 * (least * least - length * length);
    bounds.upper[int(k)] = link.stiffness ? kInfinity : 0.5 * (most * most - length * length);
  }
  if (fixed_ >= 0) {
    bounds.lower.segment<2>(fixed_row_) = problem_->fixed_place / unit_;
    bounds.upper.segment<2>(fixed_row_) = problem_->fixed_place / unit_;
  }
  if (tilt_limited_) {
    bounds.lower.segment(tilt_row_, count_).setConstant(std::cos(problem_->rig.tilt_limit));
    bounds.upper.segment(tilt_row_, count_).setConstant(kInfinity);
  }
  if (level_ >= 0) bounds.lower.segment(level_row_, count_).setConstant(-kInfinity);
  return bounds;
}

Eigen::VectorXd ReachNlp::variables_at(const std::vector<Eigen::Vector2d>& places) const {
  Eigen::VectorXd v = Eigen::VectorXd::Ones(variables_);
  for (int i = 0; i < count_; ++i) v.segment<2>(2 * i) = places[size_t(i)] / unit_;
  if (level_ >= 0) {
    v[level_] = 0;
    const std::vector<GripperJet> all = jets(v);
    for (int i = 0; i < count_; ++i) v[level_] = std::max(v[level_], miss(all[size_t(i)], i).squaredNorm());
  }
  return v;
}

std::vector<Eigen::Vector2d> ReachNlp::places_at(const VectorRef& v) const {
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < count_; ++i) places.emplace_back(v.segment<2>(2 * i) * unit_);
  return places;
}

std::vector<GripperJet> ReachNlp::jets(const VectorRef& v) const {
  const double offset = (problem_->rig.joint_offset + problem_->ply_thickness) / unit_;
  std::vector<GripperJet> all;
  all.reserve(size_t(count_));
  for (int i = 0; i < count_; ++i)
    all.push_back(gripper_jet(problem_->mold, v.segment<2>(2 * i), offset, unit_));
  return all;
}

Eigen::Vector3d ReachNlp::miss(const GripperJet& jet, int gripper) const {
  return jet.pad.value - problem_->targets[size_t(gripper)] / unit_;
}

SmoothProgram::Form ReachNlp::form() const {
  return {variable_bounds(), constraint_bounds(), jacobian_pattern_, hessian_pattern_};
}

double ReachNlp::objective(const VectorRef& v, Eigen::VectorXd* gradient) const {
  if (gradient != nullptr) *gradient = this->gradient(v);
  if (level_ >= 0) return v[level_];
  const std::vector<GripperJet> all = jets(v);
  double total = 0;
  for (int i = 0; i < count_; ++i) total += miss(all[size_t(i)], i).squaredNorm();
  return total / count_;
}

Eigen::VectorXd ReachNlp::gradient(const VectorRef& v) const {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(variables_);
  if (level_ >= 0) {
    g[level_] = 1;
    return g;
  }
  const std::vector<GripperJet> all = jets(v);
  for (int i = 0; i < count_; ++i) {
    const VectorJet& pad = all[size_t(i)].pad;
    const Eigen::Vector3d e = miss(all[size_t(i)], i);
    for (int a : {0, 1}) g[2 * i + a] = 2 * e.dot(pad.first(a)) / count_;
  }
  return g;
}

Eigen::VectorXd ReachNlp::constraint_values(const VectorRef& v) const {
  const std::vector<GripperJet> all = jets(v);
  Eigen::VectorXd c(rows_);
  for (size_t k = 0; k < links_.size(); ++k) {
    const auto [i, j] = links_[k];
    const double squared_length = free_links_ ? v[length_] : std::pow(link_length(k), 2);
    c[int(k)] =
        0.5 * ((all[size_t(j)].joint.value - all[size_t(i)].joint.value).squaredNorm() - squared_length);
  }
  if (fixed_ >= 0) c.segment<2>(fixed_row_) = all[size_t(fixed_)].joint.value.head<2>();
  for (int i = 0; tilt_limited_ && i < count_; ++i) c[tilt_row_ + i] = all[size_t(i)].normal.value.z();
  for (int i = 0; level_ >= 0 && i < count_; ++i) {
    c[level_row_ + i] = miss(all[size_t(i)], i).squaredNorm() - v[level_];
  }
  return c;
}

Eigen::VectorXd ReachNlp::jacobian_values(const VectorRef& v) const {
  const std::vector<GripperJet> all = jets(v);
  Eigen::VectorXd values(int(jacobian_pattern_.size()));
  int at = 0;
  for (const auto& [i, j] : links_) {
    const VectorJet &p = all[size_t(i)].joint, &q = all[size_t(j)].joint;
    const Eigen::Vector3d d = q.value - p.value;
    for (int a : {0, 1}) values[at++] = -d.dot(p.first(a));
    for (int a : {0, 1}) values[at++] = d.dot(q.first(a));
    if (free_links_) values[at++] = -0.5;
  }
  if (fixed_ >= 0) {
    for (int component : {0, 1}) {
      for (int a : {0, 1}) values[at++] = all[size_t(fixed_)].joint.first(a)[component];
    }
  }
  for (int i = 0; tilt_limited_ && i < count_; ++i) {
    for (int a : {0, 1}) values[at++] = all[size_t(i)].normal.first(a).z();
  }
  for (int i = 0; level_ >= 0 && i < count_; ++i) {
    const Eigen::Vector3d e = miss(all[size_t(i)], i);
    for (int a : {0, 1}) values[at++] = 2 * e.dot(all[size_t(i)].pad.first(a));
    values[at++] = -1;
  }
  return values;
}

Eigen::VectorXd ReachNlp::hessian_values(const VectorRef& v, double sigma,
                                         const VectorRef& multipliers) const {
  const std::vector<GripperJet> all = jets(v);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(int(hessian_pattern_.size()));
  const auto add = [&](int gripper, const auto& entry) {  // to the gripper's own block
    for (int k = 0; k < 3; ++k) values[3 * gripper + k] += entry(kLower[size_t(k)][0], kLower[size_t(k)][1]);
  };
  for (int i = 0; i < count_; ++i) {
    const auto& [pad, normal, joint] = all[size_t(i)];
    const double weight = level_ >= 0 ? multipliers[level_row_ + i] : sigma / count_;
    const double tilt = tilt_limited_ ? multipliers[tilt_row_ + i] : 0;
    const Eigen::Vector3d e = miss(all[size_t(i)], i);
    Eigen::Vector3d held = Eigen::Vector3d::Zero();
    if (i == fixed_) held.head<2>() = multipliers.segment<2>(fixed_row_);
    add(i, [&](int a, int b) {
      return 2 * weight * (pad.first(a).dot(pad.first(b)) + e.dot(pad.second(a, b))) +
             tilt * normal.second(a, b).z() + held.dot(joint.second(a, b));
    });
  }
  int at = 3 * count_;
  for (size_t k = 0; k < links_.size(); ++k) {
    const auto [i, j] = links_[k];
    const VectorJet &p = all[size_t(i)].joint, &q = all[size_t(j)].joint;
    const Eigen::Vector3d d = q.value - p.value;
    const double force = multipliers[int(k)];
    add(i, [&](int a, int b) { return force * (p.first(a).dot(p.first(b)) - d.dot(p.second(a, b))); });
    add(j, [&](int a, int b) { return force * (q.first(a).dot(q.first(b)) + d.dot(q.second(a, b))); });
    for (int a : {0, 1}) {
      for (int b : {0, 1}) values[at++] = -force * q.first(a).dot(p.first(b));
    }
  }
  return values;
}

double ReachNlp::violation(const VectorRef& v) const {
  return drapeplan::violation(*this, v);
}

double ReachNlp::link_length(size_t link) const {
  return interlink_length(problem_->rig, link) / unit_;
}

double ReachNlp::link_scale(const VectorRef& v) const {
  return free_links_ ? std::sqrt(v[length_]) : 1;
}

}  // namespace drapeplan
