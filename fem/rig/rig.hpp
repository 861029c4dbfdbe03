// The gripper grid as built: what is fixed about it, whatever the schedule.
#pragma once

#include <Eigen/Core>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace drapeplan {

/// Directions in which actuators drive the joints.
enum class Driven {
  z,    ///< x and y follow the ply, interlinks and the fixed joint
  xyz,  ///< each direction by an actuator of its own; no interlinks, no fixed joint
};

/// Least and largest angle [rad] of a pad about the two in-plane axes of the ply's frame in the flat start
/// (u: warp, v: weft; they stay in the world). With the pad's unit normal n = (n_u, n_v, n_z):
///   about the warp  atan2(-n_v, n_z),  > 0: the normal leans towards -v (right-handed about +u)
///   about the weft  atan2( n_u, n_z),  > 0: the normal leans towards +u (right-handed about +v)
/// Both hold the flat start, so least <= 0 <= largest.
struct RotationLimits {
  Eigen::Vector2d about_warp{-0.5 * std::numbers::pi, 0.5 * std::numbers::pi};
  Eigen::Vector2d about_weft{-0.5 * std::numbers::pi, 0.5 * std::numbers::pi};
};

inline auto fields_of(const RotationLimits& of) {
  const auto& [about_warp, about_weft] = of;
  return std::tie(about_warp, about_weft);
}

/// What joins neighbouring joints: rigid bars, unless there is play or a stiffness. The length of each goes
/// smoothly from the spacing to its own during the closing; the stops of the play go with it.
struct InterlinkOptions {
  std::vector<double> lengths;      ///< in the order of interlinks() [m]; empty: all as long as the spacing
  Eigen::Vector2d closing{0, 0};    ///< from when to when they change, schedule's clock [s]
  Eigen::Vector2d play{0, 0};       ///< how much shorter and longer than the length the stops let it be [m]
  std::optional<double> stiffness;  ///< of a spring in place of the bar, or of the stops [N/m]; absent: rigid
  double damping_ratio = 1;         ///< of two bare pads on that spring

  [[nodiscard]] bool has_play() const { return play.maxCoeff() > 0; }
};

inline auto fields_of(const InterlinkOptions& of) {
  const auto& [lengths, closing, play, stiffness, damping_ratio] = of;
  return std::tie(lengths, closing, play, stiffness, damping_ratio);
}

/// Rectangular grid of grippers, centred on the ply, numbered row by row: the rows run along the warp.
struct RigOptions {
  int columns = 0;                                  ///< along the warp
  int rows = 0;                                     ///< along the weft
  double spacing = 0;                               ///< [m]
  double pad_radius = 0.020;                        ///< discs tied to the ply [m]
  double pad_mass = 0.1;                            ///< moving mass of one gripper [kg]
  double joint_offset = 0.005;                      ///< joint above the ply along the pad's normal [m]
  double tilt_limit = 60 * std::numbers::pi / 180;  ///< largest angle between pad normal and vertical [rad]
  std::optional<RotationLimits> rotation_limits;    ///< beside the tilt limit
  Driven driven = Driven::z;
  std::optional<InterlinkOptions> interlinks = InterlinkOptions();  ///< between neighbouring joints
  std::optional<std::array<int, 2>> fixed;  ///< gripper [i, j] whose joint is fixed in-plane
  double actuator_stiffness = 1e4;          ///< [N/m]
  double actuator_force_limit = 50;         ///< [N]
  double max_velocity = 0.2;                ///< of a joint, vertical or in-plane [m/s]
  std::optional<double> max_acceleration;   ///< of a joint, vertical or in-plane [m/s^2]; absent: no limit
  double blend_time = 0.1;                  ///< over which a change of velocity is spread [s]
  /// From the end of the last stroke until all suction ends [s]; absent: the ply is held to the end.
  std::optional<double> release_time;

  [[nodiscard]] int count() const { return columns * rows; }
  /// People call a gripper [i, j], i along the warp, j along the weft, both from 1.
  [[nodiscard]] std::array<int, 2> indices(int gripper) const {
    return {gripper % columns + 1, gripper / columns + 1};
  }
  [[nodiscard]] int gripper_at(const std::array<int, 2>& indices) const {
    return (indices[1] - 1) * columns + indices[0] - 1;
  }
  /// "[i, j]"
  [[nodiscard]] std::string name(int gripper) const;
  /// Place of gripper `index` in the ply frame (u, v) [m].
  [[nodiscard]] Eigen::Vector2d place(int index) const {
    return {(index % columns - 0.5 * (columns - 1)) * spacing,
            (index / columns - 0.5 * (rows - 1)) * spacing};
  }
};

/// Without the limits of schedules: what a schedule commands is its own matter.
inline auto fields_of(const RigOptions& of) {
  const auto& [columns, rows, spacing, pad_radius, pad_mass, joint_offset, tilt_limit, rotation_limits,
               driven, interlinks, fixed, actuator_stiffness, actuator_force_limit, max_velocity,
               max_acceleration, blend_time, release_time] = of;
  return std::tie(columns, rows, spacing, pad_radius, pad_mass, joint_offset, tilt_limit, rotation_limits,
                  driven, interlinks, fixed, actuator_stiffness, actuator_force_limit);
}

/// Mesh lines through columns of pads along u, and through rows of them along v [m], increasing. The lines of
/// a pad are so far apart, `mesh_size` or less, that the nodes which it holds span the area of its disc:
/// three at least, however large `mesh_size` is.
std::vector<double> column_places(const RigOptions& rig, double mesh_size);
std::vector<double> row_places(const RigOptions& rig, double mesh_size);

/// How far from its centre a pad holds nodes [m]: so that the nodes under a pad that lies wholly on the ply
/// span an area as near to its disc's as can be. A cut at the radius itself would leave discs a third too
/// small.
/// @param rest  places of the nodes (u, v) [m].
double reach_of_pads(const RigOptions& rig, const std::vector<Eigen::Vector2d>& rest);

/// Pairs of neighbouring grippers (indices), each joined by an interlink; warp direction first, in fixed
/// order.
std::vector<std::array<int, 2>> interlinks(const RigOptions& rig);

/// Length of the interlink of that index once they are closed [m]; needs interlinks.
double interlink_length(const RigOptions& rig, size_t index);

}  // namespace drapeplan
