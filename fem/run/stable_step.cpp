#include "fem/run/stable_step.hpp"

#include <Spectra/GenEigsSolver.h>

#include <algorithm>
#include <cmath>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr Eigen::Index kKrylovSize = 20, kMostRestarts = 100;  // a drape takes none to three
constexpr double kEigenvalueTolerance = 1e-4;                  // relative

constexpr double kProbeLength = 1e-9;  // [m] of a node: strains far below a piece of the tables

constexpr double kOffTheKink = 3e-5;          // strain, less than the look-ahead of Lookup
constexpr int kFirstRounds = 5, kRounds = 3;  // the first gives most: 8 to 17 % of the step, all 25 %
constexpr double kGrowth = 1e-6;              // strain: a small rate, where a law with rates is stiffest
constexpr int kDashpotRounds = 3;             // their share of the rate converges at least threefold in each

/// Displacements and director changes of all nodes, in mass-weighted coordinates.
using Modes = Eigen::VectorXd;

/// Stiffness times a displacement, by central differences of the forces. Dashpots count as springs: where
/// nodes move by u, their velocities change by `rate` u, with 2 over the step as rate.
class Tangent {
 public:
  Tangent(const Model& model, const State& state, double rate)
      : model_(model),
        state_(state),
        trial_(state),
        work_(model),
        nodes_(model.node_count()),
        rate_(rate),
        mobility_(model.inverse_mass()),
        turning_mobility_(model.inverse_inertia()) {
    for (size_t g = 0; g < model.pad_nodes().size(); ++g) {
      if (!state.pads[g].released) continue;
      for (const int node : model.pad_nodes()[g]) {
        mobility_[size_t(node)] = 1 / model.masses().own_mass(node);
        turning_mobility_[size_t(node)] = 1 / model.masses().own_inertia(node);
      }
    }
  }

  [[nodiscard]] Eigen::Index size() const { return 6 * Eigen::Index(nodes_); }

  [[nodiscard]] Modes operator()(const Modes& u) {
    double largest = 0;  // displacement of a node per unit of u
    for (Eigen::Index n = 0; n < nodes_; ++n)
      largest = std::max(largest, weight(n) * u.segment<3>(6 * n).norm());
    const double step = kProbeLength / std::max(largest, 1e-300);
    return (at(u, step) - at(u, -step)) / (-2 * step);
  }

 private:
  [[nodiscard]] double weight(Eigen::Index n) const { return std::sqrt(mobility_[size_t(n)]); }
  [[nodiscard]] double turn_weight(Eigen::Index n) const { return std::sqrt(turning_mobility_[size_t(n)]); }

  void add_forces(const VectorField& force, Modes& out) const {
    for (Eigen::Index n = 0; n < nodes_; ++n) {
      const auto k = size_t(n);
      out.segment<3>(6 * n) += weight(n) * Eigen::Vector3d(force.x[k], force.y[k], force.z[k]);
    }
  }

  /// Weighted forces at the state moved by step * u; directors stay unit to first order.
  Modes at(const Modes& u, double step) {
    trial_ = state_;
    for (Eigen::Index n = 0; n < nodes_; ++n) {
      const auto k = size_t(n);
      const Eigen::Vector3d d(state_.director.x[k], state_.director.y[k], state_.director.z[k]);
      const Eigen::Vector3d move = step * weight(n) * u.segment<3>(6 * n);
      Eigen::Vector3d turn = step * turn_weight(n) * u.segment<3>(6 * n + 3);
      turn -= turn.dot(d) * d;
      trial_.position.x[k] += move.x(), trial_.position.y[k] += move.y(), trial_.position.z[k] += move.z();
      trial_.velocity.x[k] += rate_ * move.x(), trial_.velocity.y[k] += rate_ * move.y(),
          trial_.velocity.z[k] += rate_ * move.z();
      trial_.director.x[k] += turn.x(), trial_.director.y[k] += turn.y(), trial_.director.z[k] += turn.z();
    }
    compute_forces(model_, trial_, work_);
    // At a kink of the law the stiffer side counts: fibres are looked at a little longer than they are, and
    // strains in compression as if they grew.
    for (auto* part : {&trial_.position.x, &trial_.position.y, &trial_.position.z}) {
      for (double& place : *part) place *= 1 + kOffTheKink;
    }
    trial_.history = state_.history;  // as it was before the forces
    model_.shell().set_lagged_strains(trial_, kOffTheKink + kGrowth);
    model_.terms().front()->forces(trial_, work_.entries.data());
    if (model_.fibre_inertia()) add_inertia(model_, trial_, work_);
    Modes out = Modes::Zero(size());
    if (model_.fibre_inertia()) add_forces(work_.force, out);
    for (const Forces& entry : work_.entries) {
      if (!model_.fibre_inertia()) add_forces(entry.force, out);
      for (Eigen::Index n = 0; n < nodes_; ++n) {
        const auto k = size_t(n);
        if (entry.moment.x.empty()) continue;
        const Eigen::Vector3d d(state_.director.x[k], state_.director.y[k], state_.director.z[k]);
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
  double rate_;
  std::vector<double> mobility_, turning_mobility_;  ///< 1 / mass and inertia of nodes; 0 where held
};

/// The tangent as Spectra asks for it.
struct TangentOperator {
  using Scalar = double;
  Tangent& tangent;
  [[nodiscard]] Eigen::Index rows() const { return tangent.size(); }
  [[nodiscard]] Eigen::Index cols() const { return tangent.size(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Modes>(out, rows()) = tangent(Eigen::Map<const Modes>(in, rows()));
  }
};

/// Largest eigenvalue, by Arnoldi's method with restarts: friction makes the tangent unsymmetric.
double largest_eigenvalue(Tangent tangent) {
  TangentOperator product{tangent};
  Spectra::GenEigsSolver<TangentOperator> solver(product, 1, std::min(kKrylovSize, product.rows()));
  solver.init();
  solver.compute(Spectra::SortRule::LargestReal, kMostRestarts, kEigenvalueTolerance);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw NotFinished("the largest eigenvalue of the tangent was not found");
  return solver.eigenvalues()[0].real();
}

}  // namespace

double stable_step(const Model& model, State& state, StepScratch& scratch) {
  const Shell& shell = model.shell();
  NodalStiffness &others = scratch.others, &sum = scratch.sum;
  if (state.lightness.empty()) state.lightness.assign(padded(model.node_count()), 1.0);
  others.clear();
  for (const auto& term : model.terms()) {
    if (term.get() != &shell) term->add_tangent(state, others);
  }
  const double steepest = shell.look_at_sections(state, scratch.sections);
  for (int round = state.step == 0 ? kFirstRounds : kRounds;; --round) {
    sum.clear();
    shell.add_bounds(scratch.sections, state.lightness, sum);
    for (size_t n = 0; n < size_t(model.node_count()); n += size_t(kLanes)) {
      const Lanes slack = Lanes(1.0) / load(&state.lightness[n]);
      store(load(&sum.translation[n]) * slack + load(&others.translation[n]), &sum.translation[n]);
      store(load(&sum.rotation[n]) * slack + load(&others.rotation[n]), &sum.rotation[n]);
      store(load(&others.damping[n]), &sum.damping[n]);
    }
    model.bounds().raise_for_released_nodes(state, sum);
    const double rate = model.bounds().highest_rate(sum);
    model.bounds().update_lightness(sum, rate, state.lightness);
    if (round > 1) continue;
    const double step = model.bounds().stable_dt(rate);
    // Mass on edges was made for the steepest fibre that the law has.
    return model.fibre_inertia() ? std::min(step, model.fibre_inertia_dt() / std::sqrt(steepest)) : step;
  }
}

double true_stable_step(const Model& model, const State& state) {
  Scene undamped = model.scene();  // viscous stress changes with strain as well, but is no stiffness
  undamped.options.bulk_viscosity = 0;
  if (undamped.rig)
    undamped.rig->actuator_stiffness = 0;  // no term; the longer step would be too long for it
  undamped.options.precision =
      Precision::double_lanes;  // differences of forces, over less than floats tell apart
  const Model elastic(std::move(undamped));
  double rate = 0;  // 2 over the step
  for (int round = 0; round < kDashpotRounds; ++round)
    rate = std::sqrt(largest_eigenvalue(Tangent(elastic, state, rate)));
  return 2 / rate * viscous_share(model.scene().options.bulk_viscosity);
}

}  // namespace drapeplan
