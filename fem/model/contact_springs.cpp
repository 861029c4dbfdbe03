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

/// Share of the thickness by which a press may sink the ply into the mold: contact springs are no softer. It
/// costs step only beyond some 0.1 MPa.
constexpr double kMostPressedIn = 0.1;

/// Raises springs to what a press needs.
void stiffen(const Scene& scene, ContactSprings& springs) {
  const double needed = scene.press->pressure / (kMostPressedIn * scene.fabric.thickness);
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
      springs.stiffness[k] = std::max(springs.stiffness[k], kPadShare * surplus * highest * highest);
    }
  }
  set_dashpots(options.contact_damping, carrying, springs);
  return make_contact(*scene.mold, scene.friction, std::move(springs), 0.5 * scene.fabric.thickness,
                      options.step_interval, std::move(released));
}

}  // namespace drapeplan
