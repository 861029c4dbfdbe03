// The prescribed boundary as smooth limits for the nodes on a ply's edge.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planner/reach/floor_nlp.hpp"

namespace drapeplan {

/// A tube of radius `tolerance` about the boundary near the given nodes, seen along the mold: the signed
/// distance from the tangent at the nearest point, outwards positive, lies within +- tolerance. At a corner
/// that points outwards a node keeps both sides' upper limits and the lower one of the side that it is
/// farther beyond; so the tube's outer corner is sharp there, not round: a little larger, a floor all the
/// same. At a corner that points inwards: likewise with signs changed. None for an infinite tolerance.
/// @param nodes  places of all nodes [m].
std::vector<EdgeLimit> edge_limits(const FloorProblem& problem, const std::vector<Eigen::Vector3d>& nodes,
                                   double tolerance);

/// By how much two sets of limits differ for the nodes where they stand [m]: largest difference of distances;
/// infinite where the sides differ.
double limit_change(const std::vector<EdgeLimit>& before, const std::vector<EdgeLimit>& after,
                    const std::vector<Eigen::Vector3d>& nodes);

/// Largest distance of an edge node from the boundary, less its part along the mold's normal [m].
double edge_offset(const FloorProblem& problem, const std::vector<Eigen::Vector3d>& nodes);

}  // namespace drapeplan
