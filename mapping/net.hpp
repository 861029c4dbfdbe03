// Kinematic energy mapping: from the flat ply to the draped net on the mold.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/mold.hpp"
#include "mapping/polygon.hpp"

namespace drapeplan {

/// How the two fibre lines through the start point run over the mold.
enum class Generators {
  perpendicular,  ///< geodesics at right angles on the surface; the first one projects to the warp direction
  axes,           ///< geodesics whose directions at the start project to the warp and weft directions
  mid_sides,      ///< geodesics from the start point to the four mid-sides of the mold's extent (the text of
                  ///< [Krogh])
  /// The warp starts as with `perpendicular`; each other step goes where its cell is sheared least (C. Krogh
  /// and others, "A simple MATLAB draping code for fiber-reinforced composites", 2021).
  minimum_shear,
  steered,  ///< along lines that are given on the mold, as a machine lays fibres
};

/// Flat ply. Ply frame: u along the warp, v along the weft; origin in a rectangle's middle, or as the
/// outline's points say [m].
struct Ply {
  double width = 0;                ///< along u; of the bounding box if there is an outline [m]
  double height = 0;               ///< along v; likewise [m]
  Eigen::Vector2d position{0, 0};  ///< x-y place of the ply frame's origin before draping [m]
  double angle = 0;                ///< warp direction from +x [rad]
  Polygon outline = {};            ///< simple, either way round; empty: the rectangle [m]
};

struct MappingOptions {
  Generators generators = Generators::axes;
  Eigen::Vector2d start{0, 0};      ///< point of the mold where the mapping starts (x, y) [m]
  Eigen::Vector2d ply_start{0, 0};  ///< point of the ply that is placed there (u, v) [m]
  double cell_size = 0.005;         ///< largest edge of a net cell [m]
  /// Lines of steered generators, straight in plan between points (x, y), in the order of growing u and v; both pass
  /// through `start`. One may be empty: its generator is the geodesic at right angles to the other one on the
  /// surface. Beyond its ends a line goes on as a geodesic [m].
  std::vector<Eigen::Vector2d> warp_line = {}, weft_line = {};
};

/// By how much `start` may lie beside a line, whose points are rounded in files [m].
inline constexpr double kOffLine = 1e-4;

/// The mapped ply: a structured net of nodes on the mold; node (i, j) lies at u[i], v[j] of the ply.
struct Net {
  std::vector<double> u, v;            ///< increasing ply coordinates of the net lines [m]
  std::vector<Eigen::Vector3d> nodes;  ///< node (i, j) at i + j * u.size(), on the mold [m]
  bool converged = true;               ///< every cell's minimisation met its tolerance

  [[nodiscard]] const Eigen::Vector3d& node(int i, int j) const {
    return nodes[size_t(i) + size_t(j) * u.size()];
  }
};

/// The ply's corners, counter-clockwise: its outline, or the rectangle's corners from (-,-).
Polygon corners_of(const Ply& ply);

/// Maps the ply's bounding box onto the mold. [Krogh], "Energy Mapping Algorithm" (after Bergsma and Huisman): the
/// fibre lines through the start point are geodesics, or as `Generators` says; every other node is the free corner of
/// a bilinear element that minimises the fibre strain energy of Eq. (3).
/// @throws NotFinished with the place where the mold ends or the minimisation fails; WrongInput where lines of
/// steered generators miss the start or cross it the wrong way round.
Net map_ply(const Mold& mold, const Ply& ply, const MappingOptions& options);

/// Mapped place of the ply point (u, v) [m]: bicubic in x-y between net nodes, then put on the mold.
/// @throws std::out_of_range outside the net.
Eigen::Vector3d mapped_point(const Net& net, const Mold& mold, const Eigen::Vector2d& uv);

/// Net nodes along the ply's outline, counter-clockwise in the ply from corner (-,-); closed: the first point
/// is repeated at the end [m].
std::vector<Eigen::Vector3d> prescribed_boundary(const Net& net);

/// Mapped outline of the ply, counter-clockwise from its first corner; closed [m]. Of a rectangle: the above.
/// Else mapped points along each edge, no further apart in the ply than the net's widest cell.
std::vector<Eigen::Vector3d> prescribed_boundary(const Net& net, const Mold& mold, const Ply& ply);

/// The four mapped corners of the net, that is of the ply's bounding box, in ply order (-,-), (+,-), (+,+),
/// (-,+) [m].
std::vector<Eigen::Vector3d> mapped_corners(const Net& net);

/// Shear angle at the middle of each cell [rad]: change of the angle between warp and weft, > 0 where the
/// angle closes. Cell (i, j) at i + j * (u.size() - 1).
std::vector<double> shear_field(const Net& net);

}  // namespace drapeplan
