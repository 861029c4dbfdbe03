// In place of fem/run/move_grips.cpp.
#include "fem/run/move_grips.hpp"
#include "tests/bench/absent/absent.hpp"

namespace drapeplan {

Eigen::Vector3d grip_displacement(const Grip& /*grip*/, double /*t*/) {
  absent("grips");
}
void move_grips(const Model& /*model*/, State& /*state*/, Workspace& /*work*/) {
  absent("grips");
}
std::vector<Eigen::Vector3d> grip_forces(const Model& /*model*/, const State& /*state*/) {
  absent("grips");
}

}  // namespace drapeplan
