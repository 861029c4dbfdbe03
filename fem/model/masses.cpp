#include "fem/model/masses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "mapping/error.hpp"

namespace drapeplan {

std::vector<double> unscaled_masses(const Scene& scene, const std::vector<double>& area) {
  std::vector<double> masses(area.size());
  for (size_t k = 0; k < area.size(); ++k) masses[k] = scene.fabric.areal_density * area[k];
  return masses;
}

NodalMasses::NodalMasses(const std::vector<double>& unscaled, double scaling, const NodalStiffness& ply)
    : unscaled_(std::accumulate(unscaled.begin(), unscaled.end(), 0.0)),
      own_mass_(unscaled.size()),
      gyration2_(unscaled.size()) {
  for (size_t k = 0; k < unscaled.size(); ++k) {
    own_mass_[k] = scaling * unscaled[k];
    gyration2_[k] = ply.rotation[k] / ply.translation[k];
  }
}

void NodalMasses::raise(double needed, const NodalStiffness& stiffness) {
  for (size_t k = 0; k < own_mass_.size(); ++k)
    own_mass_[k] = std::max(own_mass_[k], needed * stiffness.translation[k]);
}

double NodalMasses::scale() const {
  return std::accumulate(own_mass_.begin(), own_mass_.end(), 0.0) / unscaled_;
}

void NodalMasses::hold(const Scene& scene) {
  mass_.assign(padded(int(own_mass_.size())), 0.0);
  inertia_ = mass_;
  for (size_t k = 0; k < own_mass_.size(); ++k) {
    mass_[k] = own_mass_[k];
    inertia_[k] = gyration2_[k] * mass_[k];
  }
  held_ = scene.clamped;
  for (const int node : held_) mass_[size_t(node)] = 0;
  for (const int node : scene.pinned) mass_[size_t(node)] = 0;
  for (const Grip& grip : scene.grips) {
    if (grip.nodes.empty()) throw WrongInput(fmt::format("grip {} holds no node", grip.name));
    for (const int node : grip.nodes) {
      if (mass_[size_t(node)] == 0)
        throw WrongInput(fmt::format("grip {} holds a node that is held by something else", grip.name));
      mass_[size_t(node)] = 0;
      held_.push_back(node);
      guided_.push_back(node);
    }
  }
}

void NodalMasses::hold(const GripperRig& rig) {
  for (const int node : rig.tied()) {
    if (mass_[size_t(node)] == 0) throw WrongInput("a node under a pad is clamped, pinned or gripped");
    held_.push_back(node);
    guided_.push_back(node);
  }
}

void NodalMasses::close() {
  for (const int node : held_) mass_[size_t(node)] = inertia_[size_t(node)] = 0;
  inverse_mass_.assign(mass_.size(), 0.0);
  inverse_inertia_ = inverse_mass_;
  for (size_t k = 0; k < own_mass_.size(); ++k) {
    inverse_mass_[k] = mass_[k] > 0 ? 1 / mass_[k] : 0;
    inverse_inertia_[k] = inertia_[k] > 0 ? 1 / inertia_[k] : 0;
  }
}

bool NodalMasses::all_held() const {
  return std::all_of(mass_.begin(), mass_.end(), [](double mass) { return mass == 0; });
}

double NodalMasses::free_mass() const {
  return std::accumulate(mass_.begin(), mass_.end(), 0.0);
}

}  // namespace drapeplan
