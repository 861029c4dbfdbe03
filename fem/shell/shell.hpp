// The ply: all its shell elements as one term.
#pragma once

#include <memory>

#include "fem/core/options.hpp"
#include "fem/core/snapshot.hpp"
#include "fem/core/term.hpp"
#include "fem/law/fabric.hpp"
#include "fem/mesh/mesh.hpp"

namespace drapeplan {

/// Stored energy of the ply [J].
struct ShellEnergy {
  double fabric = 0, hourglass = 0;
};

/// What observers may ask of the ply beyond the interface of a term.
class Shell : public Term {
 public:
  /// Like add_stiffness, with the steepest slopes of the slowest curves.
  virtual void add_slow_stiffness(NodalStiffness& stiffness) const = 0;
  /// Like add_stiffness, without what fibre inertia carries.
  virtual void add_stiffness_without_fibres(NodalStiffness& stiffness) const = 0;
  /// Of the fibres that added mass may carry, by the slowest curves.
  virtual void add_fibre_stiffness(NodalStiffness& stiffness) const = 0;
  /// By element: whether mass on its edges can carry its fibres.
  [[nodiscard]] virtual std::vector<char> with_fibre_inertia() const = 0;
  /// Tells at which step [s] mass on edges carries the steepest fibres: bulk viscosity damps them as well.
  virtual void set_fibre_inertia_step(double stable_dt) = 0;
  /// What that mass must carry: force per width and strain [N/m].
  [[nodiscard]] virtual double fibre_inertia_stretch() const = 0;
  /// The section's tangents at a state, for add_bounds: section_count() numbers.
  /// @return the steepest force per width and strain of a fibre that added mass carries, over
  /// fibre_inertia_stretch().
  virtual double look_at_sections(const State& state, std::vector<double>& sections) const = 0;
  [[nodiscard]] virtual size_t section_count() const = 0;
  /// Adds bounds of all elements with these sections, times each node's lightness.
  /// @param lightness  of each node [padded], in (0, 1]: see CornerShares.
  virtual void add_bounds(const std::vector<double>& sections, const std::vector<double>& lightness,
                          NodalStiffness& stiffness) const = 0;
  /// Moves the remembered strains by so much (beyond zero where they are smaller) that every fibre in
  /// compression and every angle counts as growing: the stiffer side where a law tells growth from decline.
  virtual void set_lagged_strains(State& state, double by) const = 0;
  /// With rates: that of the slowest curves; the rest is taken, not stored.
  [[nodiscard]] virtual ShellEnergy stored_energy(const State& state) const = 0;
  /// Fills the element fields of a snapshot: shear angle and fibre strains at mid-thickness.
  virtual void strains(const State& state, Snapshot& snapshot) const = 0;
  /// Number of strains that the state must remember for the elements.
  [[nodiscard]] virtual size_t history_count() const = 0;
};

/// Builds the term for options.section_points (1, 3 or 5).
/// @throws WrongInput for another number or an element of area <= 0.
std::unique_ptr<Shell> make_shell(const Mesh& mesh, const Fabric& fabric, const FemOptions& options);

}  // namespace drapeplan
