// Interlinks and guides of a rig as constraints: met at the end of every step by impulses along the
// directions at its start (SHAKE: Ryckaert, Ciccotti and Berendsen 1977) with Newton's method.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "fem/rig/rig.hpp"

namespace drapeplan {

/// A pad during one step, as the constraints see it.
struct LinkBody {
  double inverse_mass = 0, inverse_inertia = 0;  ///< [1/kg], [1/(kg m^2)]
  Eigen::Vector3d centre{0, 0, 0};               ///< at t [m]
  Eigen::Vector3d arm{0, 0, 0};                  ///< of the joint from the centre at t [m]
  Eigen::Vector3d velocity{0, 0, 0};             ///< at t + dt/2 [m/s]; in: free, out: with impulses
  Eigen::Vector3d angular_velocity{0, 0, 0};     ///< [rad/s]
  Eigen::Vector3d joint{0, 0, 0};                ///< out: at t + dt [m]
};

/// Scratch of one step.
struct LinkScratch {
  std::vector<LinkBody> bodies;                   ///< one per pad
  std::vector<Eigen::Vector3d> direction;         ///< of each row
  std::vector<double> residual, impulse, factor;  ///< of each row; envelope of the Cholesky factor
};

class LinkSystem {
 public:
  /// @param place  x-y of each joint in the flat start [m]: where the fixed joint stays.
  LinkSystem(const RigOptions& rig, const std::vector<Eigen::Vector2d>& place);

  [[nodiscard]] LinkScratch scratch() const;

  struct Outcome {
    double error = 0;  ///< largest of a row, at t + dt [m]
    bool converged = true;
  };
  /// Changes the bodies' velocities so that all rows hold at t + dt.
  Outcome meet(double dt, LinkScratch& scratch) const;

  /// Work of the last step's impulses for mean velocities of the joints [m/s] [J].
  [[nodiscard]] double work(const LinkScratch& scratch, const std::vector<Eigen::Vector3d>& joint_v) const;

 private:
  /// The joints i and j keep their distance, or joint i its coordinate `axis`.
  struct Row {
    int i = 0, j = -1, axis = -1;
    double value = 0;  ///< length or coordinate [m]
  };
  /// Rows k and l <= k share a pad; `sign` is +1 if it stands on the same side in both.
  struct Coupling {
    int k = 0, l = 0, pad = 0;
    double sign = 1;
  };

  void couple();
  void set_directions(LinkScratch& scratch) const;
  // Not Eigen's SimplicialLLT: it takes as long (4.2 against 4.1 us for 42 rows), but its solve allocates.
  void factorise(LinkScratch& scratch) const;
  void solve(LinkScratch& scratch) const;
  double residuals(double dt, LinkScratch& scratch) const;

  int pads_ = 0;
  double tolerance_ = 0;  ///< [m]
  std::vector<Row> rows_;
  std::vector<Coupling> couplings_;
  std::vector<int> envelope_;  ///< first column of each row of the factor
  std::vector<size_t> start_;  ///< where row k of the factor starts, less its first column
};

}  // namespace drapeplan
