// In place of gripper_rig.cpp, check_schedule.cpp, interlinks.cpp and rotation_stop.cpp of fem/rig.
#include "fem/rig/gripper_rig.hpp"

#include "tests/bench/absent/absent.hpp"

namespace drapeplan {
namespace {

constexpr const char* kRig = "gripper rig";

}  // namespace

LinkSystem::LinkSystem(const RigOptions& /*rig*/, const std::vector<Eigen::Vector2d>& /*place*/) {
  absent(kRig);
}

RotationStop::RotationStop(const RigOptions& /*rig*/, double /*turn*/) : tilt_limit_(0), cosine_(1) {
  absent(kRig);
}

GripperRig::GripperRig(const RigOptions& rig, const std::vector<Eigen::Vector2d>& /*rest*/,
                       const std::vector<double>& /*mass*/, const std::vector<double>& /*inertia*/,
                       std::vector<Eigen::Vector2d> place, double turn)
    : links_(rig, place), stop_(rig, turn) {
  absent(kRig);
}
std::vector<std::vector<int>> GripperRig::tied_by_pad() const {
  absent(kRig);
}
void GripperRig::check(const Schedule& /*schedule*/) const {
  absent(kRig);
}
std::vector<double> GripperRig::mass_ratios(const std::vector<double>& /*mass*/,
                                            const std::vector<double>& /*inertia*/) const {
  absent(kRig);
}
void GripperRig::place(State& /*state*/, double /*z*/) const {
  absent(kRig);
}
RigScratch GripperRig::scratch() const {
  absent(kRig);
}
double GripperRig::lag(const State& /*state*/, const RigDrive& /*drive*/, int /*g*/) const {
  absent(kRig);
}
bool GripperRig::saturated(const State& /*state*/, const RigDrive& /*drive*/, int /*g*/) const {
  absent(kRig);
}
void GripperRig::let_go(State& /*state*/, const RigDrive& /*drive*/) const {
  absent(kRig);
}
void GripperRig::kick(State& /*state*/, const RigDrive& /*drive*/, double /*alpha*/,
                      const TiedFields& /*tied*/, RigScratch& /*scratch*/) const {
  absent(kRig);
}
void GripperRig::drift(State& /*state*/) const {
  absent(kRig);
}
double GripperRig::kinetic_energy(const State& /*state*/) const {
  absent(kRig);
}
void GripperRig::snapshot(const State& /*state*/, const RigDrive& /*drive*/, Snapshot& /*out*/) const {
  absent(kRig);
}

}  // namespace drapeplan
