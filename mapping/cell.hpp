// One element of the energy mapping: three corners are known, the fourth is found.
#pragma once

#include <Eigen/Core>

#include "mapping/mold.hpp"

namespace drapeplan {

/// Known corners of an element. `first` and `second` are the neighbours of `base` along the two fibre
/// families.
struct Cell {
  Eigen::Vector3d base, first, second;         ///< on the mold [m]
  double first_length = 0, second_length = 0;  ///< flat edge lengths [m], > 0
};

struct FreeCorner {
  Eigen::Vector3d point;   ///< on the mold, opposite of `base` [m]; NaN where the mold ends
  bool converged = false;  ///< the last Newton step was below 1e-12 of the shorter edge
};

/// Shear angle at the middle of the bilinear element with these corners, of which p10 lies from p00 along the
/// warp and p01 along the weft: pi/2 minus the angle between the fibres [rad].
double middle_shear(const Eigen::Vector3d& p00, const Eigen::Vector3d& p10, const Eigen::Vector3d& p01,
                    const Eigen::Vector3d& p11);

/// Minimises the fibre strain energy over the free corner's (x, y). [Krogh], Eq. (3), from the parallelogram.
FreeCorner place_free_corner(const Mold& mold, const Cell& cell);

}  // namespace drapeplan
