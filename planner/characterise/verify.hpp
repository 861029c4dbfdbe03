// A test played again with the material that came out of it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/law/fabric.hpp"
#include "planner/measured/tests_file.hpp"

namespace drapeplan {

/// Crosshead force over displacement, measured and simulated.
struct Verification {
  std::string name;                        ///< "bias extension at 10 mm/min"
  std::string file;                        ///< of the test
  std::vector<Eigen::Vector2d> measured;   ///< (displacement [m], force [N])
  std::vector<Eigen::Vector2d> simulated;  ///< likewise
  double error = 0;       ///< largest difference of the forces over the largest measured one up to there
  double compared_to = 0;  ///< displacement up to which they are compared [m]
  std::string failure;    ///< why there is nothing to compare; empty if there is
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

/// The same, with its forces compared with those of the test.
/// @param to  displacement up to which they are compared [m].
Verification verify_strip(const StripTest& test, const Fabric& fabric, bool bias, double to);

}  // namespace drapeplan
