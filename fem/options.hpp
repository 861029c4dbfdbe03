// Numerical settings of one FE run: a fidelity is a value of this type.
#pragma once

namespace drapeplan {

struct FemOptions {
  double mesh_size = 0.010;  ///< largest element edge [m]
  int section_points = 3;    ///< through the thickness: 1, 3 or 5
  double mass_scaling = 20;  ///< factor on the mass; gravity acts on the unscaled mass (seed: up to 20)
  double time_scaling = 1;   ///< the schedule is played this many times faster than written
  double step_safety = 0.9;  ///< share of the estimated stable step
  double hourglass = 1;      ///< hourglass stiffness over the physical one of a fibre in compression
  double contact_stiffness = 0.1;  ///< of a free node, over its membrane stiffness
  double contact_damping = 0.2;    ///< share of the critical damping of a node on its contact spring
};

}  // namespace drapeplan
