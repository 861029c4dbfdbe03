// The ply: all its shell elements as one term.
#pragma once

#include <memory>

#include "fem/fabric.hpp"
#include "fem/mesh.hpp"
#include "fem/options.hpp"
#include "fem/shell_kernel.hpp"
#include "fem/snapshot.hpp"
#include "fem/term.hpp"

namespace drapeplan {

/// Stored energy of the ply [J].
struct ShellEnergy {
  double fabric = 0, hourglass = 0;
};

/// What observers may ask of the ply beyond the interface of a term.
class Shell : public Term {
 public:
  /// With rates: that of the slowest curves; the rest is taken, not stored.
  [[nodiscard]] virtual ShellEnergy stored_energy(const State& state) const = 0;
  /// Fills the element fields of a snapshot: shear angle and fibre strains at mid-thickness.
  virtual void strains(const State& state, Snapshot& snapshot) const = 0;
  /// Number of lagged strains that the state must hold; 0 without rates.
  [[nodiscard]] virtual size_t lagged_count() const = 0;
};

/// Builds the term for options.section_points (1, 3 or 5).
/// @throws std::invalid_argument for another number or an element of area <= 0.
std::unique_ptr<Shell> make_shell(const Mesh& mesh, const Fabric& fabric, const FemOptions& options);

}  // namespace drapeplan
