// The shell in single precision: its forces and strains against those in double, its rest, its step, a drape.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>

#include "fem/model/fingerprint.hpp"
#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "planner/case/file.hpp"
#include "planner/drape/problem.hpp"
#include "tests/fem/core/term_kit.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

using test::get;
using test::put;

constexpr double kFloatUnit = 6e-8;  // half the distance of floats near 1

/// The woven law with rates on every curve, a hundred times faster one stiffer by a tenth to twice as stiff.
Fabric rated_fabric() {
  Fabric fabric = test::woven_fabric();
  for (auto [table, factor] :
       {std::pair{&fabric.tension, 1.1}, {&fabric.compression, 2.0}, {&fabric.shear, 1.8}}) {
    Curve fast = table->slowest();
    for (double& stress : fast.stress) stress *= factor;
    table->curves = {table->slowest(), fast};
    table->rates = {1e-4, 1e-2};
  }
  fabric.rate_floor = 1e-4;
  return fabric;
}

struct Forced {
  std::vector<Eigen::Vector3d> force, moment;
  State state;  ///< its history is that after the forces
};

Forced forced(const Scene& scene, Precision precision, const std::function<void(State&)>& move,
              int times = 1) {
  Scene mine = scene;
  mine.options.precision = precision;
  const Model model(mine);
  State state = model.flat_state(0.02);
  std::vector<Forces> entries = model.shell().entries();
  for (int k = 0; k < times; ++k) {
    move(state);
    model.shell().forces(state, entries.data());
  }
  Forced out{{}, {}, state};
  for (size_t n = 0; n < size_t(model.node_count()); ++n) {
    out.force.push_back(get(entries[0].force, n));
    out.moment.push_back(get(entries[0].moment, n));
  }
  return out;
}

double largest_difference(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double largest = 0;
  for (size_t n = 0; n < a.size(); ++n) largest = std::max(largest, (a[n] - b[n]).norm());
  return largest;
}

/// Section points, points across, mesh of rectangles, rates.
using Kernel = std::tuple<int, int, bool, bool>;

class SinglePrecision : public ::testing::TestWithParam<Kernel> {
 protected:
  SinglePrecision() {
    const auto [points, across, rectangles, rates] = GetParam();
    // An odd number of blocks, ends of rows: 17 x 3 elements, and gathered ones.
    scene.fabric = rates ? rated_fabric() : test::woven_fabric();
    scene.options.section_points = points;
    scene.options.fibre_points = across;
    strip = scene;
    scene.mesh = mesh_of(0.03, rectangles);
    strip.mesh = mesh_of(0.01, rectangles);
  }
  static Mesh mesh_of(double height, bool rectangles) {
    return rectangles ? rectangle_mesh(0.17, height, 0.01) : test::distorted_mesh(0.17, height, 0.01, 0.2);
  }
  Scene scene;
  Scene strip;  ///< one row: no idle lanes, whose remembered strains are of elements that do not exist
};

std::string kernel_name(const ::testing::TestParamInfo<Kernel>& instance) {
  const auto [points, across, rectangles, rates] = instance.param;
  return std::to_string(points) + "Points" + std::to_string(across) + "Across" +
         (rectangles ? "Rectangles" : "Distorted") + (rates ? "Rates" : "");
}
INSTANTIATE_TEST_SUITE_P(Kernels, SinglePrecision,
                         ::testing::Combine(::testing::Values(1, 3, 5), ::testing::Values(1, 2),
                                            ::testing::Bool(), ::testing::Bool()),
                         kernel_name);

TEST_P(SinglePrecision, HasTheForcesOfDoubleInRandomDeformedStates) {
  double force = 0, moment = 0, strain = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto forced_in = [&](const Scene& of, Precision precision) {
      const auto move = [&](State& state) {
        // Bent, sheared by up to 30 degrees, stretched by up to a percent.
        for (size_t n = 0; n < of.mesh.rest.size(); ++n) {
          const Eigen::Vector2d X = of.mesh.rest[n];
          put(state.position, n,
              {X.x() + 0.2 * X.y(), (1 + 0.005 * seed / 5) * X.y() + 0.3 * X.x(), 0.1 * X.x() * X.x()});
        }
        test::disturb(state, of.mesh.node_count(), 2e-5, 0.05, seed);
      };
      return forced(of, precision, move, 3);
    };
    const Forced one = forced_in(scene, Precision::double_lanes);
    const Forced two = forced_in(scene, Precision::single_lanes);
    force = std::max(force, largest_difference(one.force, two.force) / test::TermForces::largest(one.force));
    moment =
        std::max(moment, largest_difference(one.moment, two.moment) / test::TermForces::largest(one.moment));
    const std::vector<double> right = forced_in(strip, Precision::double_lanes).state.history;
    const std::vector<double> rounded = forced_in(strip, Precision::single_lanes).state.history;
    ASSERT_EQ(right.size(), rounded.size());
    for (size_t k = 0; k < right.size(); ++k)
      strain = std::max(strain, std::abs(rounded[k] - right[k]) / std::max(std::abs(right[k]), 1e-4));
  }
  EXPECT_LE(force, 2e-6);   // 1e-6 measured
  EXPECT_LE(moment, 4e-6);  // 2.3e-6
  EXPECT_LE(strain, 40 * kFloatUnit);
}

TEST_P(SinglePrecision, HasNoForcesAtRestWhereverThePlyIsAndHoweverItIsTurned) {
  const int nodes = scene.mesh.node_count();
  const auto bent = [&](State& state) { test::disturb(state, nodes, 2e-5, 0.05); };
  const double usual = test::TermForces::largest(forced(scene, Precision::single_lanes, bent).force);
  for (const double far : {0.0, 10.0, 1000.0}) {
    for (const double angle : {0.0, 0.5 * std::numbers::pi, 2.0}) {
      const auto at_rest = [&](const Scene& of) {
        return forced(of, Precision::single_lanes, [&](State& state) {
          const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
          test::rotate(state, of.mesh.node_count(), Eigen::AngleAxisd(angle, axis).toRotationMatrix());
          for (size_t n = 0; n < of.mesh.rest.size(); ++n)
            put(state.position, n, get(state.position, n) + far * Eigen::Vector3d(1, -0.7, 0.3));
        });
      };
      const Forced rest = at_rest(scene);
      double strain = 0;
      for (const double e : at_rest(strip).state.history) strain = std::max(strain, std::abs(e));
      // What positions in double leave over 10 mm, but for sines, which have the bits of floats.
      const double round_off = 4e-14 * (1 + far);
      SCOPED_TRACE(far);
      SCOPED_TRACE(angle);
      EXPECT_LE(strain, round_off);
      EXPECT_LE(test::TermForces::largest(rest.force), (1e-7 + 1e3 * round_off) * usual);
    }
  }
}

TEST_P(SinglePrecision, HasForcesWithoutResultant) {
  scene.options.bulk_viscosity = 0;
  const Forced f = forced(scene, Precision::single_lanes,
                          [&](State& state) { test::disturb(state, scene.mesh.node_count(), 4e-5, 0.05); });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), turning = sum;
  double size = 0;
  for (size_t n = 0; n < f.force.size(); ++n) {
    sum += f.force[n];
    turning += get(f.state.position, n).cross(f.force[n]) + get(f.state.director, n).cross(f.moment[n]);
    size += f.force[n].norm();
  }
  EXPECT_LE(sum.norm(), 1e-12 * size);
  EXPECT_LE(turning.norm(), 1e-8 * size);
}

class SingleSteps : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Rates, SingleSteps, ::testing::Bool());

TEST_P(SingleSteps, StayBoundedAtNineTenthsOfTheStableStep) {
  constexpr int kSteps = 4000;
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.06, 0.02);
  scene.fabric = GetParam() ? rated_fabric() : test::woven_fabric();
  for (const Precision precision : {Precision::double_lanes, Precision::single_lanes}) {
    scene.options.precision = precision;
    EXPECT_LE(test::growth(scene, 0.9, kSteps,
                           [](const Model& model) {
                             State state = model.flat_state(0);
                             test::disturb(state, model.node_count(), 1e-6, 1e-3);
                             return state;
                           }),
              test::kBoundedGrowth);
  }
}

TEST(SingleModel, HasTheStableStepOfDoubleAndAnotherFingerprint) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.1, 0.06, 0.02);
  scene.fabric = test::woven_fabric();
  const Model one(scene);
  scene.options.precision = Precision::single_lanes;
  const Model two(scene);
  EXPECT_EQ(one.stable_dt(), two.stable_dt());
  EXPECT_NE(fingerprint(one), fingerprint(two));
  EXPECT_EQ(one.term_names(), two.term_names());
}

TEST(SingleDrape, ClosesItsBooksAndEndsWithTheScoresOfDouble) {
  std::array<Drape, 2> drape;
  for (const bool single : {false, true}) {
    CaseReading read = read_case(std::filesystem::path(DRAPEPLAN_SOURCE_DIR) / "cases/flexdraper-quick.json",
                                 {std::string("fem.precision=") + (single ? "single" : "double")});
    ASSERT_TRUE(read.errors.empty());
    const DrapeProblem problem(std::move(read.definition));
    drape[single ? 1 : 0] =
        problem.run(to_schedule(problem.frame(), uniform_strokes(problem.frame())), "report");
  }
  const Score &one = drape[0].score, &two = drape[1].score;
  ASSERT_TRUE(one.valid);
  ASSERT_TRUE(two.valid) << two.reason;
  EXPECT_LE(drape[1].run.summary.energy.balance_error, 1e-9);
  EXPECT_NEAR(two.max_gap, one.max_gap, 2e-5);
  EXPECT_NEAR(two.max_boundary_offset, one.max_boundary_offset, 2e-5);
}

}  // namespace
}  // namespace drapeplan
