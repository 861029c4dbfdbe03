// From node to node along the fibres of a mesh, and how long the ply is there beside the mold below it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "fem/mesh/mesh.hpp"

namespace drapeplan {

enum class Fibre { warp, weft };

/// A piece of a fibre, from node to node.
struct FibreSpan {
  std::vector<int> nodes;  ///< in order; the node that it was asked for among them
  bool from_edge = false;  ///< it begins at the ply's edge: there is no more of it
  bool to_edge = false;    ///< it ends there
  double ply = 0;          ///< length of the ply, along its nodes [m]
  double below = 0;        ///< length of the path of their feet on the mold [m]

  /// By how much the ply is longer than the mold below it: above zero it has room to rise in an arch, below
  /// zero it is a chord over a hollow [m].
  [[nodiscard]] double slack() const { return ply - below; }
};

/// Rise of an arch, half a wave of a sine, over a mold: of the height h at which its slack is
///   integral of (-curvature h sin + 1/2 (h sin)'^2) = -2/pi curvature h span + pi^2/4 h^2 / span,
/// to the second order in rise over span. 0 where there is no slack.
/// @param slack, span  [m].  @param curvature  of the mold along the fibre, > 0 in a hollow [1/m].
double arch_height(double slack, double span, double curvature = 0);

/// The mesh lines of a ply, which follow its fibres.
class FibreLines {
 public:
  explicit FibreLines(const Mesh& mesh);

  /// The next node along a fibre; nothing at the ply's edge.
  [[nodiscard]] std::optional<int> next(int node, Fibre fibre, bool forward) const;

  /// The fibre through a node, in both directions as long as `goes_on` says so of the nodes so far, of which
  /// the given one is the first, and of the next one.
  /// @param position  of nodes [m].  @param feet  of the same on the mold [m].
  [[nodiscard]] FibreSpan span(int node, Fibre fibre,
                               const std::function<bool(const std::vector<int>& way, int to)>& goes_on,
                               const std::vector<Eigen::Vector3d>& position,
                               const std::vector<Eigen::Vector3d>& feet) const;

 private:
  std::vector<std::array<int, 4>> next_;  ///< of each node: along +u, -u, +v, -v; -1: none
};

}  // namespace drapeplan
