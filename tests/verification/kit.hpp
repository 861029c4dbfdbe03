// What verification tests share: strips, coming to rest, printing figures.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "fem/mesh/grid.hpp"
#include "fem/model/model.hpp"
#include "fem/run/workspace.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan::test {

/// An isotropic sheet without lateral contraction: G = E / 2, in the section too.
struct Sheet {
  double modulus = 1, thickness = 1, density = 1;  ///< [Pa], [m], [kg/m^2]

  [[nodiscard]] Fabric fabric() const {
    Fabric fabric = linear_fabric(modulus, modulus / 2, modulus / 2);
    fabric.thickness = thickness;
    fabric.areal_density = density;
    return fabric;
  }
  [[nodiscard]] double bending_stiffness() const { return modulus * std::pow(thickness, 3) / 12; }  ///< [N m]
  /// Angular frequency of a mode that would be `number` / length^2 * sqrt(D / density).
  [[nodiscard]] double frequency(double number, double length) const {
    return number * std::sqrt(bending_stiffness() / density) / (length * length);
  }
};

/// First bending frequency of a clamped-free strip: 1.8751^2.
inline constexpr double kCantilever = 3.516;

/// A strip of n elements along x from 0 to `length`, clamped at 0; its tip nodes are n and 2 n + 1. The
/// damping is critical for the lowest bending mode.
inline Scene cantilever(const Sheet& sheet, double length, double width, int n) {
  Scene scene;
  scene.mesh = grid_mesh(n, 1, [=](double u, double v) { return Eigen::Vector2d(u * length, v * width); });
  scene.fabric = sheet.fabric();
  scene.options.mass_scaling = 1;
  scene.damping = 2 * sheet.frequency(kCantilever, length);
  scene.clamped = {0, n + 1};
  return scene;
}

/// Forces, kicks, drifts: the time loop without books and rig.
inline void advance(const Model& model, State& state, Workspace& work) {
  compute_forces(model, state, work);
  kick_nodes(model, state, work);
  drift_nodes(model, state);
  advance_clock(state);
}

/// Plays the scene from `state` until it rests: with a damping near critical for the lowest mode, a node
/// still has about v / (alpha / 2) to go; this is below `remainder` [m] for all nodes at twenty looks one
/// after the other, spread over two time constants.
inline void settle(const Model& model, State& state, double remainder) {
  constexpr int kQuietLooks = 20;
  constexpr double kMostConstants = 400;  // time constants: far more than any test here needs
  const double constant = 2 / model.alpha();
  const auto between = std::int64_t(std::ceil(2 * constant / kQuietLooks / model.dt()));
  const auto most = std::int64_t(kMostConstants * constant / model.dt());
  Workspace work(model);
  int quiet = 0;
  while (quiet < kQuietLooks && state.step < most) {
    for (std::int64_t k = 0; k < between; ++k) advance(model, state, work);
    double speed = 0;
    for (size_t n = 0; n < size_t(model.node_count()); ++n) {
      const double v = get(state.velocity, n).norm();
      if (!(v <= speed)) speed = v;  // NaN stays
    }
    quiet = speed * constant <= remainder ? quiet + 1 : 0;
  }
  EXPECT_EQ(quiet, kQuietLooks) << "not at rest after " << state.step << " steps";
}

inline State at_rest(const Model& model, double remainder) {
  State state = model.flat_state(0);
  settle(model, state, remainder);
  return state;
}

/// Prints a figure of tests/bench/fem.md and returns its relative error.
inline double figure(const std::string& what, double computed, double published) {
  const double error = computed / published - 1;
  std::printf("  %-44s computed %.6g  published %.6g  error %+.3f %%\n", what.c_str(), computed, published,
              100 * error);
  return std::abs(error);
}

/// Requires that an error that is halved in mesh size falls with order two: |slope| between 1.7 and 2.4.
inline void expect_second_order(double coarse, double fine) {
  const double slope = std::log2(std::abs(coarse / fine));
  std::printf("  order %.2f\n", slope);
  EXPECT_GE(slope, 1.7);
  EXPECT_LE(slope, 2.4);
}

}  // namespace drapeplan::test
