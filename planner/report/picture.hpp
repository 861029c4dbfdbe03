// The gap between ply and mold as a contour picture seen from above, one panel per drape.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fem/mesh/mesh.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// One drape.
struct DrapePanel {
  std::string title;     ///< "uniform"
  std::string subtitle;  ///< a second, smaller line; may be empty
  Mesh mesh;
  std::vector<Eigen::Vector3d> position;  ///< nodes [m]
  std::vector<double> gap;                ///< nodes [m], see `gaps`
  std::vector<Eigen::Vector3d> boundary;  ///< prescribed, closed [m]; may be empty
  std::vector<Eigen::Vector3d> pads;      ///< centres [m]; may be empty
  double pad_radius = 0;                  ///< [m]
  /// Where the edge is farthest from the boundary: point of the edge, point of the boundary [m].
  std::optional<std::array<Eigen::Vector3d, 2>> largest_offset;
  std::vector<Eigen::Vector3d> folds = {};  ///< marked with their numbers, from 1 [m]
  /// How much each gripper matters, 0 to 1: its pad is filled so strongly; empty: none is.
  std::vector<double> weights = {};
  std::vector<std::string> pad_names = {};  ///< written below their pads; empty: none are
};

/// SVG of the panels side by side with one colour scale from 0 to the largest gap of all panels [mm]: filled
/// bands of the gap (linear between nodes of a bilinear refinement), the ply's outline, the prescribed
/// boundary as a red line with circles, the pads as thin circles, the places of largest gap and largest
/// boundary offset with their values, the mold's extent as a frame. Values that are not finite are drawn as
/// zero.
/// @throws std::invalid_argument without panels or if a panel's sizes differ.
std::string drape_picture(const std::vector<DrapePanel>& panels, const Extent& mold_extent);

}  // namespace drapeplan
