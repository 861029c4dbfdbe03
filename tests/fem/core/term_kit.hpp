// What every term must pass, each by one call. A subject is a term with a scene built around it, and what is
// true of it; check_term() runs all checks that apply.
//
//   TermSubject subject{.model = &model, .term = 0, .state = state};
//   subject.energy = [&](const State& s) { return ...; };
//   check_term(subject);
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "fem/run/workspace.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan::test {

struct TermSubject {
  const Model* model = nullptr;
  size_t term = 0;                                       ///< place in model->terms()
  State state;                                           ///< a disturbed state in which the term has forces
  std::function<double(const State&)> energy = nullptr;  ///< [J]; absent: the term has none
  bool internal = false;           ///< forces and moments between nodes only: their sums are zero
  bool turns_with_scene = false;   ///< nothing outside the ply has a direction for it
  std::optional<State> rest = {};  ///< a state without forces
  double length_step = 1e-8;       ///< of central differences [m]
  double angle_step = 1e-5;        ///< [rad]
  double tolerance = 1e-4;         ///< of forces against differences, over the largest force
};

/// Forces and moments of all entries of the subject's term.
struct TermForces {
  std::vector<Eigen::Vector3d> force, moment;
  [[nodiscard]] static double largest(const std::vector<Eigen::Vector3d>& list) {
    double size = 0;
    for (const Eigen::Vector3d& f : list) size = std::max(size, f.norm());
    return size;
  }
};

inline TermForces term_forces(const TermSubject& subject, State state) {
  const Term& term = *subject.model->terms()[subject.term];
  const auto nodes = size_t(subject.model->node_count());
  std::vector<Forces> entries = term.entries();
  term.forces(state, entries.data());
  TermForces sum{std::vector<Eigen::Vector3d>(nodes, Eigen::Vector3d::Zero()),
                 std::vector<Eigen::Vector3d>(nodes, Eigen::Vector3d::Zero())};
  for (const Forces& entry : entries) {
    for (size_t n = 0; n < nodes; ++n) {
      sum.force[n] += get(entry.force, n);
      if (!entry.moment.x.empty()) sum.moment[n] += get(entry.moment, n);
    }
  }
  return sum;
}

/// force = - d energy / dx and moment = - d energy / dd by central differences; the forces are not all zero.
inline void expect_derivative_of_energy(const TermSubject& subject) {
  const TermForces exact = term_forces(subject, subject.state);
  const double force = TermForces::largest(exact.force), moment = TermForces::largest(exact.moment);
  ASSERT_GT(std::max(force, moment), 0);
  State state = subject.state;
  const auto difference = [&](VectorField& field, size_t n, int k, double by) {
    const Eigen::Vector3d before = get(field, n), step = by * Eigen::Vector3d::Unit(k);
    put(field, n, before + step);
    const double up = subject.energy(state);
    put(field, n, before - step);
    const double down = subject.energy(state);
    put(field, n, before);
    return -(up - down) / (2 * by);
  };
  double force_error = 0, moment_error = 0;
  for (size_t n = 0; n < exact.force.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      force_error = std::max(
          force_error, std::abs(exact.force[n][k] - difference(state.position, n, k, subject.length_step)));
      moment_error = std::max(
          moment_error, std::abs(exact.moment[n][k] - difference(state.director, n, k, subject.angle_step)));
    }
  }
  EXPECT_LE(force_error, subject.tolerance * force);
  EXPECT_LE(moment_error, subject.tolerance * moment);
}

/// Sum of forces, and of moments about the origin, over the sum of magnitudes.
inline void expect_no_resultant(const TermSubject& subject) {
  const TermForces f = term_forces(subject, subject.state);
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double size = 0;
  for (size_t n = 0; n < f.force.size(); ++n) {
    force += f.force[n];
    moment +=
        get(subject.state.position, n).cross(f.force[n]) + get(subject.state.director, n).cross(f.moment[n]);
    size += f.force[n].norm();
  }
  EXPECT_GT(size, 0);
  EXPECT_LE(force.norm(), 1e-12 * size);
  EXPECT_LE(moment.norm(), 1e-12 * size);  // arms here are below 1 m
}

/// f(R x) = R f(x) for large rotations.
inline void expect_turns_with_scene(const TermSubject& subject) {
  const TermForces before = term_forces(subject, subject.state);
  for (const double angle : {0.7, 2.1, 3.1}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    State state = subject.state;
    rotate(state, subject.model->node_count(), turn);
    const TermForces after = term_forces(subject, state);
    double force = 0, moment = 0;
    for (size_t n = 0; n < before.force.size(); ++n) {
      force = std::max(force, (after.force[n] - turn * before.force[n]).norm());
      moment = std::max(moment, (after.moment[n] - turn * before.moment[n]).norm());
    }
    EXPECT_LE(force, 1e-9 * TermForces::largest(before.force));
    EXPECT_LE(moment, 1e-9 * TermForces::largest(before.moment));
  }
}

/// At rest forces are round-off of those in the disturbed state.
inline void expect_zero_at_rest(const TermSubject& subject) {
  const TermForces rest = term_forces(subject, *subject.rest), moved = term_forces(subject, subject.state);
  EXPECT_LE(TermForces::largest(rest.force), 1e-8 * TermForces::largest(moved.force));
  EXPECT_LE(TermForces::largest(rest.moment), 1e-8 * TermForces::largest(moved.moment));
}

/// All checks that apply to the subject.
inline void check_term(const TermSubject& subject) {
  SCOPED_TRACE(subject.model->terms()[subject.term]->name());
  if (subject.energy) expect_derivative_of_energy(subject);
  if (subject.internal) expect_no_resultant(subject);
  if (subject.turns_with_scene) expect_turns_with_scene(subject);
  if (subject.rest) expect_zero_at_rest(subject);
}

/// Beats of many frequencies move the largest speed a little; an unstable mode multiplies it by far more.
inline constexpr double kBoundedGrowth = 3;

/// Growth of a small disturbance of `from` over `steps` steps at `share` of the scene's stable step: largest
/// speed of the second half over that of the first, so about 1 while bounded; infinite if it is not finite.
inline double growth(Scene scene, double share, int steps, const std::function<State(const Model&)>& from) {
  scene.options.step_safety = share;
  scene.damping.reset();
  const Model model(scene);
  State state = from(model);
  Workspace work(model);
  std::array<double, 2> speed{0, 0};
  for (int k = 0; k < steps; ++k) {
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    drift_nodes(model, state);
    for (size_t n = 0; n < size_t(model.node_count()); ++n) {
      const double v = get(state.velocity, n).norm();
      if (!std::isfinite(v)) return std::numeric_limits<double>::infinity();
      speed[size_t(2 * k / steps)] = std::max(speed[size_t(2 * k / steps)], v);
    }
  }
  return speed[1] / speed[0];
}

/// The largest share of the scene's stable step that stays bounded, by bisection between 0.5 and 8.
inline double true_limit(const Scene& scene, int steps, const std::function<State(const Model&)>& from) {
  double low = 0.5, high = 8;
  for (int k = 0; k < 12; ++k) {
    const double middle = 0.5 * (low + high);
    (growth(scene, middle, steps, from) < kBoundedGrowth ? low : high) = middle;
  }
  return low;
}

/// 0.9 of the stable step stays bounded, 1.3 of the true limit grows; the estimate is no more than the truth.
inline void expect_stable_step(const Scene& scene, const std::function<State(const Model&)>& from,
                               int steps = 4000) {
  const double limit = true_limit(scene, steps, from);
  EXPECT_GE(limit, 0.99);
  EXPECT_LT(limit, 7.9);  // a limit was found
  EXPECT_LE(growth(scene, 0.9, steps, from), kBoundedGrowth);
  EXPECT_FALSE(growth(scene, 1.3 * limit, steps, from) <= kBoundedGrowth);
}

}  // namespace drapeplan::test
