#include "fem/model/contact_springs.hpp"

#include <algorithm>
#include <cmath>

#include "fem/terms/contact.hpp"

namespace drapeplan {
namespace {

/// Share of a pad's surplus mass (over that of its nodes) in the stable step that its contact springs may
/// use. The springs are some 30 times stiffer than those of free nodes then, and never govern the step.
constexpr double kPadShare = 0.2;

/// Share of what a node's own mass carries that its contact spring may use where added mass carries the
/// fibres. With the dashpot it leaves a tenth for the rest, which is far less.
constexpr double kBareShare = 0.5;

/// The same where a press makes the springs of all nodes that stiff: less, for then all of them touch.
constexpr double kPressedShare = 0.4;

/// Share of the thickness by which a press may sink the ply into the mold: contact springs are no softer. It
/// costs step only beyond some 0.1 MPa.
constexpr double kMostPressedIn = 0.2;

/// Share of what presses on a gripper's part of the grid that one node of its pad may have to bear: a pad
/// stands on its rim, and the ply hangs between pads until it lies.
constexpr double kOnOneNode = 0.2;

/// Stiffness that a press asks of a spring, per area that it bears [N/m^3].
double needed_bedding(const Scene& scene) {
  return scene.press ? scene.press->pressure / (kMostPressedIn * scene.fabric.thickness) : 0;
}

/// Stiffness that it asks of a node of a pad [N/m].
double on_one_node(const Scene& scene) {
  return needed_bedding(scene) * kOnOneNode * scene.rig->spacing * scene.rig->spacing;
}

/// Raises springs to what a press needs.
void stiffen(const Scene& scene, ContactSprings& springs) {
  const double needed = needed_bedding(scene);
  const std::vector<double> area = nodal_areas(scene.mesh);
  for (size_t k = 0; k < area.size(); ++k)
    springs.stiffness[k] = std::max(springs.stiffness[k], needed * area[k]);
}

/// Dashpots with the stated share of the critical damping of these masses [kg].
void set_dashpots(double share, const std::vector<double>& mass, ContactSprings& springs) {
  springs.damping.resize(mass.size());
  for (size_t k = 0; k < mass.size(); ++k)
    springs.damping[k] = 2 * share * std::sqrt(springs.stiffness[k] * mass[k]);
}

}  // namespace

double rate_for_press(const Scene& scene, const NodalMasses& masses, const StepBounds& bounds) {
  const std::vector<double> area = nodal_areas(scene.mesh);
  const std::vector<double>&own = masses.own_mass(), &carrying = bounds.carrying_mass();
  double rate2 = 0;
  for (size_t k = 0; k < area.size(); ++k)
    rate2 = std::max(rate2, needed_bedding(scene) * area[k] / (kPressedShare * own[k]));
  for (const std::vector<int>& pad : bounds.pad_nodes()) {
    for (const int node : pad) {
      const auto k = size_t(node);
      if (carrying[k] > own[k]) rate2 = std::max(rate2, on_one_node(scene) / (carrying[k] - own[k]));
    }
  }
  return std::sqrt(rate2);
}

std::unique_ptr<Term> make_scene_contact(const Scene& scene, const Shell& shell, const NodalMasses& masses,
                                         const StepBounds& bounds, double inertial_rate) {
  const FemOptions& options = scene.options;
  const std::vector<double>&own = masses.own_mass(), &carrying = bounds.carrying_mass();
  NodalStiffness slow(scene.mesh.node_count());
  shell.add_slow_stiffness(slow);
  double highest = contact_rise(options) * 2 / bounds.stable_dt(slow);
  ContactSprings springs{std::vector<double>(own.size()), {}};
  for (size_t k = 0; k < own.size(); ++k)
    springs.stiffness[k] = options.contact_stiffness * slow.translation[k];
  if (options.fibre_mass_scaling > 1) {
    highest = contact_rise(options) * inertial_rate;
    const double most = kBareShare * inertial_rate * inertial_rate;
    for (size_t k = 0; k < own.size(); ++k)
      springs.stiffness[k] = std::min(springs.stiffness[k], most * own[k]);
  }
  if (scene.press) stiffen(scene, springs);
  ReleasedSprings released;
  if (scene.rig) {
    released = {bounds.pad_nodes(), springs};
    set_dashpots(options.contact_damping, own, released.springs);
  }
  for (const std::vector<int>& pad : bounds.pad_nodes()) {
    for (const int node : pad) {
      const auto k = size_t(node);
      const double surplus = carrying[k] - own[k];
      springs.stiffness[k] =
          std::max({springs.stiffness[k], kPadShare * surplus * highest * highest, on_one_node(scene)});
    }
  }
  set_dashpots(options.contact_damping, carrying, springs);
  std::optional<NodalTack> tack;
  if (scene.tack) {
    tack = {nodal_areas(scene.mesh), scene.tack->reach};
    for (double& force : tack->force) force *= scene.tack->stress;
  }
  return make_contact(*scene.mold, scene.friction, std::move(springs), 0.5 * scene.fabric.thickness,
                      options.step_interval, std::move(released), std::move(tack));
}

}  // namespace drapeplan
