// Two shear tests of fabrics against the kinematics and the power balance of inextensible fibres.
//
// Bias extension (H = 270 mm between the grips, W = 120 mm, fibres at +-45 degrees; [Krogh], "Bias-extension
// Test"): triangles at the grips stay rigid, the middle shears by g, the zones between by g / 2, with
//   g = 90 deg - 2 acos((L0 + d) / (sqrt(2) L0)),  L0 = H - W                            ([Krogh], Eq. (8))
//   F (H - W) (cos(g/2) - sin(g/2)) / 2 = W (2 H - 3 W) / 2 C(g) + W^2 / 2 C(g/2),  C = t tau(g)
// Mesh lines run through the specimen's corners, so they run along the borders of the zones: the exact
// solution lies in the mesh's space.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kLength = 0.27, kWidth = 0.12, kFree = kLength - kWidth;

/// Shear law of the tests: convex and concave pieces, as a prepreg's.
const Curve kShear{{0, 5 * kDegree, 20 * kDegree, 50 * kDegree}, {0, 0.06e6, 0.1e6, 0.5e6}};

Fabric fabric_of(double fibre_modulus) {
  Fabric fabric = test::linear_fabric(fibre_modulus, 1, 2e5);
  fabric.shear = kShear;
  return fabric;
}

/// The upright specimen: its mesh has the fibres along u and v, the ply frame is turned by -45 degrees.
Scene specimen(double mesh_size, double velocity, double ramp) {
  Scene scene;
  const Eigen::Rotation2Dd turn(45 * kDegree);
  Polygon outline;
  for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
    outline.push_back(turn * Eigen::Vector2d(x * kWidth, y * kLength));
  scene.mesh = outline_mesh(outline, mesh_size);
  scene.angle = -45 * kDegree;
  scene.fabric = fabric_of(20e9);
  scene.options.mass_scaling = 20;
  scene.grips = {{"foot", {}, {0, 0, 0}, ramp}, {"head", {}, {0, velocity, 0}, ramp}};
  for (const int n : scene.mesh.outline) {
    const double along = (turn.inverse() * scene.mesh.rest[size_t(n)]).y();
    if (along < -0.5 * kLength + 1e-9) scene.grips[0].nodes.push_back(n);
    if (along > 0.5 * kLength - 1e-9) scene.grips[1].nodes.push_back(n);
  }
  return scene;
}

double ideal_shear(double d) {
  return 90 * kDegree - 2 * std::acos((kFree + d) / (std::numbers::sqrt2 * kFree));
}

double ideal_force(double shear, double thickness) {
  const double middle = kWidth * (2 * kLength - 3 * kWidth) / 2 * kShear(shear);
  const double sides = kWidth * kWidth / 2 * kShear(shear / 2);
  return thickness * (middle + sides) / (kFree * (std::cos(shear / 2) - std::sin(shear / 2)) / 2);
}

/// Mean shear of the middle zone, along its axis from one grip's triangle to the other's, and of the side
/// zones.
struct ZoneShear {
  double middle = 0, axis = 0, sides = 0;
};

ZoneShear zone_shear(const Mesh& mesh, const Snapshot& snapshot) {
  ZoneShear sum, area;
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    const auto& quad = mesh.quads[e];
    const auto corner = [&mesh, &quad](size_t c) -> const Eigen::Vector2d& {
      return mesh.rest[size_t(quad[c])];
    };
    const Eigen::Vector2d middle = 0.25 * (corner(0) + corner(1) + corner(2) + corner(3));
    const Eigen::Vector2d place = (Eigen::Rotation2Dd(-45 * kDegree) * middle).cwiseAbs();  // upright
    const Eigen::Vector2d ac = corner(2) - corner(0), bd = corner(3) - corner(1);
    const double size = 0.5 * (ac.x() * bd.y() - ac.y() * bd.x()), shear = std::abs(snapshot.shear[e]);
    const auto add = [&](double ZoneShear::*zone) {
      sum.*zone += size * shear;
      area.*zone += size;
    };
    if (place.x() + place.y() < 0.5 * kFree) {
      add(&ZoneShear::middle);
      if (place.x() < 1e-9) add(&ZoneShear::axis);
    } else if (place.y() - place.x() < 0.5 * kFree) {
      add(&ZoneShear::sides);
    }
  }
  return {sum.middle / area.middle, sum.axis / area.axis, sum.sides / area.sides};
}

/// Runs the test to 40 mm and compares all frames from 5 mm on.
/// Measured: along the axis 0.3 %, zones 0.4 %, force 0.8 %. Within the middle zone the angle scatters by 5
/// %, less the slower and the stiffer in shear: its fibres are not of equal length, and the least energy is
/// not quite the ideal field; only the mean along the axis is fixed by the grips.
/// @param limit  of the relative errors of zones and force; half of it along the axis.
void expect_ideal(double mesh_size, double velocity, double limit) {
  constexpr double kRamp = 0.3, kEnd = 0.04;  // [s], [m]
  const Scene scene = specimen(mesh_size, velocity, kRamp);
  std::vector<Snapshot> frames;
  const RunResult run =
      simulate(Model(scene), {.schedule = nullptr,
                              .duration = kEnd / velocity + kRamp / 2,
                              .frames = 24,
                              .observe = [&frames](const Snapshot& frame) { frames.push_back(frame); }});
  ASSERT_EQ(run.summary.status, RunStatus::done) << run.summary.message;
  EXPECT_LE(run.summary.energy.balance_error, 1e-10);
  ASSERT_EQ(frames.size(), 24U);
  const auto head = size_t(scene.grips[1].nodes[0]);
  double work = 0, last_d = 0, last_force = 0;
  for (const Snapshot& frame : frames) {
    const double d = frame.position[head].y() - frames[0].position[head].y(), force = frame.grip_force[1].y();
    work += 0.5 * (force + last_force) * (d - last_d);
    last_d = d;
    last_force = force;
    if (d < 0.005) continue;
    SCOPED_TRACE(testing::Message() << "at " << 1e3 * d << " mm");
    const ZoneShear shear = zone_shear(scene.mesh, frame);
    const double ideal = ideal_shear(d), wanted = ideal_force(ideal, scene.fabric.thickness);
    EXPECT_LE(std::abs(shear.axis / ideal - 1), 0.5 * limit);
    EXPECT_LE(std::abs(shear.middle / ideal - 1), limit);
    EXPECT_LE(std::abs(shear.sides / (0.5 * ideal) - 1), limit);
    EXPECT_LE(std::abs(force / wanted - 1), limit);
    EXPECT_LE(std::abs(frame.grip_force[0].y() / force + 1), 0.01);
    EXPECT_LE(std::abs(frame.grip_force[1].x()), 0.01 * force);
  }
  EXPECT_NEAR(last_d, kEnd, 1e-6);
  EXPECT_LE(std::abs(work / run.summary.energy.external - 1), 0.01);  // what is booked is force times way
}

TEST(BiasExtension, HasThePublishedAngles) {  // H = 270 mm, W = 120 mm, at 10, 20, 30 and 40 mm
  const std::array<double, 4> known{7.919, 16.526, 26.104, 37.189};
  for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(ideal_shear(0.01 * double(k + 1)) / kDegree, known[k], 1e-3);
}

TEST(BiasExtension, FollowsTheKinematicsAndThePowerBalanceOfInextensibleFibres) {
  expect_ideal(0.0213, 0.04, 0.01);  // cells of 21.2 mm, four over the width of the specimen along each fibre
}

TEST(BiasExtension, FollowsThemWithCellsThatDoNotDivideTheSpecimen) {
  // The mesh takes the next smaller size that does, 10.6 mm. Up to 32 mm it stays within 1 %; at 40 mm and 37
  // degrees the force is 1.7 % high (it trembles by 0.2 %), whatever the speed: fibres turn sharply between
  // the zones, within one element.
  expect_ideal(0.013, 0.03, 0.02);
}

/// A square of fabric in a hinged frame that has sheared by `shear`: the place of a rest point.
Eigen::Vector3d framed(const Eigen::Vector2d& rest, double shear) {
  const double c = std::cos(shear / 2), s = std::sin(shear / 2);
  return {c * rest.x() + s * rest.y(), s * rest.x() + c * rest.y(), 0};
}

TEST(PictureFrame, ShearsHomogeneouslyAndItsForceIsThatOfThePowerBalance) {
  constexpr double kSide = 0.2, kSpan = 1, kLargest = 40 * kDegree;  // [m], [s]
  Scene scene;
  scene.mesh = rectangle_mesh(kSide, kSide, 0.0201);
  scene.fabric = fabric_of(20e9);
  scene.clamped = scene.mesh.outline;
  const Model model(scene);
  State state = model.flat_state(0);
  Workspace work(model);
  const auto shear_at = [](double t) {  // from rest to rest
    const double s = t / kSpan;
    return kLargest * s * s * (3 - 2 * s);
  };
  double worst_force = 0, worst_angle = 0;
  int compared = 0;
  for (double next = 0.2; state.time < 0.9 * kSpan;) {
    const double now = shear_at(state.time), after = shear_at(state.time + state.dt);
    compute_forces(model, state, work);
    kick_nodes(model, state, work);
    double work_of_frame = 0;  // per shear angle [N m]
    for (const int node : scene.mesh.outline) {
      const auto n = size_t(node);
      const Eigen::Vector2d& rest = scene.mesh.rest[n];
      const Eigen::Vector3d way = framed(rest, after) - framed(rest, now);
      work_of_frame -= test::get(work.entries[0].force, n).dot(way) / (after - now);
      test::put(state.velocity, n, way / state.dt);
    }
    if (state.time >= next) {
      next += 0.01;
      ++compared;
      // Force on a pair of opposite hinges whose distance sqrt(2) a (cos(g/2) + sin(g/2)) grows with g.
      const double opening = kSide / std::numbers::sqrt2 * (std::cos(now / 2) - std::sin(now / 2));
      const double wanted = kShear(now) * scene.fabric.thickness * kSide * kSide / opening;
      worst_force = std::max(worst_force, std::abs(work_of_frame / opening / wanted - 1));
      Snapshot strains;
      model.shell().strains(state, strains);
      for (const double shear : strains.shear) worst_angle = std::max(worst_angle, std::abs(shear / now - 1));
    }
    drift_nodes(model, state);
    advance_clock(state);
  }
  EXPECT_GE(compared, 60);
  EXPECT_LE(worst_angle, 0.01);
  EXPECT_LE(worst_force, 0.01);
}

}  // namespace
}  // namespace drapeplan
