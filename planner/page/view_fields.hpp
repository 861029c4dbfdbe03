// Angles of a draped ply's fibres, and how much of the ply keeps within limits of them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/mesh/mesh.hpp"
#include "mapping/net.hpp"

namespace drapeplan {

/// Mean of the elements around each node; values that are not finite do not count. NaN where none does.
/// @param values  one per element.
std::vector<double> nodal_means(const Mesh& mesh, const std::vector<double>& values);

/// Derivatives of the place with respect to u and v: along warp and weft, as long as these fibres are
/// stretched [-].
struct Fibres {
  Eigen::Vector3d warp{0, 0, 0}, weft{0, 0, 0};
};

/// In the middle of an element, the mean of its four nodes, whatever its shape in the flat ply.
/// @param position  of the nodes [m].
Fibres element_fibres(const Mesh& mesh, const std::array<int, 4>& quad,
                      const std::vector<Eigen::Vector3d>& position);

/// Angle in the middle of each element between its fibres and those of the mapped net at the same place of
/// the ply, seen along the net's normal: the larger one of warp and weft, in [0, pi] [rad]; NaN beside the
/// net.
/// @param position  of the nodes [m].
std::vector<double> fibre_angle_offsets(const Mesh& mesh, const std::vector<Eigen::Vector3d>& position,
                                        const Net& net);

/// Share of the ply's rest area where the magnitude of a field is at most `limit` [-]. Elements whose value
/// is not finite count as beyond it.
/// @param values  one per element, in the unit of the limit.
double share_within(const Mesh& mesh, const std::vector<double>& values, double limit);

}  // namespace drapeplan
