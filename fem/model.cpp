#include "fem/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "fem/contact.hpp"
#include "fem/hash.hpp"

namespace drapeplan {
namespace {

/// Largest angle per step of a pad on its actuator: its critical damping, explicit, is stable up to it.
constexpr double kServoStep = 0.5;

}  // namespace

Model::Model(Scene scene) : scene_(std::move(scene)) {
  const Mesh& mesh = scene_.mesh;
  const auto n = size_t(mesh.node_count());
  const FemOptions& options = scene_.options;
  if (scene_.friction && !scene_.mold) throw std::invalid_argument("friction needs a mold");
  const std::vector<double> area = nodal_areas(mesh);
  std::vector<double> unscaled(n);
  for (size_t k = 0; k < n; ++k) unscaled[k] = scene_.fabric.areal_density * area[k];

  auto shell = make_shell(mesh, scene_.fabric, options);
  shell_ = shell.get();
  terms_.push_back(std::move(shell));
  NodalStiffness stiffness(mesh.node_count());
  terms_.front()->add_stiffness(stiffness);
  // Directors weigh as much as their stiffness demands (see shell_bounds.hpp), so that they never govern the
  // step.
  gyration2_.resize(n);
  for (size_t k = 0; k < n; ++k) gyration2_[k] = stiffness.rotation[k] / stiffness.translation[k];
  if (scene_.gravity) terms_.push_back(make_gravity(unscaled, *scene_.gravity));
  if (scene_.loads) {
    terms_.push_back(make_loads(*scene_.loads, area));
    terms_.back()->add_stiffness(stiffness);
  }
  if (scene_.mold) {
    std::vector<double> contact(stiffness.translation);
    for (double& k : contact) k *= options.contact_stiffness;
    terms_.push_back(
        make_contact(*scene_.mold, scene_.friction, std::move(contact), scene_.fabric.thickness / 2));
    terms_.back()->add_stiffness(stiffness);
  }

  mass_.assign(padded(int(n)), 0.0);
  inertia_ = inverse_mass_ = inverse_inertia_ = mass_;
  own_mass_.resize(n);
  // Mass per stiffness below which the target step would be missed.
  const double needed = std::pow(options.target_step / (2 * options.step_safety), 2);
  for (size_t k = 0; k < n; ++k) {
    own_mass_[k] = std::max(options.mass_scaling * unscaled[k], needed * stiffness.translation[k]);
    mass_[k] = own_mass_[k];
    inertia_[k] = gyration2_[k] * mass_[k];
  }
  stable_dt_ = stable_dt(stiffness);
  const double scale = std::accumulate(own_mass_.begin(), own_mass_.end(), 0.0) /
                       std::accumulate(unscaled.begin(), unscaled.end(), 0.0);
  alpha_ = scene_.damping.value_or(0) / std::sqrt(scale);

  std::vector<int> held = scene_.clamped;
  for (const int node : held) mass_[size_t(node)] = 0;
  for (const int node : scene_.pinned) mass_[size_t(node)] = 0;
  for (const Grip& grip : scene_.grips) {
    if (grip.nodes.empty()) throw std::invalid_argument("grip " + grip.name + " holds no node");
    for (const int node : grip.nodes) {
      if (mass_[size_t(node)] == 0)
        throw std::invalid_argument("grip " + grip.name + " holds a node that is held by something else");
      mass_[size_t(node)] = 0;
      held.push_back(node);
    }
  }
  if (scene_.rig) {
    const Eigen::Rotation2Dd turn(scene_.angle);
    std::vector<Eigen::Vector2d> place;
    for (int g = 0; g < scene_.rig->count(); ++g)
      place.emplace_back(scene_.position + turn * scene_.rig->place(g));
    rig_.emplace(*scene_.rig, mesh.rest, mass_, inertia_, place, scene_.angle);
    for (const int node : rig_->tied()) {
      if (mass_[size_t(node)] == 0)
        throw std::invalid_argument("a node under a pad is clamped, pinned or gripped");
    }
    held.insert(held.end(), rig_->tied().begin(), rig_->tied().end());
    // The joint's mobility: of the pad's mass, and of its inertia through the arm.
    const double arm = scene_.rig->joint_offset / scene_.rig->pad_radius;
    const double mobility = (1 + 2 * arm * arm) / scene_.rig->pad_mass;
    if (std::sqrt(scene_.rig->actuator_stiffness * mobility) * dt() > kServoStep) {
      throw std::invalid_argument(
          "the actuators are too stiff for the time step: lower grippers.actuator_stiffness or "
          "raise grippers.pad_mass");
    }
  }
  for (const int node : held) mass_[size_t(node)] = inertia_[size_t(node)] = 0;
  for (size_t k = 0; k < n; ++k) {
    inverse_mass_[k] = mass_[k] > 0 ? 1 / mass_[k] : 0;
    inverse_inertia_[k] = inertia_[k] > 0 ? 1 / inertia_[k] : 0;
  }
}

double Model::stable_dt(const NodalStiffness& stiffness) const {
  double largest = 0;  // bound of the highest squared frequency
  for (size_t k = 0; k < own_mass_.size(); ++k) {
    const double bound = std::max(stiffness.translation[k], stiffness.rotation[k] / gyration2_[k]);
    largest = std::max(largest, bound / own_mass_[k]);
  }
  return 2 / std::sqrt(largest) * viscous_share(scene_.options.bulk_viscosity);
}

double Model::free_mass() const {
  return std::accumulate(mass_.begin(), mass_.end(), 0.0);
}

std::uint64_t Model::fingerprint() const {
  Fnv1a hash;
  const auto add = [&hash](const auto& values) {
    for (const double value : values) hash.add(value);
  };
  for (const Eigen::Vector2d& place : scene_.mesh.rest) add(place);
  for (const auto& quad : scene_.mesh.quads) add(quad);
  for (const auto* list : {&own_mass_, &gyration2_, &mass_}) add(*list);
  for (const StressTable* table :
       {&scene_.fabric.tension, &scene_.fabric.compression, &scene_.fabric.shear}) {
    add(table->rates);
    for (const Curve& curve : table->curves) add(curve.strain), add(curve.stress);
  }
  const FemOptions& o = scene_.options;
  add(std::array{stable_dt_, alpha_, o.time_scaling, o.step_safety, double(o.section_points),
                 double(o.step_interval), o.hourglass, o.bulk_viscosity, o.contact_stiffness,
                 scene_.gravity.value_or(0), scene_.friction.value_or(-1), scene_.position.x(),
                 scene_.position.y(), scene_.angle});
  if (scene_.loads) {
    for (const auto* list : {&scene_.loads->forces, &scene_.loads->moments}) {
      for (const NodalLoad& load : *list) hash.add(double(load.node)), add(load.value);
    }
    add(scene_.loads->pressure);
  }
  for (const Grip& grip : scene_.grips) {
    add(grip.nodes);
    add(grip.velocity);
    hash.add(grip.ramp);
  }
  if (scene_.rig) {
    const RigOptions& r = *scene_.rig;
    add(std::array{r.spacing, r.pad_radius, r.pad_mass, r.joint_offset, r.tilt_limit, r.actuator_stiffness,
                   r.actuator_force_limit, double(r.columns), double(r.rows)});
    if (r.rotation_limits) {
      const RotationLimits& limits = *r.rotation_limits;
      add(std::array{limits.about_warp[0], limits.about_warp[1], limits.about_weft[0], limits.about_weft[1]});
    }
  }
  for (const std::string& name : term_names()) hash.add(name);
  return hash.value();
}

std::vector<std::string> Model::term_names() const {
  std::vector<std::string> names;
  for (const auto& term : terms_) names.emplace_back(term->name());
  if (scene_.damping) names.emplace_back("mass damping");
  if (rig_) names.emplace_back(scene_.rig->interlinks ? "gripper rig with interlinks" : "gripper rig");
  if (!scene_.clamped.empty()) names.emplace_back("clamp");
  if (!scene_.pinned.empty()) names.emplace_back("pin");
  if (!scene_.grips.empty()) names.emplace_back("grips");
  return names;
}

State Model::flat_state(double height) const {
  const int n = node_count();
  State state;
  state.x = state.v = state.d = state.w = VectorField(n);
  if (scene_.friction) {
    state.anchor = VectorField(n);
    state.stuck.assign(padded(n), 0.0);
  }
  state.history.assign(shell_->history_count(), 0.0);
  state.dt = state.dt_before = dt();
  state.stable_dt = stable_dt_;
  const Eigen::Rotation2Dd turn(scene_.angle);
  for (size_t k = 0; k < padded(n); ++k) {  // padding repeats the last node and has no mass
    const Eigen::Vector2d xy = scene_.position + turn * scene_.mesh.rest[std::min(k, size_t(n) - 1)];
    state.x.x[k] = xy.x();
    state.x.y[k] = xy.y();
    state.x.z[k] = height;
    state.d.z[k] = 1;
  }
  if (rig_) rig_->place(state, height);
  return state;
}

}  // namespace drapeplan
