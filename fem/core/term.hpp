// A scene is a list of terms: each adds forces to nodes; what a scene does not need is not in the list.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fem/core/lanes.hpp"
#include "fem/core/state.hpp"

namespace drapeplan {

/// Nodes of a chunk: what contact looks up for them stays in the cache.
inline constexpr int kChunk = 8 * kLanes;

/// Forces of one term on the nodes, booked under one entry of the ledger.
struct Forces {
  Book book = Book::internal;
  VectorField force;   ///< [N]
  VectorField moment;  ///< on directors [N m]; empty if the term never touches them
  /// Of each chunk: above 0 if its forces are zero, and stay so until a node has moved by as much [m]; empty
  /// if the term has forces everywhere. Good for the step after `step`.
  std::vector<double> clearance{};
  std::int64_t step = -2;

  [[nodiscard]] bool idle(size_t chunk) const { return !clearance.empty() && clearance[chunk] > 0; }
};

/// A diagonal that is nowhere below the stiffness of all terms: u.K u <= sum over nodes of translation |x|^2
/// + rotation |d|^2. Bounds of terms add, and those of elements at their nodes; then no squared frequency is
/// above the largest bound over mass (Fried's element bound, weighted per node). Dashpots likewise.
struct NodalStiffness {
  explicit NodalStiffness(int nodes)
      : translation(padded(nodes), 0.0), rotation(padded(nodes), 0.0), damping(padded(nodes), 0.0) {}
  void clear() {
    for (auto* list : {&translation, &rotation, &damping}) std::fill(list->begin(), list->end(), 0.0);
  }

  std::vector<double> translation;  ///< [N/m]
  std::vector<double> rotation;     ///< of directors [N m]
  std::vector<double> damping;      ///< of velocities half a step before the force [N s/m]
};

/// A term is const after the model is built; candidates and threads share it. What changes lives in State,
/// what may be thrown away at any step lives in the term's entries of the workspace.
class Term {
 public:
  virtual ~Term() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Entries of the workspace that this term writes, in the order in which forces() gets them.
  [[nodiscard]] virtual std::vector<Forces> entries() const = 0;
  /// Adds the term's stiffness bounds over all that its laws allow, in the rest shape.
  virtual void add_stiffness(NodalStiffness& stiffness) const = 0;
  /// Adds bounds that hold at a state and near it; what is constant need not tell the two apart.
  virtual void add_tangent(const State& /*state*/, NodalStiffness& stiffness) const {
    add_stiffness(stiffness);
  }
  /// Overwrites the term's entries with its forces at the state's positions. Contact moves its anchors.
  virtual void forces(State& state, Forces* entries) const = 0;
};

}  // namespace drapeplan
