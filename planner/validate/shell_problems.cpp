#include "planner/validate/shell_problems.hpp"

#include <fmt/format.h>

#include <numbers>

#include "fem/mesh/grid.hpp"
#include "mapping/error.hpp"
#include "planner/stress/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kLength = 1, kWidth = 0.05;  // of strips [m]
constexpr Sheet kThin{1e9, 2e-3, 1};          // transverse shear and stretch change the tip by 2e-5 L at most
constexpr double kStripRest = 1e-6 * kLength;  // of strips: way that is left [m]

/// Moments about y on the two tip nodes of a strip of n elements, so that it turns upwards. @param moment  [N
/// m].
Loads tip_moment(int n, double moment) {
  return {.moments = {{n, {0, -moment / 2, 0}}, {2 * n + 1, {0, -moment / 2, 0}}}};
}

TipPlace tip_of(const Model& model, int n) {
  const State state = at_rest(model, kStripRest);
  return {state.position.x[size_t(n)] / kLength, state.position.z[size_t(n)] / kLength};
}

}  // namespace

Fabric Sheet::fabric() const {
  Fabric fabric = linear_fabric(modulus, modulus / 2, modulus / 2, compression_share);
  fabric.thickness = thickness;
  fabric.areal_density = density;
  return fabric;
}

double Sheet::bending_stiffness() const {
  const double root = std::sqrt(compression_share);
  return modulus * std::pow(thickness, 3) / 12 * 4 * compression_share / ((1 + root) * (1 + root));
}

Scene cantilever(const Sheet& sheet, double length, double width, int n) {
  Scene scene;
  scene.mesh = grid_mesh(n, 1, [=](double u, double v) { return Eigen::Vector2d(u * length, v * width); });
  scene.fabric = sheet.fabric();
  scene.options.mass_scaling = 1;
  scene.damping = 2 * sheet.frequency(kCantilever, length);
  scene.clamped = {0, n + 1};
  return scene;
}

void advance(const Model& model, State& state, Workspace& work) {
  compute_forces(model, state, work);
  kick_nodes(model, state, work);
  drift_nodes(model, state);
  advance_clock(state);
}

void settle(const Model& model, State& state, double remainder) {
  constexpr int kQuietLooks = 20;
  constexpr double kMostConstants = 400;  // time constants: far more than any problem here needs
  const double constant = 2 / model.alpha();
  const auto between = std::int64_t(std::ceil(2 * constant / kQuietLooks / model.dt()));
  const auto most = std::int64_t(kMostConstants * constant / model.dt());
  Workspace work(model);
  int quiet = 0;
  while (quiet < kQuietLooks) {
    if (!(state.step < most)) throw NotFinished(fmt::format("not at rest after {} steps", state.step));
    for (std::int64_t k = 0; k < between; ++k) advance(model, state, work);
    double speed = 0;
    for (size_t n = 0; n < size_t(model.node_count()); ++n) {
      const double v = std::hypot(state.velocity.x[n], state.velocity.y[n], state.velocity.z[n]);
      if (!(v <= speed)) speed = v;  // NaN stays
    }
    quiet = speed * constant <= remainder ? quiet + 1 : 0;
  }
}

State at_rest(const Model& model, double remainder) {
  State state = model.flat_state(0);
  settle(model, state, remainder);
  return state;
}

TipPlace under_tip_force(double k, int n) {
  Scene scene = cantilever(kThin, kLength, kWidth, n);
  const double force = k * kThin.bending_stiffness() / (kLength * kLength) * kWidth;
  scene.loads = Loads{.forces = {{n, {0, 0, force / 2}}, {2 * n + 1, {0, 0, force / 2}}}};
  return tip_of(Model(scene), n);
}

TipPlace under_tip_moment(int n) {
  Scene scene = cantilever(kThin, kLength, kWidth, n);
  scene.loads = tip_moment(n, 2 * std::numbers::pi * kThin.bending_stiffness() / kLength * kWidth);
  return tip_of(Model(scene), n);
}

double drop_under_weight(double beta, int n, double ratio, int points) {
  // Transverse shear adds beta (t / L)^2 / 5: 6e-5 at most.
  const Sheet sheet{1e9, 4e-3, 1, 1 / ratio};
  Scene scene = cantilever(sheet, kLength, kWidth, n);
  scene.options.section_points = points;
  scene.gravity = beta * sheet.bending_stiffness() / sheet.density;
  return -tip_of(Model(scene), n).up;
}

double stiffness_of_two_moduli(double ratio, int points) {
  constexpr int kElements = 4;
  const Sheet sheet{1e9, 2e-2, 1, 1 / ratio};
  Scene scene = cantilever(sheet, kLength, kWidth, kElements);
  scene.options.section_points = points;
  constexpr double kAngle = 0.05;  // at the tip, small [rad]
  scene.loads = tip_moment(kElements, kAngle * sheet.bending_stiffness() / kLength * kWidth);
  const State state = at_rest(Model(scene), 1e-8 * kLength);
  return kAngle / std::atan2(-state.director.x[kElements], state.director.z[kElements]);
}

std::array<double, 2> lifted_annulus(int across, int around) {
  constexpr double kInner = 6, kOuter = 10, kLoad = 0.8;
  const Sheet sheet{21e6, 0.03, 1};
  Scene scene;
  scene.mesh = grid_mesh(around, across, [](double u, double v) {
    const double r = kOuter - v * (kOuter - kInner), angle = 2 * std::numbers::pi * u;
    return Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
  });
  scene.fabric = sheet.fabric();
  scene.options.mass_scaling = 1;
  scene.options.hourglass = 0.01;
  scene.options.fibre_points = 1;
  scene.damping = 2 * sheet.frequency(5, 8 * std::numbers::pi);  // found by trial: fastest to rest
  Loads loads;
  for (int j = 0; j <= across; ++j) {
    const int root = j * (around + 1), tip = root + around;
    scene.clamped.push_back(root);
    const double share = (j == 0 || j == across ? 0.5 : 1.0) * (kOuter - kInner) / across;
    loads.forces.push_back({tip, {0, 0, kLoad * share}});
  }
  scene.loads = loads;
  const State state = at_rest(Model(scene), 1e-3 * kOuter);
  const auto tip = size_t(around);
  return {state.position.z[size_t(across * (around + 1)) + tip], state.position.z[tip]};
}

double plate_deflection(PlateEdge edge, PlateLoad load, int n, double expected) {
  // Side 1 m; the transverse shear adds about 4 (t / a)^2 = 1e-4 to the deflection.
  constexpr Sheet kPlate{1e9, 5e-3, 1};
  constexpr double kSmall = 1e-3;  // deflection over thickness: membrane forces add its square
  Scene scene;
  scene.mesh = grid_mesh(n, n, [](double u, double v) { return Eigen::Vector2d(u, v); });
  scene.fabric = kPlate.fabric();
  scene.options.mass_scaling = 1;
  (edge == PlateEdge::supported ? scene.pinned : scene.clamped) = scene.mesh.outline;
  // Lowest frequencies of the supported and of the clamped square plate: Leissa (1969).
  scene.damping = 2 * kPlate.frequency(edge == PlateEdge::supported ? 19.74 : 35.99, 1);
  const double unit = kSmall * kPlate.thickness / expected;
  const double force = unit * kPlate.bending_stiffness();
  const int middle = (n / 2) * (n + 1) + n / 2;
  if (load == PlateLoad::uniform) {
    scene.loads = Loads{.pressure = {0, 0, force}};
  } else {
    scene.loads = Loads{.forces = {{middle, {0, 0, force}}}};
  }
  const State state = at_rest(Model(scene), 1e-5 * kSmall * kPlate.thickness);
  return state.position.z[size_t(middle)] / unit;
}

}  // namespace drapeplan
