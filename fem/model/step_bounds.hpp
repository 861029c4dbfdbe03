// How large a step may be for given stiffness bounds: what mass carries them.
#pragma once

#include <vector>

#include "fem/core/term.hpp"
#include "fem/model/masses.hpp"
#include "fem/model/scene.hpp"
#include "fem/rig/gripper_rig.hpp"

namespace drapeplan {

/// Nodes that are held carry any stiffness; those under pads carry it with their share of the pad.
class StepBounds {
 public:
  StepBounds() = default;
  /// @param rig  null without one;  @param masses  before held ones are taken away.
  StepBounds(const Scene& scene, const NodalMasses& masses, const GripperRig* rig);

  /// Largest stable step for given bounds [s]. Nodes that are tied or clamped count as well: what holds them
  /// only lowers frequencies.
  [[nodiscard]] double stable_dt(const NodalStiffness& stiffness) const;
  [[nodiscard]] double stable_dt(double highest_rate) const;
  /// 2 / the stable step without viscosity: a bound of the highest frequency, dashpots counted [1/s].
  [[nodiscard]] double highest_rate(const NodalStiffness& stiffness) const;

  /// Nodes that pads have let go carry stiffness with their own mass: bounds, over the pads' masses so far,
  /// are raised to hold over that.
  void raise_for_released_nodes(const State& state, NodalStiffness& stiffness) const;
  /// Lowers the lightness of nodes whose own rate is below the highest, so that it becomes that.
  void update_lightness(const NodalStiffness& stiffness, double highest_rate,
                        std::vector<double>& lightness) const;

  /// Mass that carries the stiffness of a node: a tied one's is its share of its pad [kg].
  [[nodiscard]] const std::vector<double>& carrying_mass() const { return carrying_mass_; }
  /// 1 / carrying mass, 0 where the node is held [1/kg, padded].
  [[nodiscard]] const std::vector<double>& mobility() const { return mobility_; }
  /// Nodes of each pad; empty without a rig.
  [[nodiscard]] const std::vector<std::vector<int>>& pad_nodes() const { return pad_nodes_; }

 private:
  int nodes_ = 0;
  double viscous_share_ = 1;
  std::vector<double> own_mass_, carrying_mass_;
  std::vector<double> mobility_, turning_mobility_;
  std::vector<std::vector<int>> pad_nodes_;
};

/// Largest 2 / dt with contact over that without it.
double contact_rise(const FemOptions& options);

/// Longest step that the actuators can follow [s].
double longest_actuator_step(const RigOptions& rig);

}  // namespace drapeplan
