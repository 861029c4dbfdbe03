#include "fem/model/step_bounds.hpp"

#include <cmath>

#include "fem/core/lanes.hpp"

namespace drapeplan {
namespace {

namespace stdx = std::experimental;

/// Largest angle per step of a pad on its actuator: its critical damping, explicit, is stable up to it.
constexpr double kServoStep = 0.5;

}  // namespace

StepBounds::StepBounds(const Scene& scene, const NodalMasses& masses, const GripperRig* rig)
    : nodes_(scene.mesh.node_count()),
      viscous_share_(viscous_share(scene.options.bulk_viscosity)),
      own_mass_(masses.own_mass()),
      carrying_mass_(masses.own_mass()) {
  if (rig != nullptr) {
    pad_nodes_ = rig->tied_by_pad();
    const std::vector<double> ratios = rig->mass_ratios(masses.mass(), masses.inertia());
    for (size_t i = 0; i < ratios.size(); ++i) carrying_mass_[size_t(rig->tied()[i])] *= ratios[i];
  }
  mobility_.assign(padded(nodes_), 0.0);
  turning_mobility_ = mobility_;
  for (size_t k = 0; k < size_t(nodes_); ++k) {
    mobility_[k] = 1 / carrying_mass_[k];
    turning_mobility_[k] = mobility_[k] / masses.gyration2()[k];
  }
  for (const int node : scene.pinned) mobility_[size_t(node)] = 0;
  for (const int node : scene.clamped) mobility_[size_t(node)] = turning_mobility_[size_t(node)] = 0;
  for (const Grip& grip : scene.grips) {
    for (const int node : grip.nodes) mobility_[size_t(node)] = turning_mobility_[size_t(node)] = 0;
  }
}

// Played with the velocity of half a step before, a dashpot c counts like a spring c s with s = 2 / dt: at a
// node's limit s^2 = K / m + c / m s. A shorter step leaves more room than it takes.
double StepBounds::highest_rate(const NodalStiffness& stiffness) const {
  Lanes largest(0.0);
  for (size_t n = 0; n < size_t(nodes_); n += size_t(kLanes)) {
    const Lanes mobility = load(&mobility_[n]);
    const Lanes half = Lanes(0.5) * load(&stiffness.damping[n]) * mobility;
    const Lanes moving = half + stdx::sqrt(half * half + load(&stiffness.translation[n]) * mobility);
    const Lanes turning = stdx::sqrt(load(&stiffness.rotation[n]) * load(&turning_mobility_[n]));
    largest = stdx::max(largest, stdx::max(moving, turning));
  }
  return stdx::hmax(largest);
}

double StepBounds::stable_dt(const NodalStiffness& stiffness) const {
  return stable_dt(highest_rate(stiffness));
}

double StepBounds::stable_dt(double highest_rate) const {
  return 2 / highest_rate * viscous_share_;
}

void StepBounds::update_lightness(const NodalStiffness& stiffness, double highest_rate,
                                  std::vector<double>& lightness) const {
  constexpr double kLeast = 0.1;  // less gains little, and takes long to find back when stresses move on
  const Lanes rate(highest_rate), rate2 = rate * rate;
  Lanes largest(kLeast);
  for (size_t n = 0; n < size_t(nodes_); n += size_t(kLanes)) {
    const Lanes mobility = load(&mobility_[n]);
    const Lanes moving =
        load(&stiffness.translation[n]) * mobility / (rate2 - rate * load(&stiffness.damping[n]) * mobility);
    const Lanes turning = load(&stiffness.rotation[n]) * load(&turning_mobility_[n]) / rate2;
    const Lanes light = load(&lightness[n]) * stdx::max(moving, turning);
    store(light, &lightness[n]);
    largest = stdx::max(largest, light);
  }
  const Lanes unit(1 / stdx::hmax(largest));  // only ratios count: the lightest has 1
  for (size_t n = 0; n < size_t(nodes_); n += size_t(kLanes))
    store(stdx::clamp(load(&lightness[n]) * unit, Lanes(kLeast), Lanes(1.0)), &lightness[n]);
}

void StepBounds::raise_for_released_nodes(const State& state, NodalStiffness& stiffness) const {
  for (size_t g = 0; g < pad_nodes_.size(); ++g) {
    if (!state.pads[g].released) continue;
    for (const int node : pad_nodes_[g]) {
      const auto k = size_t(node);
      const double share = carrying_mass_[k] / own_mass_[k];
      stiffness.translation[k] *= share, stiffness.rotation[k] *= share, stiffness.damping[k] *= share;
    }
  }
}

// With spring a K of a node's row K and share z of its critical damping, s^2 = K / m (1 + a) + 2 z sqrt(a K /
// m) s (see highest_rate); the larger root, over sqrt(K / m).
double contact_rise(const FemOptions& options) {
  const double damped = options.contact_damping * std::sqrt(options.contact_stiffness);
  return damped + std::sqrt(damped * damped + 1 + options.contact_stiffness);
}

// The joint's mobility is that of the pad's mass, and that of its inertia through the arm.
double longest_actuator_step(const RigOptions& rig) {
  const double arm = rig.joint_offset / rig.pad_radius;
  const double mobility = (1 + 2 * arm * arm) / rig.pad_mass;
  return kServoStep / std::sqrt(rig.actuator_stiffness * mobility);
}

}  // namespace drapeplan
