// Masses of the nodes and who holds them.
#pragma once

#include <vector>

#include "fem/core/term.hpp"
#include "fem/model/scene.hpp"
#include "fem/rig/gripper_rig.hpp"

namespace drapeplan {

/// Mass of each node, unscaled [kg]. @param area  of each node [m^2].
std::vector<double> unscaled_masses(const Scene& scene, const std::vector<double>& area);

/// Scaled masses and director inertias. A node has its own ones whether or not something holds it; the motion
/// of free nodes has the mass of mass(), which is 0 for held ones.
class NodalMasses {
 public:
  NodalMasses() = default;
  /// @param unscaled  of each node [kg];  @param scaling  factor on it
  /// @param ply  bounds of the ply: directors weigh as much as their stiffness demands (see
  ///             fem/shell/bounds.hpp), so that they never govern the step.
  NodalMasses(const std::vector<double>& unscaled, double scaling, const NodalStiffness& ply);

  /// Raises masses to `needed` [kg m/N] times the node's stiffness.
  void raise(double needed, const NodalStiffness& stiffness);

  /// Takes note of the scene's clamped, pinned and gripped nodes.
  /// @throws WrongInput if a grip holds no node, or one that is held already.
  void hold(const Scene& scene);
  /// Likewise of the nodes under pads. @throws WrongInput if one is held already.
  void hold(const GripperRig& rig);
  /// Takes the masses of held nodes away: the last step, since pads weigh with those of their nodes.
  void close();

  [[nodiscard]] bool all_held() const;

  /// Scaled mass [kg], squared gyration of the director [m^2] and its inertia [kg m^2] of nodes, held or not.
  [[nodiscard]] const std::vector<double>& own_mass() const { return own_mass_; }
  [[nodiscard]] double own_mass(int node) const { return own_mass_[size_t(node)]; }
  [[nodiscard]] const std::vector<double>& gyration2() const { return gyration2_; }
  [[nodiscard]] double own_inertia(int node) const { return gyration2_[size_t(node)] * own_mass(node); }
  /// Of the whole ply, over that without scaling.
  [[nodiscard]] double scale() const;

  /// Scaled masses [kg] and director inertias [kg m^2] of free nodes; 0 for clamped and tied ones; pinned
  /// ones have no mass but an inertia; padded.
  [[nodiscard]] const std::vector<double>& mass() const { return mass_; }
  [[nodiscard]] const std::vector<double>& inertia() const { return inertia_; }
  /// 1 / mass, 1 / inertia, 0 for clamped and tied nodes; padded.
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return inverse_mass_; }
  [[nodiscard]] const std::vector<double>& inverse_inertia() const { return inverse_inertia_; }
  /// Of nodes that are neither tied nor clamped, scaled [kg].
  [[nodiscard]] double free_mass() const;

  /// Nodes whose motion is given by pads and grips.
  [[nodiscard]] const std::vector<int>& guided() const { return guided_; }

 private:
  double unscaled_ = 0;  ///< of the whole ply [kg]
  std::vector<double> own_mass_, gyration2_;
  std::vector<double> mass_, inertia_, inverse_mass_, inverse_inertia_;
  std::vector<int> held_;  ///< nodes that neither move nor turn on their own
  std::vector<int> guided_;
};

}  // namespace drapeplan
