// The best drape that any schedule could make of a ply with a rig: a bound from geometry alone.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "fem/mesh/mesh.hpp"
#include "fem/rig/rig.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// The ply is a net of nodes, the mesh of a drape. A drape obeys:
///   - no fibre is stretched by more than fibre_strain: along edges of the net, and in cells at the outline
///   in
///     their middle (see fibres_of); net_strain() measures a drape so;
///   - every node lies on or above the mold, over its extent (or the mapped ply, where that is larger);
///   - a pad is a rigid disc: nodes that it holds keep their places in it; its joint stands rig.joint_offset
///     above its middle along its normal; it tilts by rig.tilt_limit at most;
///   - interlinks have the lengths, and the play, that the rig says; the fixed joint keeps its x-y.
///   - edge nodes lie within the boundary tolerance of the prescribed boundary (one way of the Hausdorff
///     distance of the score, measured along the mold, of the mid-surface).
/// It is a relaxation, so its optimum is a floor under every drape on this net that stretches fibres by no
/// more than that (within the tolerances of floor.cpp, and if no start missed the global optimum). Left out
/// are: all forces (shear, bending, friction, gravity, actuators), compression of fibres (folds finer than
/// the net are free), the way to the end, rotation limits of pads other than the tilt limit, collisions of
/// pads with the mold, interlinks with a stiffness (these may have any length).
struct FloorProblem {
  RigOptions rig;
  Mold mold;
  Mesh net;                               ///< flat; the mesh of a drape, so that both speak of the same nodes
  std::vector<std::vector<int>> held;     ///< nodes under each pad
  std::vector<Eigen::Vector3d> mapped;    ///< place of each node on the mold as mapped [m]
  std::vector<Eigen::Vector2d> flat;      ///< x-y of each node before draping [m]
  std::vector<Eigen::Vector3d> boundary;  ///< prescribed; closed polyline on the mold [m]
  Eigen::Vector2d fixed_place{0, 0};      ///< x-y of the fixed joint, used where rig.fixed is set [m]
  double thickness = 0;                   ///< of the ply; nodes are its mid-surface [m]
  /// Largest tensile strain of a fibre [-]. Simulated drapes of the shipped cases have up to 0.009.
  double fibre_strain = 0.01;
};

/// A piece of ply between two neighbouring grippers (or between the last gripper and the edge).
struct TautSpan {
  bool weft = false;       ///< its fibres: weft, else warp
  int from = -1, to = -1;  ///< grippers; -1: the ply's edge
  double shortage = 0;     ///< the path on the mold below its tautest fibre, less that fibre [m]
  double gain = 0;         ///< by how much the floor sinks per length added to all its fibres [-]
};

/// The least largest gap while the edge stays near the prescribed boundary. NaN where not converged.
struct FloorPoint {
  double boundary_tolerance = std::numeric_limits<double>::infinity();  ///< infinite: free [m]
  bool converged = false;
  std::string status;          ///< in words
  double gap = 0;              ///< least possible largest gap between underside and mold [m]
  double rms_gap = 0;          ///< of the net found; nearly the smallest with that largest gap [m]
  double boundary_offset = 0;  ///< largest distance of an edge node from the boundary, along the mold [m]
  double violation = 0;        ///< largest error of a length [m]
  double wall_seconds = 0;
  int iterations = 0;
  std::vector<Eigen::Vector3d> nodes;         ///< mid-surface [m]
  std::vector<double> gaps;                   ///< of each node [m]
  std::vector<Eigen::Vector3d> pads, joints;  ///< centres and joints [m]
  std::vector<TautSpan> spans;                ///< that hold the floor up, the most important first
};

struct FloorOptions {
  std::vector<double> tolerances{0.002, 0.005, 0.010, 0.020,
                                 std::numeric_limits<double>::infinity()};  ///< [m]
  int random_starts = 1;  ///< beside the mapped and the flat net
  unsigned seed = 1;
};

struct FloorFront {
  std::vector<FloorPoint> points;  ///< in the order of the tolerances
  /// At the middle tolerance: how many starts there were, converged, and came to the smallest gap; and the
  /// largest difference of their gaps [m].
  int starts = 0, converged = 0, agreed = 0;
  double start_spread = 0;
  double wall_seconds = 0;
};

/// Largest strain of a fibre of a net at these places [m], in the measure of FloorProblem::fibre_strain [-]:
/// a drape for which it is smaller lies above the floor.
double net_strain(const FloorProblem& problem, const std::vector<Eigen::Vector3d>& nodes);

/// Never throws for a geometry that cannot be satisfied: `converged` is false then. Calls from several
/// threads are served one after the other (see ipopt_mutex).
FloorFront solve_floor(const FloorProblem& problem, const FloorOptions& options = {});

/// One line per boundary tolerance, with a head: tolerance, gap, r.m.s. gap, offset [mm].
std::string front_table(const FloorFront& front);

/// What the floor at the tolerance nearest to `tolerance` [m] means, for a process engineer, in a few
/// sentences.
std::string explain_floor(const FloorProblem& problem, const FloorFront& front, double tolerance = 0.010);

}  // namespace drapeplan
