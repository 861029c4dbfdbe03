// A scene, and the model built from it: const, shared by all candidates and threads.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/core/options.hpp"
#include "fem/core/run_summary.hpp"
#include "fem/core/start.hpp"
#include "fem/core/term.hpp"
#include "fem/law/fabric.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/rig/gripper_rig.hpp"
#include "fem/shell/shell.hpp"
#include "fem/terms/fibre_inertia.hpp"
#include "fem/terms/grips.hpp"
#include "fem/terms/loads.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// What is there. Parts that are absent add no term, no memory and no work.
struct Scene {
  Mesh mesh;
  Fabric fabric;
  FemOptions options;
  Eigen::Vector2d position{0, 0};  ///< x-y of the ply frame's origin in the flat start [m]
  double angle = 0;                ///< warp direction from +x in the flat start [rad]
  double start_height = 0;         ///< of the flat ply without a rig; with a rig the schedule says it [m]
  Start start = Start::level;      ///< `on_mold` needs a mold and no rig
  std::optional<double> gravity;   ///< [m/s^2]
  std::optional<double> damping;   ///< mass-proportional rate alpha of the unscaled ply [1/s]
  std::optional<Mold> mold;
  std::optional<double> friction;  ///< needs a mold
  std::optional<RigOptions> rig;
  std::optional<Loads> loads;
  std::vector<int> clamped;           ///< nodes that never move or turn
  std::vector<int> pinned;            ///< nodes that never move; their directors turn
  std::vector<Grip> grips;            ///< clamps that move; no node belongs to two
  std::optional<RestCriterion> rest;  ///< when a run may end before its time
};

/// The discrete system: masses, terms, stable step.
class Model {
 public:
  /// @throws std::invalid_argument with the reason for a scene that cannot be built.
  explicit Model(Scene scene);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] int node_count() const { return scene_.mesh.node_count(); }
  [[nodiscard]] const std::vector<std::unique_ptr<Term>>& terms() const { return terms_; }
  [[nodiscard]] const Shell& shell() const { return *shell_; }
  [[nodiscard]] const std::optional<GripperRig>& rig() const { return rig_; }
  [[nodiscard]] const std::optional<FibreInertia>& fibre_inertia() const { return fibre_inertia_; }
  /// All that the scene has, in words; what is not named is not there.
  [[nodiscard]] std::vector<std::string> term_names() const;
  [[nodiscard]] SummaryParts summary_parts() const;

  /// Stable step for all strains that the laws allow [s]; see stable_step() for that of a state.
  [[nodiscard]] double stable_dt() const { return stable_dt_; }
  /// Step at which fibre inertia bears the steepest ones [s]; 0 without fibre inertia.
  [[nodiscard]] double fibre_inertia_dt() const { return fibre_inertia_dt_; }
  /// The step played where it does not change with the state: step_safety times stable_dt [s].
  [[nodiscard]] double dt() const { return scene_.options.step_safety * stable_dt_; }
  /// Longest step that the actuators bear: steps that follow the state are longer than dt() [s].
  [[nodiscard]] double servo_dt() const { return servo_dt_; }
  /// Largest stable step for given stiffness bounds over the nodes' own masses [s]. Nodes that are tied or
  /// clamped count as well: what holds them only lowers frequencies.
  [[nodiscard]] double stable_dt(const NodalStiffness& stiffness) const;
  /// 2 / the stable step without viscosity: a bound of the highest frequency, dashpots counted [1/s].
  [[nodiscard]] double stable_dt(double highest_rate) const;
  [[nodiscard]] double highest_rate(const NodalStiffness& stiffness) const;
  /// Nodes that pads have let go bear stiffness with their own mass: bounds, over the pads' masses so far,
  /// are raised to hold over that.
  void bear_released(const State& state, NodalStiffness& stiffness) const;
  /// Lowers the lightness of nodes whose own rate is below the highest, so that it becomes that.
  void update_lightness(const NodalStiffness& stiffness, double highest_rate,
                        std::vector<double>& lightness) const;
  /// Damping rate on the scaled mass [1/s]: with a mass s times larger, modes are sqrt(s) times slower, and
  /// so is what damps them critically. s: of the whole ply.
  [[nodiscard]] double alpha() const { return alpha_; }

  /// Scaled masses [kg] and director inertias [kg m^2] of free nodes; 0 for clamped and tied ones; pinned
  /// ones have no mass but an inertia; padded.
  [[nodiscard]] const std::vector<double>& mass() const { return mass_; }
  [[nodiscard]] const std::vector<double>& inertia() const { return inertia_; }
  /// 1 / mass, 1 / inertia, 0 for clamped and tied nodes; padded.
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return inverse_mass_; }
  [[nodiscard]] const std::vector<double>& inverse_inertia() const { return inverse_inertia_; }

  /// Scaled mass [kg] and director inertia [kg m^2] of a node, held or not.
  [[nodiscard]] double own_mass(int node) const { return own_mass_[size_t(node)]; }
  [[nodiscard]] double own_inertia(int node) const { return gyration2_[size_t(node)] * own_mass(node); }
  /// Nodes of each pad; empty without a rig.
  [[nodiscard]] const std::vector<std::vector<int>>& pad_nodes() const { return pad_nodes_; }
  /// Of nodes that are neither tied nor clamped, scaled [kg].
  [[nodiscard]] double free_mass() const;

  /// Hash of all that a run depends on: a saved state fits a model with the same one.
  [[nodiscard]] std::uint64_t fingerprint() const;

  /// The flat ply at rest, level at `height` [m] or on the mold, as the scene says.
  [[nodiscard]] State flat_state(double height) const;

  /// Nodes whose motion is given by pads and grips.
  [[nodiscard]] const std::vector<int>& guided() const { return guided_; }

 private:
  NodalStiffness stiffness_without_fibres();
  void bear_held_nodes();
  void add_fibre_inertia(double rise);
  void add_contact(NodalStiffness& stiffness);

  Scene scene_;
  std::vector<std::unique_ptr<Term>> terms_;
  Shell* shell_ = nullptr;
  std::optional<GripperRig> rig_;
  std::optional<FibreInertia> fibre_inertia_;
  std::vector<double> mass_, inertia_, inverse_mass_, inverse_inertia_;
  std::vector<int> guided_;
  std::vector<std::vector<int>> pad_nodes_;  ///< of each pad; empty without a rig
  std::vector<double> bearing_mass_;  ///< what bears stiffness: a tied node's is its share of its pad [kg]
  std::vector<double> mobility_, turning_mobility_;  ///< 1 / bearing mass and inertia; 0 where held [padded]
  std::vector<double> own_mass_, gyration2_;         ///< of all nodes, held ones too [kg], [m^2]
  double fibre_inertia_rate_ = 0;  ///< highest of a node that does not touch, with fibre inertia [1/s]
  double stable_dt_ = 0, fibre_inertia_dt_ = 0, alpha_ = 0;
  double servo_dt_ = std::numeric_limits<double>::infinity();
};

}  // namespace drapeplan
