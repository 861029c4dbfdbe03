// A test played again with the material that came out of it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/law/fabric.hpp"
#include "planner/characterise/bending.hpp"
#include "planner/measured/tests_file.hpp"
#include "planner/tables/smooth.hpp"

namespace drapeplan {

/// What is compared.
enum class Compared {
  force,  ///< of the crosshead over its displacement [m], [N]
  drop,   ///< of a strip's tip over the time [s], [m]
};

/// A strip in its clamps, pulled.
struct PulledStrip {
  std::vector<Eigen::Vector2d> force;  ///< (displacement of the crosshead [m], force [N])
  /// (displacement [m], mean shear angle [rad]) along the axis, between the triangles that the clamps hold; bias only.
  /// This mean is what the clamps fix: beside the axis fibres are of other lengths, and angles scatter.
  std::vector<Eigen::Vector2d> angle;
  std::string failure;  ///< why the run did not end; empty if it did
};

/// Simulates a strip in its clamps, with fibres along it or at 45 degrees.
/// @param test  its size and rate; the table is not looked at.
/// @param to  displacement at the end [m].
/// @param mass_scaling  of the run. Where the fabric resists less than 10 kPa, only 1 keeps inertia out of its shape.
PulledStrip pull_strip(const StripTest& test, const Fabric& fabric, bool bias, double to, double mass_scaling);

/// Values over the displacement or time of a simulation, which grows; points where it does not are left out.
MonotoneCubic curve_through(const std::vector<Eigen::Vector2d>& history);

/// What was measured and what is simulated with the material.
struct Verification {
  Compared what = Compared::force;
  std::string name;                        ///< "bias extension at 10 mm/min"
  std::string file;                        ///< of the test
  std::vector<Eigen::Vector2d> measured;   ///< see `what`
  std::vector<Eigen::Vector2d> simulated;  ///< likewise
  double compared_from = 0, compared_to = 0;  ///< range in which they are compared, displacement or time
  /// Largest difference there; of forces over the largest measured one up to the same place, of drops over the last
  /// measured one.
  double error = 0;
  double end_error = 0;  ///< the difference at the end of the range, over the same
  std::string failure;   ///< why there is nothing to compare; empty if there is
};

/// Simulates a strip in its clamps, with fibres along it or at 45 degrees, and compares forces from a fifth of the
/// way on: before, forces are small, and the grips still gain speed.
/// @param test  its size and speed.  @param measured  (displacement [m], force [N]) of the strip alone, from its
/// unloaded state on.  @param to  displacement up to which they are compared [m].
Verification verify_strip(const StripTest& test, std::vector<Eigen::Vector2d> measured, const Fabric& fabric,
                          bool bias, double to);

/// Simulates a strip that is let go, with the rates that the fabric has, and compares the drop of its tip to the end
/// of its history, from the time on at which the simulated strip has come down: that takes it longer than the real
/// one, since a long test is played faster than it was and with scaled masses. Neither changes the creeping that
/// follows, in which inertia is nothing and rates are those of the test's own clock.
/// @param file  of the test, to name it.  @param gravity  [m/s^2].  @param section_points  of the simulation.
Verification verify_cantilever(const TipHistory& history, const std::string& file, const Fabric& fabric,
                               double gravity, int section_points);

}  // namespace drapeplan
