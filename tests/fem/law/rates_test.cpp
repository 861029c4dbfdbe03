// Stress that depends on the rate of strain: the tables, their resampled form, elements driven by hand.
#include "fem/law/rates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fem/run/simulate.hpp"
#include "fem/run/workspace.hpp"
#include "tests/fem/run/scenes.hpp"

namespace drapeplan {
namespace {

constexpr double kFloor = 1e-4;   // [1/s]
constexpr double kFilter = 0.02;  // [s]

Curve times(const Curve& curve, double factor) {
  Curve out = curve;
  for (double& stress : out.stress) stress *= factor;
  return out;
}

/// The woven law of the tests with the rates of the article's prepreg: 1e-15 to 1e-3 / s along the fibres.
Fabric rated_fabric() {
  Fabric fabric = test::woven_fabric();
  const Curve tension = fabric.tension.slowest(), compression = fabric.compression.slowest(),
              shear = fabric.shear.slowest();
  fabric.tension.curves = {tension, times(tension, 1.2)};
  fabric.tension.rates = {1e-15, 1e-2};
  fabric.compression.curves = {compression, times(compression, 1.3), times(compression, 1.9),
                               times(compression, 2.5)};
  fabric.compression.rates = {1e-15, 1e-4, 4e-4, 1e-3};
  fabric.shear.curves = {times(shear, 0.7), shear, times(shear, 1.8)};
  fabric.shear.rates = {4.44e-4, 2.22e-3, 2.22e-2};
  fabric.rate_floor = kFloor;
  fabric.rate_filter = kFilter;
  return fabric;
}

TEST(StressTable, IsLinearInStrainAndInTheLogarithmOfOnePlusRateOverFloor) {
  const StressTable table = rated_fabric().compression;
  const auto y = [](double rate) { return std::log1p(rate / kFloor); };
  for (const double rate : {2e-4, 3e-4, 5e-4, 9.9e-4}) {
    const size_t k = rate < 4e-4 ? 1 : 2;
    const double share = (y(rate) - y(table.rates[k])) / (y(table.rates[k + 1]) - y(table.rates[k]));
    for (const double strain : {0.0, 3e-4, 0.001, 0.007}) {
      const double slow = table.curves[k](strain), fast = table.curves[k + 1](strain);
      EXPECT_NEAR(table(strain, rate, kFloor), slow + share * (fast - slow), 1e-9 * (1 + fast));
    }
  }
}

TEST(StressTable, IsConstantBeyondItsSlowestAndFastestCurveAndGoesOnBeyondItsLastStrain) {
  const StressTable table = rated_fabric().shear;
  EXPECT_EQ(table(0.3, 0, kFloor), table.curves.front()(0.3));
  EXPECT_EQ(table(0.3, 4e-4, kFloor), table.curves.front()(0.3));
  EXPECT_EQ(table(0.3, 3e-2, kFloor), table.curves.back()(0.3));
  EXPECT_EQ(table(0.3, 1e6, kFloor), table.curves.back()(0.3));
  const double end = table.slowest().strain.back();
  const double last = table(end + 0.2, 1e-3, kFloor) - table(end + 0.1, 1e-3, kFloor);
  EXPECT_NEAR(last, table(end + 0.1, 1e-3, kFloor) - table(end, 1e-3, kFloor), 1e-6 * last);
}

TEST(RateLookup, DiffersFromTheTableByLessThanOnePercentOfTheSpreadOfItsCurves) {
  const Fabric fabric = rated_fabric();
  for (const StressTable* table : {&fabric.compression, &fabric.shear}) {
    const double end = 0.9 * table->slowest().strain.back(), fastest = table->rates.back();
    const RateLookup lookup([&](double e, double rate) { return (*table)(e, rate, kFloor); }, 0, end, 1000,
                            kFloor, fastest);
    double worst = 0;
    for (int i = 1; i <= 200; ++i) {
      const double strain = end * i / 200;
      const double spread = table->curves.back()(strain) - table->curves.front()(strain);
      for (int j = 0; j <= 2000; ++j) {
        const double rate = kFloor * std::expm1(1.1 * std::log1p(fastest / kFloor) * j / 2000);
        const double got = lookup(Lanes(strain), Lanes(rate / kFloor))[0];
        worst = std::max(worst, std::abs(got - (*table)(strain, rate, kFloor)) / spread);
      }
    }
    std::printf("RateLookup: largest difference %.2e of the spread\n", worst);
    EXPECT_LE(worst, 0.01);
    EXPECT_GE(worst, 1e-5);  // measured at all: kinks between rows must be missed by something
  }
}

TEST(RateLookup, CountsOctavesLinearlyWithinEachAndBack) {
  for (double x = 1; x < 1e300; x *= 1.00137) {
    const double y = octaves(Lanes(x))[0];
    EXPECT_LE(std::abs(y - std::log2(x)), 0.0861);  // a chord of the logarithm over an octave
    EXPECT_LE(std::abs(from_octaves(y) / x - 1), 1e-12);
  }
  for (const double k : {0.0, 1.0, 5.0, 900.0}) EXPECT_EQ(octaves(Lanes(std::exp2(k)))[0], k);
}

/// One square element whose corners are put where a test says, and the stresses that it answers with.
class Element {
 public:
  explicit Element(const Fabric& fabric, double time_scaling = 1)
      : model_(scene(fabric, time_scaling)), state_(model_.flat_state(0)), work_(model_) {}

  /// One step of `dt` [s] that ends in a warp strain and a shear angle; fibres along weft keep their length.
  void step(double strain, double angle, double dt) {
    strain_ = strain;
    angle_ = angle;
    state_.dt = dt;
    for (size_t n = 0; n < 4; ++n) {
      const Eigen::Vector2d X = model_.scene().mesh.rest[n];
      test::put(state_.position, n,
                {(1 + strain) * X.x() + std::sin(angle) * X.y(), std::cos(angle) * X.y(), 0});
    }
    compute_forces(model_, state_, work_);
  }
  /// Nominal stress along warp, without shear; stress conjugate to the shear angle [Pa].
  [[nodiscard]] double fibre_stress() const { return pull(0, {1, 0, 0}); }
  [[nodiscard]] double shear_stress() const { return pull(1, {std::cos(angle_), -std::sin(angle_), 0}); }

 private:
  static Scene scene(const Fabric& fabric, double time_scaling) {
    Scene scene;
    scene.mesh = rectangle_mesh(kSize, kSize, kSize);
    scene.fabric = fabric;
    scene.options.time_scaling = time_scaling;
    scene.options.bulk_viscosity = 0;
    return scene;
  }
  /// Force from outside on the edge at the axis' positive end, along a direction, per area.
  [[nodiscard]] double pull(int axis, const Eigen::Vector3d& along) const {
    double sum = 0;
    for (size_t n = 0; n < 4; ++n) {
      if (model_.scene().mesh.rest[n][axis] > 0) sum -= test::get(work_.entries[0].force, n).dot(along);
    }
    return sum / (kSize * model_.scene().fabric.thickness);
  }

  static constexpr double kSize = 0.01;
  Model model_;
  State state_;
  Workspace work_;
  double strain_ = 0, angle_ = 0;
};

/// Stress after many filter times at a constant rate, over the table's.
double steady_ratio(const Fabric& fabric, double rate, bool shear, double time_scaling = 1) {
  Element element(fabric, time_scaling);
  const double dt = kFilter / 100 / time_scaling, sign = rate < 0 ? -1 : 1;
  double at = 0;
  for (int k = 1; k <= 1000; ++k) {  // 10 filter times
    at += rate * time_scaling * dt;
    element.step(shear ? 0 : at, shear ? at : 0, dt);
  }
  const double growth = std::abs(rate);
  if (shear) return sign * element.shear_stress() / fabric.shear(std::abs(at), growth, kFloor);
  const StressTable& table = rate < 0 ? fabric.compression : fabric.tension;
  return sign * element.fibre_stress() / table(std::abs(at), growth, kFloor);
}

TEST(Rates, CarryTheTablesStressOfASteadyRateAfterSeveralFilterTimes) {
  const Fabric fabric = rated_fabric();
  double worst = 0;
  for (const double size : {2e-4, 7e-4, 3e-3, 0.03}) {
    for (const double rate : {size, -size}) {
      worst = std::max(worst, std::abs(steady_ratio(fabric, rate, false) - 1));
      worst = std::max(worst, std::abs(steady_ratio(fabric, rate, true) - 1));
    }
  }
  std::printf("steady rates: largest difference %.2e\n", worst);
  EXPECT_LE(worst, 0.01);
}

TEST(Rates, AreThoseOfTheMaterialWhenTheScheduleIsPlayedFaster) {
  const Fabric fabric = rated_fabric();
  for (const double rate : {7e-4, -7e-4}) {
    for (const bool shear : {false, true}) {
      EXPECT_NEAR(steady_ratio(fabric, rate, shear, 20), steady_ratio(fabric, rate, shear), 1e-9);
    }
  }
}

TEST(Rates, StayBetweenTheSlowestAndTheFastestCurveFromRestToAMillionPerSecond) {
  const Fabric fabric = rated_fabric();
  Element element(fabric);
  double strain = 0, last = 0;
  for (double rate = 1e-15; rate < 1e6; rate *= 1.02) {
    const double dt = std::min(1e-3, 5e-6 / rate);
    strain += rate * dt;
    element.step(strain, 0, dt);
    const double stress = element.fibre_stress();
    const double resampled = 1e-3 * fabric.tension.curves.back()(1e-4);  // both tables' pieces of strain
    ASSERT_GE(stress, fabric.tension.curves.front()(strain) - resampled) << rate;
    ASSERT_LE(stress, fabric.tension.curves.back()(strain) + resampled) << rate;
    last = stress;
  }
  EXPECT_NEAR(last / fabric.tension.curves.back()(strain), 1, 1e-3);
}

TEST(Rates, FollowTheSlowestCurveWhereAStrainShrinks) {
  const Fabric fabric = rated_fabric();
  for (const double sign : {1.0, -1.0}) {
    const StressTable& table = sign > 0 ? fabric.tension : fabric.compression;
    Element element(fabric);
    const double dt = kFilter / 100;
    double strain = 0;
    for (int k = 0; k < 1000; ++k) element.step(strain += sign * 5e-6, 0, dt);
    EXPECT_GE(sign * element.fibre_stress(), 1.15 * table.slowest()(std::abs(strain)));
    for (int k = 0; k < 300; ++k) element.step(strain -= sign * 5e-6, 0, dt);
    EXPECT_NEAR(sign * element.fibre_stress() / table.slowest()(std::abs(strain)), 1, 1e-3);
  }
}

/// Extra stress over the slowest curve does the work W(e, l) = integral from l to e at a fixed lagged strain
/// l, and l only ever moves so that W shrinks: work done is never given back beyond what came in.
TEST(Rates, NeverGiveEnergyOverCyclesOfStrain) {
  const Fabric fabric = rated_fabric();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const bool shear : {false, true}) {
    double least = 0, most = 0, closed = 1e300;
    for (int cycle = 0; cycle < 40; ++cycle) {
      Element rated(fabric);
      Fabric slow_fabric = fabric;
      for (StressTable* table : {&slow_fabric.tension, &slow_fabric.compression, &slow_fabric.shear})
        *table = table->slowest();
      Element slow(slow_fabric);
      const double amplitude = shear ? 0.5 : 0.006, dt = kFilter * std::pow(10, unit(random) - 2);
      double at = 0, extra = 0, work = 0;
      for (int turn = 0; turn <= 8; ++turn) {
        const double from = at, to = turn == 8 ? 0 : amplitude * unit(random);
        constexpr int kSteps = 500;
        for (int k = 1; k <= kSteps; ++k) {
          const double next = from + (to - from) * k / kSteps;
          rated.step(shear ? 0 : next, shear ? next : 0, dt);
          slow.step(shear ? 0 : next, shear ? next : 0, dt);
          const double now =
              shear ? rated.shear_stress() - slow.shear_stress() : rated.fibre_stress() - slow.fibre_stress();
          work += 0.5 * (extra + now) * (next - at);
          extra = now;
          at = next;
          least = std::min(least, work);
        }
      }
      closed = std::min(closed, work);
      most = std::max(most, work);
    }
    std::printf("%s cycles: least work on the way %.2e J/m^3, least of a cycle %.2e, most %.2e\n",
                shear ? "shear" : "fibre", least, closed, most);
    EXPECT_GE(least, -1e-12);
    EXPECT_GE(closed, 1e-3 * most);
  }
}

TEST(Rates, MeasuredAsForceIsTheConjugateStressOverTheCosine) {
  Fabric conjugate = rated_fabric(), force = conjugate;
  force.shear_measure = ShearMeasure::force;
  for (const double angle : {0.1, 0.4, 0.8}) {
    Element a(conjugate), b(force);
    a.step(0, angle, 1e-3);
    b.step(0, angle, 1e-3);
    EXPECT_NEAR(b.shear_stress() / a.shear_stress(), std::cos(angle), 1e-3) << angle;
  }
}

/// A strip that falls under gravity, clamped at its left end.
Scene falling_strip(const Fabric& fabric) {
  Scene scene;
  scene.mesh = rectangle_mesh(0.08, 0.02, 0.01);
  scene.fabric = fabric;
  scene.gravity = 9.81;
  scene.damping = 22;
  for (size_t n = 0; n < scene.mesh.rest.size(); ++n) {
    if (scene.mesh.rest[n].x() < -0.0399) scene.clamped.push_back(int(n));
  }
  return scene;
}

TEST(Rates, SwitchedOffAreAMaterialWithItsSlowestCurvesOnly) {
  Scene off = falling_strip(rated_fabric()), slowest = off, on = off;
  off.options.rates = false;
  for (StressTable* table : {&slowest.fabric.tension, &slowest.fabric.compression, &slowest.fabric.shear})
    *table = table->slowest();
  const auto hash = [](const Scene& scene) {
    return simulate(Model(scene), {.duration = 0.05}).summary.state_hash;
  };
  EXPECT_EQ(hash(off), hash(slowest));
  EXPECT_NE(hash(on), hash(slowest));
}

TEST(Rates, OfASingleCurveAreNone) {
  Scene without = falling_strip(test::woven_fabric()), one = without;
  one.fabric.tension.rates = one.fabric.compression.rates = one.fabric.shear.rates = {1e-3};
  const RunResult a = simulate(Model(without), {.duration = 0.05}),
                  b = simulate(Model(one), {.duration = 0.05});
  EXPECT_EQ(a.summary.state_hash, b.summary.state_hash);
  EXPECT_EQ(Model(one).term_names().front(), "shell, 3 section points");
}

TEST(Rates, OfEqualCurvesMoveTheStripAsOneCurveDoes) {
  Scene without = falling_strip(test::woven_fabric()), equal = without;
  equal.fabric.compression.curves.assign(2, equal.fabric.compression.slowest());
  equal.fabric.compression.rates = {1e-15, 1};
  const RunResult a = simulate(Model(without), {.duration = 0.05}),
                  b = simulate(Model(equal), {.duration = 0.05});
  ASSERT_EQ(a.final.position.size(), b.final.position.size());
  for (size_t n = 0; n < a.final.position.size(); ++n)
    EXPECT_LE((a.final.position[n] - b.final.position[n]).norm(), 1e-9);
}

TEST(Rates, LetARunThatDivergesEndAsAResult) {
  Scene scene = falling_strip(rated_fabric());
  scene.options.step_safety = 6;
  scene.options.bulk_viscosity = 0;
  const RunResult result = simulate(Model(scene), {.duration = 0.2});
  EXPECT_EQ(result.summary.status, RunStatus::diverged) << result.summary.message;
}

}  // namespace
}  // namespace drapeplan
