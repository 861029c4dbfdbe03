// The model built from a scene: const, shared by all candidates and threads.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/core/run_summary.hpp"
#include "fem/core/term.hpp"
#include "fem/model/masses.hpp"
#include "fem/model/scene.hpp"
#include "fem/model/step_bounds.hpp"
#include "fem/rig/gripper_rig.hpp"
#include "fem/shell/shell.hpp"
#include "fem/terms/fibre_inertia.hpp"

namespace drapeplan {

/// The discrete system: masses, terms, stable step.
class Model {
 public:
  /// @throws WrongInput with the reason for a scene that cannot be built.
  explicit Model(Scene scene);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] int node_count() const { return scene_.mesh.node_count(); }
  [[nodiscard]] const std::vector<std::unique_ptr<Term>>& terms() const { return terms_; }
  [[nodiscard]] const Shell& shell() const { return *shell_; }
  [[nodiscard]] const std::optional<GripperRig>& rig() const { return rig_; }
  [[nodiscard]] const std::optional<FibreInertia>& fibre_inertia() const { return fibre_inertia_; }
  [[nodiscard]] const NodalMasses& masses() const { return masses_; }
  [[nodiscard]] const StepBounds& bounds() const { return bounds_; }
  /// All that the scene has, in words; what is not named is not there.
  [[nodiscard]] std::vector<std::string> term_names() const;
  [[nodiscard]] SummaryParts summary_parts() const;

  /// Stable step for all strains that the laws allow [s]; see stable_step() for that of a state.
  [[nodiscard]] double stable_dt() const { return stable_dt_; }
  /// Step at which fibre inertia carries the steepest fibres [s]; 0 without fibre inertia.
  [[nodiscard]] double fibre_inertia_dt() const { return fibre_inertia_dt_; }
  /// The step played where it does not change with the state: step_safety times stable_dt [s].
  [[nodiscard]] double dt() const { return scene_.options.step_safety * stable_dt_; }
  /// Longest step that the actuators can follow: steps that follow the state are longer than dt() [s].
  [[nodiscard]] double actuator_dt() const { return actuator_dt_; }
  /// Damping rate on the scaled mass [1/s]: with a mass s times larger, modes are sqrt(s) times slower, and
  /// so is what damps them critically. s: of the whole ply.
  [[nodiscard]] double alpha() const { return alpha_; }

  // Of masses(), for the loops over nodes.
  [[nodiscard]] const std::vector<double>& mass() const { return masses_.mass(); }
  [[nodiscard]] const std::vector<double>& inertia() const { return masses_.inertia(); }
  [[nodiscard]] const std::vector<double>& inverse_mass() const { return masses_.inverse_mass(); }
  [[nodiscard]] const std::vector<double>& inverse_inertia() const { return masses_.inverse_inertia(); }
  [[nodiscard]] double free_mass() const { return masses_.free_mass(); }
  [[nodiscard]] const std::vector<int>& guided() const { return masses_.guided(); }
  /// Nodes of each pad; empty without a rig.
  [[nodiscard]] const std::vector<std::vector<int>>& pad_nodes() const { return bounds_.pad_nodes(); }

  /// See flat_start().
  [[nodiscard]] State flat_state(double height) const;

 private:
  NodalStiffness add_shell();
  void add_loads(const std::vector<double>& unscaled, const std::vector<double>& area,
                 NodalStiffness& stiffness);
  NodalStiffness stiffness_without_fibres();
  void add_rig();
  void add_contact(NodalStiffness& stiffness);
  void add_fibre_inertia();
  void limit_to_actuators();

  Scene scene_;
  std::vector<std::unique_ptr<Term>> terms_;
  Shell* shell_ = nullptr;
  std::optional<GripperRig> rig_;
  std::optional<FibreInertia> fibre_inertia_;
  NodalMasses masses_;
  StepBounds bounds_;
  double fibre_inertia_rate_ = 0;  ///< highest of a node that does not touch, with fibre inertia [1/s]
  double stable_dt_ = 0, fibre_inertia_dt_ = 0, alpha_ = 0;
  double actuator_dt_ = std::numeric_limits<double>::infinity();
};

}  // namespace drapeplan
