#include "fem/stable_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace drapeplan {
namespace {

constexpr int kLanczosSteps = 60;      // largest eigenvalue of a mesh's spectrum to 0.1 %
constexpr double kProbeLength = 1e-9;  // [m] of a node: strains far below a piece of the tables

constexpr double kOffTheKink = 3e-5;  // strain, less than the look-ahead of Lookup

/// Displacements and director changes of all nodes, in mass-weighted coordinates.
using Modes = Eigen::VectorXd;

/// Stiffness times a displacement, by central differences of the forces.
class Tangent {
 public:
  Tangent(const Model& model, const State& state)
      : model_(model), state_(state), trial_(state), work_(model), nodes_(model.node_count()) {}

  [[nodiscard]] Eigen::Index size() const { return 6 * Eigen::Index(nodes_); }

  [[nodiscard]] Modes operator()(const Modes& u) {
    double largest = 0;  // displacement of a node per unit of u
    for (Eigen::Index n = 0; n < nodes_; ++n)
      largest = std::max(largest, weight(n) * u.segment<3>(6 * n).norm());
    const double step = kProbeLength / std::max(largest, 1e-300);
    return (at(u, step) - at(u, -step)) / (-2 * step);
  }

 private:
  [[nodiscard]] double weight(Eigen::Index n) const { return std::sqrt(model_.inverse_mass()[size_t(n)]); }
  [[nodiscard]] double turn_weight(Eigen::Index n) const {
    return std::sqrt(model_.inverse_inertia()[size_t(n)]);
  }

  /// Weighted forces at the state moved by step * u; directors stay unit to first order.
  Modes at(const Modes& u, double step) {
    trial_ = state_;
    for (Eigen::Index n = 0; n < nodes_; ++n) {
      const auto k = size_t(n);
      const Eigen::Vector3d d(state_.d.x[k], state_.d.y[k], state_.d.z[k]);
      const Eigen::Vector3d move = step * weight(n) * u.segment<3>(6 * n);
      Eigen::Vector3d turn = step * turn_weight(n) * u.segment<3>(6 * n + 3);
      turn -= turn.dot(d) * d;
      trial_.x.x[k] += move.x(), trial_.x.y[k] += move.y(), trial_.x.z[k] += move.z();
      trial_.d.x[k] += turn.x(), trial_.d.y[k] += turn.y(), trial_.d.z[k] += turn.z();
    }
    compute_forces(model_, trial_, work_);
    // At a kink of the law the stiffer side counts: fibres are looked at a little longer than they are.
    for (auto* part : {&trial_.x.x, &trial_.x.y, &trial_.x.z}) {
      for (double& place : *part) place *= 1 + kOffTheKink;
    }
    trial_.history = state_.history;  // as it was before the forces
    model_.terms().front()->forces(trial_, work_.entries.data());
    Modes out = Modes::Zero(size());
    for (const Forces& entry : work_.entries) {
      for (Eigen::Index n = 0; n < nodes_; ++n) {
        const auto k = size_t(n);
        out.segment<3>(6 * n) +=
            weight(n) * Eigen::Vector3d(entry.force.x[k], entry.force.y[k], entry.force.z[k]);
        if (entry.moment.x.empty()) continue;
        const Eigen::Vector3d d(state_.d.x[k], state_.d.y[k], state_.d.z[k]);
        Eigen::Vector3d moment(entry.moment.x[k], entry.moment.y[k], entry.moment.z[k]);
        moment -= moment.dot(d) * d;
        out.segment<3>(6 * n + 3) += turn_weight(n) * moment;
      }
    }
    return out;
  }

  const Model& model_;
  const State& state_;
  State trial_;
  Workspace work_;
  int nodes_;
};

}  // namespace

double stable_step(const Model& model, const State& state, NodalStiffness& scratch) {
  scratch.clear();
  for (const auto& term : model.terms()) term->add_tangent(state, scratch);
  return model.stable_dt(scratch);
}

double true_stable_step(const Model& model, const State& state) {
  Scene undamped = model.scene();  // viscous stress changes with strain as well, but is no stiffness
  undamped.options.bulk_viscosity = 0;
  const Model elastic(std::move(undamped));
  Tangent tangent(elastic, state);
  Modes now(tangent.size()), before = Modes::Zero(tangent.size());
  for (Eigen::Index k = 0; k < now.size(); ++k) now[k] = std::sin(1.0 + 12.9898 * double(k) * double(k));
  now.normalize();
  Eigen::VectorXd diagonal(kLanczosSteps), side(kLanczosSteps);
  int size = 0;
  double link = 0;
  while (size < kLanczosSteps) {
    Modes next = tangent(now);
    diagonal[size] = next.dot(now);
    next -= diagonal[size] * now + link * before;
    side[size] = link = next.norm();
    ++size;
    if (!(link > 1e-12 * std::abs(diagonal[0]))) break;
    before = now;
    now = next / link;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum;
  spectrum.computeFromTridiagonal(diagonal.head(size), side.head(size - 1), Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(spectrum.eigenvalues().maxCoeff()) *
         viscous_share(model.scene().options.bulk_viscosity);
}

}  // namespace drapeplan
