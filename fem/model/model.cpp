#include "fem/model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/model/contact_springs.hpp"
#include "fem/model/flat_start.hpp"
#include "fem/terms/contact.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

/// How much the highest rate rises by contact.
double rise_of(const Scene& scene) {
  return scene.mold ? contact_rise(scene.options) : 1;
}

/// Mass per stiffness below which the target step would be missed [kg m/N].
double mass_for_target_step(const Scene& scene) {
  const FemOptions& options = scene.options;
  const double share = options.step_safety * viscous_share(options.bulk_viscosity);
  return std::pow(rise_of(scene) * options.target_step / (2 * share), 2);
}

}  // namespace

Model::Model(Scene scene) : scene_(std::move(scene)) {
  check_scene(scene_);
  const FemOptions& options = scene_.options;
  const std::vector<double> area = nodal_areas(scene_.mesh), unscaled = unscaled_masses(scene_, area);
  NodalStiffness stiffness = add_shell();
  masses_ = NodalMasses(unscaled, options.mass_scaling, stiffness);
  add_loads(unscaled, area, stiffness);
  if (options.fibre_mass_scaling > 1) stiffness = stiffness_without_fibres();
  masses_.raise(mass_for_target_step(scene_), stiffness);
  alpha_ = scene_.damping.value_or(0) / std::sqrt(masses_.scale());
  masses_.hold(scene_);
  if (scene_.rig) {
    add_rig();
  } else if (masses_.all_held()) {
    throw WrongInput("every node of the ply is held: nothing can move; refine the mesh");
  }
  bounds_ = StepBounds(scene_, masses_, rig_ ? &*rig_ : nullptr);
  if (scene_.mold) add_contact(stiffness);
  stable_dt_ = bounds_.stable_dt(stiffness);
  if (options.fibre_mass_scaling > 1) add_fibre_inertia();
  if (rig_) limit_to_actuators();
  masses_.close();
}

/// @return the bounds of the ply alone.
NodalStiffness Model::add_shell() {
  auto shell = make_shell(scene_.mesh, scene_.fabric, scene_.options);
  shell_ = shell.get();
  terms_.push_back(std::move(shell));
  NodalStiffness stiffness(node_count());
  shell_->add_stiffness(stiffness);
  return stiffness;
}

void Model::add_loads(const std::vector<double>& unscaled, const std::vector<double>& area,
                      NodalStiffness& stiffness) {
  if (scene_.gravity) terms_.push_back(make_gravity(unscaled, *scene_.gravity));
  if (scene_.loads) {
    terms_.push_back(make_loads(*scene_.loads, area));
    terms_.back()->add_stiffness(stiffness);
  }
  if (scene_.press) {
    terms_.push_back(make_press(*scene_.press, scene_.mesh));
    terms_.back()->add_stiffness(stiffness);
  }
}

/// With fibre inertia, mass on edges carries the fibres of rectangles; what is left keeps its bounds. Sets
/// the rate that those would have, over the scaling.
/// @return what is left.
NodalStiffness Model::stiffness_without_fibres() {
  if (scene_.options.step_interval == 0)
    throw WrongInput("fibre_mass_scaling needs a step that is chosen anew: step_interval above 0");
  const std::vector<char> with_fibre_inertia = shell_->with_fibre_inertia();
  if (std::none_of(with_fibre_inertia.begin(), with_fibre_inertia.end(), [](char can) { return can; }))
    throw WrongInput("fibre_mass_scaling needs elements that are rectangles along the fibres");
  NodalStiffness fibres(node_count()), left(node_count());
  shell_->add_fibre_stiffness(fibres);
  double rate2 = 0;
  for (int k = 0; k < node_count(); ++k)
    rate2 = std::max(rate2, fibres.translation[size_t(k)] / masses_.own_mass(k));
  fibre_inertia_rate_ = std::sqrt(rate2) / scene_.options.fibre_mass_scaling;
  shell_->add_stiffness_without_fibres(left);
  for (const auto& term : terms_) {
    if (term.get() != shell_) term->add_stiffness(left);
  }
  return left;
}

void Model::add_rig() {
  const Eigen::Rotation2Dd turn(scene_.angle);
  std::vector<Eigen::Vector2d> place;
  for (int g = 0; g < scene_.rig->count(); ++g)
    place.emplace_back(scene_.position + turn * scene_.rig->place(g));
  rig_.emplace(*scene_.rig, scene_.mesh.rest, masses_.mass(), masses_.inertia(), place, scene_.angle);
  masses_.hold(*rig_);
}

void Model::add_contact(NodalStiffness& stiffness) {
  if (scene_.press && fibre_inertia_rate_ > 0)
    fibre_inertia_rate_ = std::max(fibre_inertia_rate_, rate_for_press(scene_, masses_, bounds_));
  terms_.push_back(make_scene_contact(scene_, *shell_, masses_, bounds_, fibre_inertia_rate_));
  terms_.back()->add_stiffness(stiffness);
}

void Model::add_fibre_inertia() {
  std::vector<double> mobility = bounds_.mobility();
  for (const int node : rig_ ? rig_->tied() : std::vector<int>())
    mobility[size_t(node)] = 1 / masses_.own_mass(node);
  const double rate = rise_of(scene_) * fibre_inertia_rate_;
  fibre_inertia_.emplace(scene_.mesh, shell_->with_fibre_inertia(), shell_->fibre_inertia_stretch(), rate,
                         std::move(mobility), pad_nodes());
  fibre_inertia_dt_ = bounds_.stable_dt(rate);
  shell_->set_fibre_inertia_step(fibre_inertia_dt_);
  stable_dt_ = std::min(stable_dt_, fibre_inertia_dt_);
}

void Model::limit_to_actuators() {
  actuator_dt_ = longest_actuator_step(*scene_.rig);
  if (dt() > actuator_dt_) {
    throw WrongInput(
        "the actuators are too stiff for the time step: lower grippers.actuator_stiffness or "
        "raise grippers.pad_mass");
  }
}

std::vector<std::string> Model::term_names() const {
  std::vector<std::string> names;
  for (const auto& term : terms_) names.emplace_back(term->name());
  const int points = scene_.options.section_points;
  names.front() += fmt::format(", {} section point{}", points, points == 1 ? "" : "s");
  if (fibre_inertia_) names.emplace_back("fibre inertia");
  if (scene_.damping) names.emplace_back("mass damping");
  if (rig_) names.emplace_back(scene_.rig->interlinks ? "gripper rig with interlinks" : "gripper rig");
  if (rig_ && scene_.rig->fixed) names.emplace_back("fixed joint");
  if (rig_ && scene_.rig->rotation_limits) names.emplace_back("rotation limits");
  if (rig_ && scene_.rig->release_time) names.emplace_back("release");
  if (!scene_.clamped.empty()) names.emplace_back("clamp");
  if (!scene_.pinned.empty()) names.emplace_back("pin");
  if (!scene_.grips.empty()) names.emplace_back("grips");
  if (scene_.rest) names.emplace_back("end at rest");
  return names;
}

SummaryParts Model::summary_parts() const {
  return {.external = scene_.gravity || scene_.loads || scene_.press || scene_.rig || !scene_.grips.empty(),
          .contact = scene_.mold.has_value(),
          .friction = scene_.friction.has_value(),
          .damping = scene_.damping.has_value(),
          .constraint = scene_.rig.has_value(),
          .links = scene_.rig && (scene_.rig->interlinks.has_value() || scene_.rig->fixed)};
}

State Model::flat_state(double height) const {
  return flat_start(*this, height);
}

}  // namespace drapeplan
