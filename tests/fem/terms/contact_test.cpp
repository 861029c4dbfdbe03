// Contact and friction where everything is known: distances, inclines, collisions, rest.
#include "fem/terms/contact.hpp"

#include <gtest/gtest.h>

#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "tests/fem/run/scenes.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

constexpr double kGravity = 9.81;
constexpr double kHalf = 1.5e-4;  // half the thickness [m]
constexpr double kDegree = std::numbers::pi / 180;

/// Nodes without a ply, touching a mold with springs of 1 N/m.
struct Touch {
  explicit Touch(const Mold& mold, size_t count = 1, double damping = 0, std::optional<double> friction = {})
      : term(make_contact(mold, friction,
                          {std::vector<double>(count, 1.0), std::vector<double>(count, damping)}, kHalf)),
        entries(term->entries()) {
    state.position = state.velocity = state.anchor = VectorField(int(count));
    state.stuck.assign(padded(int(count)), 0.0);
  }
  Eigen::Vector3d force(size_t n = 0) {
    term->forces(state, entries.data());
    return test::get(entries[0].force, n);
  }
  std::unique_ptr<Term> term;
  std::vector<Forces> entries;
  State state;
};

TEST(Contact, MeasuresGapAndNormalAsTheClosestPointDoes) {
  for (const Mold& mold : {article_mold(), sphere({0, 0, 0}, 0.2), cylinder({0, 0, 0}, 0.3, 0.05)}) {
    constexpr size_t kPoints = 400;
    Touch touch(mold, kPoints);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Eigen::Vector3d> normal(kPoints);
    std::vector<double> depth(kPoints);
    const Extent& extent = mold.extent();
    for (size_t n = 0; n < kPoints; ++n) {
      const Eigen::Vector2d at =
          extent.lower +
          Eigen::Vector2d(unit(random), unit(random)).cwiseProduct(extent.upper - extent.lower);
      normal[n] = mold.normal(at.x(), at.y());
      depth[n] = 2e-5 * unit(random);
      test::put(touch.state.position, n, mold.point(at.x(), at.y()) + (kHalf - depth[n]) * normal[n]);
    }
    touch.force();
    double steepest = 1;
    for (size_t n = 0; n < kPoints; ++n) {
      const Eigen::Vector3d force = test::get(touch.entries[0].force, n);
      EXPECT_LE(std::abs(force.norm() - depth[n]), 1e-10);
      EXPECT_LE((force.normalized() - normal[n]).norm(), 1e-5);
      steepest = std::min(steepest, normal[n].z());
    }
    EXPECT_LE(steepest, 0.95);
  }
}

TEST(Contact, DoesNoWorkOnANodeThatIsDraggedAroundALoop) {
  const Mold mold = article_mold();
  Touch touch(mold);
  constexpr int kPoints = 20000;
  const auto place = [&](double turn) {  // a loop at 54 degrees of slope, deeper on one side
    const Eigen::Vector2d at(0.01 + 0.005 * std::cos(turn), 0.01 + 0.005 * std::sin(turn));
    const double depth = 1e-4 * (1 + 0.5 * std::cos(turn + 1));
    return Eigen::Vector3d(mold.point(at.x(), at.y()) + (kHalf - depth) * mold.normal(at.x(), at.y()));
  };
  double sum = 0, size = 0;
  for (int k = 0; k < kPoints; ++k) {
    const double turn = 2 * std::numbers::pi / kPoints;
    test::put(touch.state.position, 0, place((k + 0.5) * turn));
    const double work = touch.force().dot(place((k + 1) * turn) - place(k * turn));
    sum += work;
    size += std::abs(work);
  }
  EXPECT_GT(size, 1e-9);
  EXPECT_LE(std::abs(sum), 1e-5 * size);
}

TEST(Contact, PressesAndNeverPulls) {
  Touch touch(inclined_plane(0), 1, 1e-3);
  test::put(touch.state.position, 0, {0, 0, kHalf - 1e-5});
  test::put(touch.state.velocity, 0, {0, 0, -0.01});
  EXPECT_NEAR(touch.force().z(), 1e-5 + 1e-5, 1e-12);
  test::put(touch.state.velocity, 0, {0, 0, 1});
  EXPECT_EQ(touch.force().z(), 0);
  test::put(touch.state.position, 0, {0, 0, kHalf + 1e-9});
  test::put(touch.state.velocity, 0, {0, 0, -1});
  EXPECT_EQ(touch.force().z(), 0);
}

// Coulomb's law of impact: within the friction cone the node sticks, outside it is held by mu times the push.
TEST(Friction, ActsInTheStepInWhichANodeTouchesAnew) {
  for (const double speed : {0.03, 3.0}) {  // along the mold, at 0.1 m/s towards it; mu = 0.5
    Touch touch(inclined_plane(0), 1, 1e-3, 0.5);
    test::put(touch.state.position, 0, {0, 0, kHalf - 1e-6});
    test::put(touch.state.velocity, 0, {speed, 0, -0.1});
    const double push = touch.force().z();
    const Eigen::Vector3d held = test::get(touch.entries[1].force, 0);
    EXPECT_NEAR(held.x(), -push * std::min(speed / 0.1, 0.5), 1e-9 * push);
    EXPECT_LE(std::abs(held.y()) + std::abs(held.z()), 1e-12 * push);
  }
}

/// A small stiff sheet laid on a plane that falls by `angle` towards +x, sunk by `sunk` static penetrations.
struct Incline {
  Incline(double angle, double friction, double sunk) {
    scene.mesh = rectangle_mesh(0.04, 0.04, 0.02);
    scene.fabric = test::linear_fabric(1e9, 1e8, 1e7);
    scene.options.mass_scaling = 1;
    scene.gravity = kGravity;
    scene.mold.emplace(inclined_plane(angle));
    scene.friction = friction;
    scene.start = Start::on_mold;
    model.emplace(scene);
    state = model->flat_state(0);
    NodalStiffness stiffness(9);
    model->terms().front()->add_stiffness(stiffness);
    const std::vector<double> area = nodal_areas(scene.mesh);
    for (size_t n = 0; n < size_t(model->node_count()); ++n) {
      const double weight = 0.314 * area[n] * kGravity * std::cos(angle);
      const double depth = weight / (scene.options.contact_stiffness * stiffness.translation[n]);
      test::put(state.position, n, test::get(state.position, n) - sunk * depth * scene.mold->normal(0, 0));
    }
    work.emplace(*model);
  }
  [[nodiscard]] Eigen::Vector3d middle() const {
    return test::get(state.position, size_t(model->node_count() / 2));
  }
  /// Distance moved by the sheet's middle in `time`.
  double slide(double time) {
    const Eigen::Vector3d start = middle();
    const auto steps = int(std::lround(time / model->dt()));
    for (int k = 0; k < steps; ++k) {
      compute_forces(*model, state, *work);
      kick_nodes(*model, state, *work);
      book_work(*model, state, *work);
      drift_nodes(*model, state);
      ++state.step;
    }
    return (middle() - start).norm();
  }
  Scene scene;
  std::optional<Model> model;
  State state;
  std::optional<Workspace> work;
};

TEST(Friction, HoldsASheetBelowItsAngleWithoutCreepHoweverItWasPutDown) {
  for (const double sunk : {0.0, 0.5, 1.0, 1.5, 2.0}) {
    Incline incline(std::atan(0.5) - 0.02, 0.5, sunk);
    EXPECT_LE(incline.slide(0.01), 5e-7) << sunk;  // settles: its elastic slip and some
    EXPECT_LE(incline.slide(0.1), 1e-12) << sunk;
    EXPECT_LE(kinetic_energy(*incline.model, incline.state), 1e-24) << sunk;
  }
}

TEST(Friction, StaysAtRestWithoutCreepOrNoise) {
  Incline incline(30 * kDegree, 0.7, 0);
  incline.slide(0.1);
  EXPECT_LE(incline.slide(2), 1e-12);
  EXPECT_LE(kinetic_energy(*incline.model, incline.state), 1e-24);
}

TEST(Friction, OfCoefficientOneAndAHalfHoldsAt56Point2AndSlipsAt56Point4Degrees) {
  Incline stick(56.2 * kDegree, 1.5, 1), slip(56.4 * kDegree, 1.5, 1);
  stick.slide(0.02);
  slip.slide(0.02);
  EXPECT_LE(stick.slide(0.1), 1e-12);
  EXPECT_GE(slip.slide(0.1), 1e-5);  // 0.02 m/s^2
}

TEST(Friction, LetsASheetSlideAboveItsAngleWithTheClosedFormAcceleration) {
  const double angle = std::atan(0.5) + 0.2;
  const double acceleration = kGravity * (std::sin(angle) - 0.5 * std::cos(angle));
  Incline incline(angle, 0.5, 0);
  const double time = 0.2;
  EXPECT_NEAR(incline.slide(time), 0.5 * acceleration * time * time,
              0.001 * 0.5 * acceleration * time * time);
}

TEST(Friction, StopsASlidingSheetAfterVSquaredOverTwoMuG) {
  constexpr double kSpeed = 0.5, kCoefficient = 0.5;
  Incline incline(0, kCoefficient, 1);
  for (size_t n = 0; n < 9; ++n) incline.state.velocity.x[n] = kSpeed;
  const double path = kSpeed * kSpeed / (2 * kCoefficient * kGravity);
  EXPECT_NEAR(incline.slide(0.15), path, 1e-3 * path);
  EXPECT_LE(incline.slide(0.05), 1e-12);
  const Energies books = energies(*incline.model, incline.state);
  const double kinetic = 0.5 * 0.314 * 0.04 * 0.04 * kSpeed * kSpeed;
  EXPECT_NEAR(books.friction, kinetic, 1e-3 * kinetic);
}

TEST(Contact, CarriesTheWeightOfAPlyAtRest) {
  Incline incline(0, 0.5, 0);
  incline.slide(0.02);
  double press = 0;
  for (size_t n = 0; n < 9; ++n) press += incline.work->entries[2].force.z[n];
  EXPECT_NEAR(press, 0.314 * 0.04 * 0.04 * kGravity, 1e-9 * press);
}

TEST(Contact, LetsABounceDieAndOnlyTakesEnergy) {
  Incline incline(0, 0.5, 0);
  constexpr double kDrop = 1e-3;
  for (size_t n = 0; n < 9; ++n) incline.state.position.z[n] += kDrop;
  double highest = kDrop, taken = 0;
  for (int k = 0; k < 10; ++k) {  // touches down after 14 ms
    incline.slide(0.02);
    const double taken_now = energies(*incline.model, incline.state).contact;
    EXPECT_GE(taken_now, taken * (1 - 1e-9));
    taken = taken_now;
    highest = incline.middle().z() - kHalf;
  }
  EXPECT_LE(highest, 0);
  const double drop_energy = 0.314 * 0.04 * 0.04 * kGravity * kDrop;
  EXPECT_LE(kinetic_energy(*incline.model, incline.state), 1e-9 * drop_energy);
  EXPECT_GE(taken, 0.5 * drop_energy);
}

// The bound of the step counts springs and dashpots: at the bound itself a pressed sheet stays quiet.
TEST(Contact, IsStableAtTheBoundOfTheStep) {
  for (const double damping : {0.0, 0.2, 1.0}) {
    Scene scene;
    scene.mesh = rectangle_mesh(0.04, 0.04, 0.01);
    scene.fabric = test::linear_fabric(1e9, 1e8, 1e7);
    scene.options.step_safety = 1;
    scene.options.contact_stiffness = 10;  // contact governs
    scene.options.contact_damping = damping;
    scene.gravity = kGravity;
    scene.mold.emplace(inclined_plane(0.1));
    scene.friction = 0.5;
    scene.start = Start::on_mold;
    const Model model(scene);
    State state = model.flat_state(0);
    test::disturb(state, model.node_count(), 1e-7, 1e-4);
    Workspace work(model);
    const double start = 1e-3;  // m/s; 1e-7 m at the highest frequency are 0.1 m/s
    for (int k = 0; k < 20000; ++k) {
      compute_forces(model, state, work);
      kick_nodes(model, state, work);
      drift_nodes(model, state);
    }
    double fastest = 0;
    for (size_t n = 0; n < size_t(model.node_count()); ++n)
      fastest = std::max(fastest, test::get(state.velocity, n).norm());
    EXPECT_LE(fastest, 100 * start) << damping;
  }
}

TEST(Start, OnTheMoldTouchesItFlatInItsTangentPlane) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.04, 0.04, 0.02);
  scene.fabric = test::linear_fabric(1e9, 1e8, 1e7);
  scene.mold = article_mold();
  scene.position = {0.06, 0.08};
  scene.angle = 0.4;
  scene.start = Start::on_mold;
  const State state = Model(scene).flat_state(7);
  const ClosestPoint foot = scene.mold->closest(test::get(state.position, 4));
  EXPECT_NEAR(foot.signed_distance, kHalf, 1e-12);
  EXPECT_LE((foot.foot.head<2>() - scene.position).norm(), 1e-12);
  for (size_t n = 0; n < 9; ++n) {
    EXPECT_LE((test::get(state.director, n) - foot.normal).norm(), 1e-12);
    EXPECT_LE(std::abs((test::get(state.position, n) - test::get(state.position, 4)).dot(foot.normal)),
              1e-15);
  }
  scene.mold.reset();
  EXPECT_THROW(Model{scene}, std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
