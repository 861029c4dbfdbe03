#include "fem/terms/grips.hpp"

#include <algorithm>

namespace drapeplan {

Eigen::Vector3d grip_displacement(const Grip& grip, double t) {
  // The speed rises as 3 s^2 - 2 s^3 over the ramp; its integral is s^3 - s^4 / 2.
  const double s = grip.ramp > 0 ? std::clamp(t / grip.ramp, 0.0, 1.0) : 1;
  return (grip.ramp * s * s * s * (1 - 0.5 * s) + std::max(t - grip.ramp, 0.0)) * grip.velocity;
}

}  // namespace drapeplan
