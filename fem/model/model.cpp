#include "fem/model/model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "fem/core/hash.hpp"
#include "fem/terms/contact.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

/// Largest angle per step of a pad on its actuator: its critical damping, explicit, is stable up to it.
constexpr double kServoStep = 0.5;

/// Share of a pad's surplus mass (over that of its nodes) in the stable step that its contact springs may
/// use. The springs are some 30 times stiffer than those of free nodes then, and never govern the step.
constexpr double kPadShare = 0.2;

/// Share of what a node's own mass bears that its contact spring may use where added mass bears the fibres.
/// With the dashpot it leaves a tenth for the rest, which is far less.
constexpr double kBareShare = 0.5;

/// Parts of a fingerprint that have no list of numbers of their own.
void add_mold(Fnv1a& hash, const Mold& mold) {
  constexpr int kSamples = 17;  // per side: tells molds apart, whatever their shape
  const Extent& extent = mold.extent();
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Eigen::Vector2d share(double(i) / (kSamples - 1), double(j) / (kSamples - 1));
      const Eigen::Vector2d at = extent.lower + share.cwiseProduct(extent.upper - extent.lower);
      for (const double value : {at.x(), at.y(), mold.height(at.x(), at.y())}) hash.add(value);
    }
  }
}

/// Smallest radius of curvature of the mold's sections over the longest element edge: below it a mesh of flat
/// elements has nothing in common with the mold, and a ball slips between its nodes.
constexpr double kLeastRadius = 1;

double longest_edge(const Mesh& mesh) {
  double longest = 0;
  for (const auto& quad : mesh.quads) {
    for (size_t c = 0; c < 4; ++c)
      longest = std::max(longest, (mesh.rest[size_t(quad[c])] - mesh.rest[size_t(quad[(c + 1) % 4])]).norm());
  }
  return longest;
}

/// Largest normal curvature of the mold where it is defined, in its extent [1/m].
double sharpest_curvature(const Mold& mold) {
  constexpr int kSamples = 101;  // per side: fewer than nodes in most plies, but molds are smooth formulas
  double sharpest = 0;
  const Extent& extent = mold.extent();
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Eigen::Vector2d share(double(i) / (kSamples - 1), double(j) / (kSamples - 1));
      const Eigen::Vector2d at = extent.lower + share.cwiseProduct(extent.upper - extent.lower);
      const Jet jet = mold.jet(at.x(), at.y());
      const double slope2 = jet.zx * jet.zx + jet.zy * jet.zy;
      if (!(slope2 < kSteepestContact * kSteepestContact)) continue;  // nothing touches there
      // Principal curvatures of a height field: roots with mean H and product K.
      const double stretch2 = 1 + slope2;
      const double product = (jet.zxx * jet.zyy - jet.zxy * jet.zxy) / (stretch2 * stretch2);
      const double mean = ((1 + jet.zy * jet.zy) * jet.zxx - 2 * jet.zx * jet.zy * jet.zxy +
                           (1 + jet.zx * jet.zx) * jet.zyy) /
                          (2 * std::pow(stretch2, 1.5));
      const double spread = std::sqrt(std::max(mean * mean - product, 0.0));
      sharpest = std::max(sharpest, std::abs(mean) + spread);
    }
  }
  return sharpest;
}

/// What contact cannot do is refused.
void check_mold(const Scene& scene) {
  const double radius = 1 / std::max(sharpest_curvature(*scene.mold), 1e-12), edge = longest_edge(scene.mesh);
  if (radius < kLeastRadius * edge) {
    throw WrongInput("the mold is curved with a radius of " + std::to_string(1e3 * radius) +
                     " mm, elements are up to " + std::to_string(1e3 * edge) + " mm long: refine the mesh");
  }
  if (scene.start != Start::on_mold) return;
  const Jet jet = scene.mold->jet(scene.position.x(), scene.position.y());
  if (!(std::hypot(jet.zx, jet.zy) < kSteepestContact)) {
    throw WrongInput(
        "the ply starts where the mold is too steep, or not defined: nothing touches a height field beyond "
        "84 degrees");
  }
}

/// Largest 2 / dt with contact over that without it: with spring a K of a node's row K and share z of its
/// critical damping, s^2 = K / m (1 + a) + 2 z sqrt(a K / m) s (see stable_dt); the larger root, over
/// sqrt(K / m).
double contact_rise(const FemOptions& options) {
  const double damped = options.contact_damping * std::sqrt(options.contact_stiffness);
  return damped + std::sqrt(damped * damped + 1 + options.contact_stiffness);
}

}  // namespace

Model::Model(Scene scene) : scene_(std::move(scene)) {
  const Mesh& mesh = scene_.mesh;
  const auto n = size_t(mesh.node_count());
  const FemOptions& options = scene_.options;
  if (scene_.friction && !scene_.mold) throw WrongInput("friction needs a mold");
  if (scene_.start == Start::on_mold && (!scene_.mold || scene_.rig)) {
    throw WrongInput("a ply that starts on the mold needs a mold, and no rig");
  }
  if (scene_.mold) check_mold(scene_);
  const std::vector<double> area = nodal_areas(mesh);
  std::vector<double> unscaled(n);
  for (size_t k = 0; k < n; ++k) unscaled[k] = scene_.fabric.areal_density * area[k];

  auto shell = make_shell(mesh, scene_.fabric, options);
  shell_ = shell.get();
  terms_.push_back(std::move(shell));
  NodalStiffness stiffness(mesh.node_count());
  terms_.front()->add_stiffness(stiffness);
  // Directors weigh as much as their stiffness demands (see fem/shell/bounds.hpp), so that they never govern
  // the step.
  gyration2_.resize(n);
  for (size_t k = 0; k < n; ++k) gyration2_[k] = stiffness.rotation[k] / stiffness.translation[k];
  if (scene_.gravity) terms_.push_back(make_gravity(unscaled, *scene_.gravity));
  if (scene_.loads) {
    terms_.push_back(make_loads(*scene_.loads, area));
    terms_.back()->add_stiffness(stiffness);
  }

  own_mass_.resize(n);
  // Mass per stiffness below which the target step would be missed.
  const double rise = scene_.mold ? contact_rise(options) : 1;
  const double share = options.step_safety * viscous_share(options.bulk_viscosity);
  const double needed = std::pow(rise * options.target_step / (2 * share), 2);
  for (size_t k = 0; k < n; ++k) own_mass_[k] = options.mass_scaling * unscaled[k];
  if (options.fibre_mass_scaling > 1) stiffness = stiffness_without_fibres();
  for (size_t k = 0; k < n; ++k) own_mass_[k] = std::max(own_mass_[k], needed * stiffness.translation[k]);

  mass_.assign(padded(int(n)), 0.0);
  inertia_ = inverse_mass_ = inverse_inertia_ = mass_;
  for (size_t k = 0; k < n; ++k) {
    mass_[k] = own_mass_[k];
    inertia_[k] = gyration2_[k] * mass_[k];
  }
  const double scale = std::accumulate(own_mass_.begin(), own_mass_.end(), 0.0) /
                       std::accumulate(unscaled.begin(), unscaled.end(), 0.0);
  alpha_ = scene_.damping.value_or(0) / std::sqrt(scale);

  std::vector<int> held = scene_.clamped;
  for (const int node : held) mass_[size_t(node)] = 0;
  for (const int node : scene_.pinned) mass_[size_t(node)] = 0;
  for (const Grip& grip : scene_.grips) {
    if (grip.nodes.empty()) throw WrongInput("grip " + grip.name + " holds no node");
    for (const int node : grip.nodes) {
      if (mass_[size_t(node)] == 0)
        throw WrongInput("grip " + grip.name + " holds a node that is held by something else");
      mass_[size_t(node)] = 0;
      held.push_back(node);
      guided_.push_back(node);
    }
  }
  if (scene_.rig) {
    const Eigen::Rotation2Dd turn(scene_.angle);
    std::vector<Eigen::Vector2d> place;
    for (int g = 0; g < scene_.rig->count(); ++g)
      place.emplace_back(scene_.position + turn * scene_.rig->place(g));
    rig_.emplace(*scene_.rig, mesh.rest, mass_, inertia_, place, scene_.angle);
    pad_nodes_ = rig_->tied_by_pad();
    for (const int node : rig_->tied()) {
      if (mass_[size_t(node)] == 0) throw WrongInput("a node under a pad is clamped, pinned or gripped");
    }
    held.insert(held.end(), rig_->tied().begin(), rig_->tied().end());
    guided_.insert(guided_.end(), rig_->tied().begin(), rig_->tied().end());
  }
  if (!rig_ && std::all_of(mass_.begin(), mass_.end(), [](double mass) { return mass == 0; }))
    throw WrongInput("every node of the ply is held: nothing can move; refine the mesh");
  bear_held_nodes();
  if (scene_.mold) add_contact(stiffness);
  stable_dt_ = stable_dt(stiffness);
  if (options.fibre_mass_scaling > 1) add_fibre_inertia(rise);
  if (rig_) {
    // The joint's mobility: of the pad's mass, and of its inertia through the arm.
    const double arm = scene_.rig->joint_offset / scene_.rig->pad_radius;
    const double mobility = (1 + 2 * arm * arm) / scene_.rig->pad_mass;
    servo_dt_ = kServoStep / std::sqrt(scene_.rig->actuator_stiffness * mobility);
    if (dt() > servo_dt_) {
      throw WrongInput(
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

/// With fibre inertia, mass on edges bears the fibres of rectangles; what is left keeps its bounds. Sets
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
  for (size_t k = 0; k < own_mass_.size(); ++k) rate2 = std::max(rate2, fibres.translation[k] / own_mass_[k]);
  fibre_inertia_rate_ = std::sqrt(rate2) / scene_.options.fibre_mass_scaling;
  shell_->add_stiffness_without_fibres(left);
  if (scene_.loads) terms_.back()->add_stiffness(left);
  return left;
}

/// @param rise  of the highest rate by contact.
void Model::add_fibre_inertia(double rise) {
  std::vector<double> mobility = mobility_;
  for (const int node : rig_ ? rig_->tied() : std::vector<int>())
    mobility[size_t(node)] = 1 / own_mass_[size_t(node)];
  const double rate = rise * fibre_inertia_rate_;
  fibre_inertia_.emplace(scene_.mesh, shell_->with_fibre_inertia(), shell_->fibre_inertia_stretch(), rate,
                         std::move(mobility), pad_nodes_);
  fibre_inertia_dt_ = stable_dt(rate);
  shell_->set_fibre_inertia_step(fibre_inertia_dt_);
  stable_dt_ = std::min(stable_dt_, fibre_inertia_dt_);
}

/// Held nodes bear any stiffness; tied ones with their share of their pad.
void Model::bear_held_nodes() {
  bearing_mass_ = own_mass_;
  if (rig_) {
    const std::vector<double> ratios = rig_->mass_ratios(mass_, inertia_);
    for (size_t i = 0; i < ratios.size(); ++i) bearing_mass_[size_t(rig_->tied()[i])] *= ratios[i];
  }
  mobility_.assign(padded(node_count()), 0.0);
  turning_mobility_ = mobility_;
  for (size_t k = 0; k < own_mass_.size(); ++k) {
    mobility_[k] = 1 / bearing_mass_[k];
    turning_mobility_[k] = mobility_[k] / gyration2_[k];
  }
  for (const int node : scene_.pinned) mobility_[size_t(node)] = 0;
  for (const int node : scene_.clamped) mobility_[size_t(node)] = turning_mobility_[size_t(node)] = 0;
  for (const Grip& grip : scene_.grips) {
    for (const int node : grip.nodes) mobility_[size_t(node)] = turning_mobility_[size_t(node)] = 0;
  }
}

// Springs are shares of the ply's stiffness by its slowest curves: rates would make them needlessly stiff.
void Model::add_contact(NodalStiffness& stiffness) {
  const FemOptions& options = scene_.options;
  const size_t n = own_mass_.size();
  NodalStiffness slow(node_count());
  shell_->add_slow_stiffness(slow);
  double highest = contact_rise(options) * 2 / stable_dt(slow);
  ContactSprings springs{std::vector<double>(n), std::vector<double>(n)};
  for (size_t k = 0; k < n; ++k) springs.stiffness[k] = options.contact_stiffness * slow.translation[k];
  if (options.fibre_mass_scaling > 1) {
    highest = contact_rise(options) * fibre_inertia_rate_;
    const double most = kBareShare * fibre_inertia_rate_ * fibre_inertia_rate_;
    for (size_t k = 0; k < n; ++k) springs.stiffness[k] = std::min(springs.stiffness[k], most * own_mass_[k]);
  }
  const auto dashpots = [&options](ContactSprings& of, const std::vector<double>& mass) {
    for (size_t k = 0; k < mass.size(); ++k)
      of.damping[k] = 2 * options.contact_damping * std::sqrt(of.stiffness[k] * mass[k]);
  };
  ReleasedSprings released;
  if (rig_) {
    released = {pad_nodes_, springs};
    dashpots(released.springs, own_mass_);
  }
  for (const int node : rig_ ? rig_->tied() : std::vector<int>()) {
    const auto k = size_t(node);
    const double surplus = bearing_mass_[k] - own_mass_[k];
    springs.stiffness[k] = std::max(springs.stiffness[k], kPadShare * surplus * highest * highest);
  }
  dashpots(springs, bearing_mass_);
  terms_.push_back(make_contact(*scene_.mold, scene_.friction, std::move(springs),
                                0.5 * scene_.fabric.thickness, options.step_interval, std::move(released)));
  terms_.back()->add_stiffness(stiffness);
}

// Played with the velocity of half a step before, a dashpot c counts like a spring c s with s = 2 / dt: at a
// node's limit s^2 = K / m + c / m s. A shorter step leaves more room than it takes.
double Model::highest_rate(const NodalStiffness& stiffness) const {
  namespace stdx = std::experimental;
  Lanes largest(0.0);
  for (size_t n = 0; n < size_t(node_count()); n += size_t(kLanes)) {
    const Lanes mobility = load(&mobility_[n]);
    const Lanes half = Lanes(0.5) * load(&stiffness.damping[n]) * mobility;
    const Lanes moving = half + stdx::sqrt(half * half + load(&stiffness.translation[n]) * mobility);
    const Lanes turning = stdx::sqrt(load(&stiffness.rotation[n]) * load(&turning_mobility_[n]));
    largest = stdx::max(largest, stdx::max(moving, turning));
  }
  return stdx::hmax(largest);
}

double Model::stable_dt(const NodalStiffness& stiffness) const {
  return stable_dt(highest_rate(stiffness));
}

double Model::stable_dt(double highest_rate) const {
  return 2 / highest_rate * viscous_share(scene_.options.bulk_viscosity);
}

void Model::update_lightness(const NodalStiffness& stiffness, double highest_rate,
                             std::vector<double>& lightness) const {
  namespace stdx = std::experimental;
  constexpr double kLeast = 0.1;  // less gains little, and takes long to find back when stresses move on
  const Lanes rate(highest_rate), rate2 = rate * rate;
  Lanes largest(kLeast);
  for (size_t n = 0; n < size_t(node_count()); n += size_t(kLanes)) {
    const Lanes mobility = load(&mobility_[n]);
    const Lanes moving =
        load(&stiffness.translation[n]) * mobility / (rate2 - rate * load(&stiffness.damping[n]) * mobility);
    const Lanes turning = load(&stiffness.rotation[n]) * load(&turning_mobility_[n]) / rate2;
    const Lanes light = load(&lightness[n]) * stdx::max(moving, turning);
    store(light, &lightness[n]);
    largest = stdx::max(largest, light);
  }
  const Lanes unit(1 / stdx::hmax(largest));  // only ratios count: the lightest has 1
  for (size_t n = 0; n < size_t(node_count()); n += size_t(kLanes))
    store(stdx::clamp(load(&lightness[n]) * unit, Lanes(kLeast), Lanes(1.0)), &lightness[n]);
}

void Model::bear_released(const State& state, NodalStiffness& stiffness) const {
  for (size_t g = 0; g < pad_nodes_.size(); ++g) {
    if (!state.pads[g].released) continue;
    for (const int node : pad_nodes_[g]) {
      const auto k = size_t(node);
      const double share = bearing_mass_[k] / own_mass_[k];
      stiffness.translation[k] *= share, stiffness.rotation[k] *= share, stiffness.damping[k] *= share;
    }
  }
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
  add(std::array{scene_.fabric.rate_floor, scene_.fabric.rate_filter, double(scene_.fabric.shear_measure),
                 scene_.fabric.transverse_shear_modulus});
  const FemOptions& o = scene_.options;
  add(std::array{stable_dt_, alpha_, o.fibre_mass_scaling, o.time_scaling, o.step_safety,
                 double(o.section_points), double(o.fibre_points), double(o.step_interval), o.hourglass,
                 o.bulk_viscosity, o.contact_stiffness, o.contact_damping, scene_.gravity.value_or(0),
                 scene_.friction.value_or(-1), scene_.position.x(), scene_.position.y(), scene_.angle});
  if (o.precision == Precision::single_lanes) hash.add(std::string_view("single"));
  if (scene_.mold) add_mold(hash, *scene_.mold);
  if (scene_.rest) add(std::array{scene_.rest->speed, scene_.rest->hold});
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
                   r.actuator_force_limit, double(r.columns), double(r.rows), double(r.driven)});
    if (r.fixed) add(*r.fixed);
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
  const int points = scene_.options.section_points;
  names.front() += ", " + std::to_string(points) + (points == 1 ? " section point" : " section points");
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
  return {.external = scene_.gravity || scene_.loads || scene_.rig || !scene_.grips.empty(),
          .contact = scene_.mold.has_value(),
          .friction = scene_.friction.has_value(),
          .damping = scene_.damping.has_value(),
          .constraint = scene_.rig.has_value(),
          .links = scene_.rig && (scene_.rig->interlinks || scene_.rig->fixed)};
}

State Model::flat_state(double height) const {
  const int n = node_count();
  State state;
  state.position = state.velocity = state.director = state.director_rate = VectorField(n);
  if (scene_.friction) {
    state.anchor = VectorField(n);
    state.stuck.assign(padded(n), 0.0);
  }
  state.history.assign(shell_->history_count(), 0.0);
  if (fibre_inertia_) state.edges.fill(VectorField(n));
  if (scene_.options.step_interval > 0) state.lightness.assign(padded(n), 1.0);
  state.dt = state.dt_before = dt();
  state.stable_dt = stable_dt_;
  const Eigen::Vector2d& place = scene_.position;
  Eigen::Vector3d origin(place.x(), place.y(), height), normal = Eigen::Vector3d::UnitZ();
  Eigen::Quaterniond lean = Eigen::Quaterniond::Identity();
  if (scene_.start == Start::on_mold) {
    normal = scene_.mold->normal(place.x(), place.y());
    origin = scene_.mold->point(place.x(), place.y()) + 0.5 * scene_.fabric.thickness * normal;
    lean.setFromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  }
  const Eigen::Rotation2Dd turn(scene_.angle);
  for (size_t k = 0; k < padded(n); ++k) {  // padding repeats the last node and has no mass
    const Eigen::Vector2d uv = turn * scene_.mesh.rest[std::min(k, size_t(n) - 1)];
    const Eigen::Vector3d x = origin + lean * Eigen::Vector3d(uv.x(), uv.y(), 0);
    state.position.x[k] = x.x(), state.position.y[k] = x.y(), state.position.z[k] = x.z();
    state.director.x[k] = normal.x(), state.director.y[k] = normal.y(), state.director.z[k] = normal.z();
  }
  if (rig_) rig_->place(state, height);
  if (fibre_inertia_) fibre_inertia_->aim(state);
  return state;
}

}  // namespace drapeplan
