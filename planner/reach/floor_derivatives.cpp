// First and second derivatives of the floor's program. Patterns are what the same code writes to.
#include <Eigen/Geometry>
#include <algorithm>

#include "planner/reach/floor_nlp.hpp"

namespace drapeplan {
namespace {

struct Recorder {
  SmoothProgram::Pattern& pattern;
  void operator()(int row, int column, double) { pattern.emplace_back(row, column); }
};

struct Writer {
  Eigen::VectorXd& values;
  int at = 0;
  void operator()(int, int, double value) { values[at++] = value; }
};

/// Turns entries to the lower triangle.
template <class Sink>
struct Lower {
  Sink& sink;
  void operator()(int row, int column, double value) {
    sink(std::max(row, column), std::min(row, column), value);
  }
};

}  // namespace

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
void FloorNlp::jacobian_of_rig(const VectorRef& v, Sink& sink) const {
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
  jacobian_of_rig(v, sink);
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

/// What all terms do at a node, H = stiffness J'J + force . (second derivatives of its place), and at a pad.
struct FloorNlp::Sums {
  std::vector<double> stiffness;
  std::vector<Eigen::Vector3d> force;
  std::vector<Eigen::Matrix<double, 9, 9>> pads;  ///< by c, a, b
};

template <class Sink>
void FloorNlp::add_fibres(Sink& sink, const VectorRef& multipliers, const std::vector<NodeJet>& all,
                          Sums& sums) const {
  for (size_t k = 0; k < fibres_.size(); ++k) {
    const Fibre& cell = fibres_[k];
    const double tension = multipliers[int(k)] * cell.length * unit_;
    const Eigen::Vector3d pull = tension / unit_ * fibre(cell, all);
    for (size_t i = 0; i < size_t(cell.count); ++i) {
      const int p = cell.corner[i];
      const double first = cell.coefficient[i];
      sums.force[size_t(p)] += first * pull;
      sums.stiffness[size_t(p)] += tension * first * first;
      for (size_t j = 0; j < i; ++j) {
        const int q = cell.corner[j];
        const double weight = tension * first * cell.coefficient[j];
        if (p == q) {  // of a triangle
          sums.stiffness[size_t(p)] += 2 * weight;
        } else if (is_held(p) && pad_[size_t(p)] == pad_[size_t(q)]) {
          const Eigen::Vector3d wp = weights(p), wq = weights(q);
          for (int r = 0; r < 9; ++r) {
            for (int c = r % 3; c < 9; c += 3)
              sums.pads[size_t(pad_[size_t(p)])](r, c) +=
                  weight * (wp[r / 3] * wq[c / 3] + wq[r / 3] * wp[c / 3]);
          }
        } else {
          add_pair(sink, p, q, all, weight);
        }
      }
    }
  }
}

template <class Sink>
void FloorNlp::add_nodes(Sink& sink, double sigma, const VectorRef& multipliers,
                         const std::vector<NodeJet>& all, Sums& sums) const {
  const double weight = 2 * sigma * kRegularisation / nodes_;
  int row = row_.gap;
  for (int n = 0; n < nodes_; ++n) {
    const size_t node = size_t(n);
    const NodeJet& jet = all[node];
    if (is_held(n)) {
      sink(gap_of(n), gap_of(n), weight);
      const Eigen::Matrix3d block =
          sums.stiffness[node] * Eigen::Matrix3d::Identity() +
          multipliers[row++] * distance_jet(problem_->mold, jet.value, unit_).second;
      const Eigen::Vector3d w = weights(n);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
          sums.pads[size_t(pad_[node])].block<3, 3>(3 * r, 3 * c) += w[r] * w[c] * block;
      }
      continue;
    }
    size_t at = 0;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c <= r; ++c) {
        sink(first_[node] + r, first_[node] + c,
             sums.stiffness[node] * jet.first.col(r).dot(jet.first.col(c)) +
                 sums.force[node].dot(jet.second[at++]) + (r == c ? weight : 0));
      }
    }
  }
}

template <class Sink>
void FloorNlp::add_pads(Sink& sink, const VectorRef& multipliers, Sums& sums) const {
  const double offset = problem_->rig.joint_offset / unit_;
  for (int k = 0; k < pads_; ++k) {
    auto& pad = sums.pads[size_t(k)];
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
}

template <class Sink>
void FloorNlp::add_links(Sink& sink, const VectorRef& multipliers) const {
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

template <class Sink>
void FloorNlp::hessian(const VectorRef& v, double sigma, const VectorRef& multipliers, Sink& out) const {
  Lower<Sink> sink{out};
  const std::vector<NodeJet> all = jets(v);
  Sums sums{std::vector<double>(size_t(nodes_), 0.0), std::vector<Eigen::Vector3d>(size_t(nodes_), {0, 0, 0}),
            std::vector<Eigen::Matrix<double, 9, 9>>(size_t(pads_), Eigen::Matrix<double, 9, 9>::Zero())};
  add_fibres(sink, multipliers, all, sums);
  for (size_t k = 0; k < limits_->size(); ++k)
    sums.force[size_t((*limits_)[k].node)] += multipliers[row_.limit + int(k)] * (*limits_)[k].direction;
  add_nodes(sink, sigma, multipliers, all, sums);
  add_pads(sink, multipliers, sums);
  add_links(sink, multipliers);
}

Eigen::VectorXd FloorNlp::jacobian_values(const VectorRef& v) const {
  Eigen::VectorXd values(int(jacobian_pattern_.size()));
  Writer writer{values};
  jacobian(v, writer);
  return values;
}

Eigen::VectorXd FloorNlp::hessian_values(const VectorRef& v, double sigma,
                                         const VectorRef& multipliers) const {
  Eigen::VectorXd values(int(hessian_pattern_.size()));
  Writer writer{values};
  hessian(v, sigma, multipliers, writer);
  return values;
}

void FloorNlp::build_patterns() {
  const Eigen::VectorXd any = Eigen::VectorXd::Zero(variables_);
  Recorder jacobian_places{jacobian_pattern_}, hessian_places{hessian_pattern_};
  jacobian(any, jacobian_places);
  hessian(any, 0, Eigen::VectorXd::Zero(row_.count), hessian_places);
}

}  // namespace drapeplan
