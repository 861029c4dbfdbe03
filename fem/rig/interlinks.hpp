// Interlinks and guides of a rig as constraints: met at the end of every step by impulses along the
// directions at its start (SHAKE: Ryckaert, Ciccotti and Berendsen 1977) with Newton's method.
//
// A spring in place of a bar is a constraint that gives way: its force is that of the length at the end of
// the step, so it cannot make the step unstable, and a spring of any stiffness goes over into a bar. A stop
// is a constraint that acts on one side only: which ones act is found in every step anew, by the sign of what
// they would have to do.
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
  std::vector<double> value;                      ///< of each row at t + dt: length or coordinate [m]
  std::vector<int> side;         ///< of rows with play: the stop that acts, +1 the longer one, -1, or 0: none
  std::vector<double> at_start;  ///< of springs: what a dashpot remembers of t, as a length [m]
};

class LinkSystem {
 public:
  /// @param place  x-y of each joint in the flat start [m]: where the fixed joint stays.
  /// @throws WrongInput for lengths of another number than that of interlinks, or without a closing.
  LinkSystem(const RigOptions& rig, const std::vector<Eigen::Vector2d>& place);

  [[nodiscard]] LinkScratch scratch() const;

  struct Outcome {
    double error = 0;  ///< largest of a row, at t + dt [m]
    bool converged = true;
  };
  /// Changes the bodies' velocities so that all rows hold at t + dt.
  /// @param from, to  schedule's clock at t and t + dt, for interlinks that close [s].
  Outcome meet(double dt, double from, double to, LinkScratch& scratch) const;

  /// Work of the last step's impulses for mean velocities of the joints [m/s] [J].
  [[nodiscard]] double work(const LinkScratch& scratch, const std::vector<Eigen::Vector3d>& joint_v) const;

 private:
  /// The joints i and j keep their distance, or joint i its coordinate `axis`.
  struct Row {
    int i = 0, j = -1, axis = -1;
    double value = 0;   ///< length in the flat start, or coordinate [m]
    double closed = 0;  ///< length in the end [m]
  };
  /// Rows k and l <= k share a pad; `sign` is +1 if it stands on the same side in both.
  struct Coupling {
    int k = 0, l = 0, pad = 0;
    double sign = 1;
  };
  /// How far a spring gives way to an impulse, and its dashpot, for a step.
  struct Spring {
    double give = 0;     ///< [m / (N s)]
    double dashpot = 0;  ///< [N s/m], less what the step itself damps
  };

  void couple();
  void set_values(double time, LinkScratch& scratch) const;
  void set_directions(LinkScratch& scratch) const;
  void set_springs(double dt, LinkScratch& scratch) const;
  [[nodiscard]] Spring spring_of(double dt) const;
  [[nodiscard]] bool acts(const LinkScratch& scratch, size_t row) const;
  void factorise(double dt, LinkScratch& scratch) const;
  // Not Eigen's SimplicialLLT: it takes as long (4.2 against 4.1 us for 42 rows), but its solve allocates.
  void eliminate(LinkScratch& scratch) const;
  void solve(LinkScratch& scratch) const;
  void push_apart(size_t row, double impulse, LinkScratch& scratch) const;
  double residuals(double dt, LinkScratch& scratch) const;
  double soften(double dt, LinkScratch& scratch, bool& changed) const;

  int pads_ = 0;
  double tolerance_ = 0;  ///< [m]
  InterlinkOptions options_;
  bool closes_ = false;   ///< lengths change
  bool springs_ = false;  ///< not rigid
  bool play_ = false;
  double damping_ = 0;  ///< of the dashpots [N s/m]
  std::vector<Row> rows_;
  std::vector<Coupling> couplings_;
  std::vector<int> envelope_;  ///< first column of each row of the factor
  std::vector<size_t> start_;  ///< where row k of the factor starts, less its first column
};

}  // namespace drapeplan
