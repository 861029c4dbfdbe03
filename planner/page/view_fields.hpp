// Angles of a draped ply's fibres, and how much of the ply keeps within limits of them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/mesh/mesh.hpp"
#include "mapping/net.hpp"

namespace drapeplan {

/// Mean of the elements around each node; values that are not finite do not count. NaN where none does.
/// @param values  one per element.
std::vector<double> nodal_means(const Mesh& mesh, const std::vector<double>& values);

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
