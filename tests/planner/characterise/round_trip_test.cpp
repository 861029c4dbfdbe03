// From a known material to spoilt data and back.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/case/file.hpp"
#include "planner/characterise/characterise.hpp"
#include "tests/planner/characterise/synthetic.hpp"

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The material of the shipped cases, or a stiffer one with other rates and no plateau.
MaterialFields truth(bool shipped) {
  const Case definition = read_case(DRAPEPLAN_SOURCE_DIR "/cases/flexdraper-quick.json").definition;
  MaterialFields material = *fields_of(definition).material;
  if (shipped) return material;
  material.name = "Another fabric";
  material.tension.curve = {{0, 0.001, 0.002, 0.004, 0.006}, {0, 8e6, 18e6, 40e6, 64e6}};
  const Curve shear{{0, 3 * kDegree, 10 * kDegree, 25 * kDegree, 40 * kDegree, 50 * kDegree},
                    {0, 2e4, 4e4, 9e4, 3e5, 9e5}};
  // Less rate-dependent in compression; other curves than a master one cannot be found.
  material.compression = {};
  material.compression.curve = master_compression(material.tension.curve);
  material.compression.factor = 0.05;
  material.compression.rates = {{1e-15, 1, {}, {}}, {1e-4, 1.15, {}, {}}, {3e-4, 1.3, {}, {}}, {1e-3, 1.6, {}, {}}};
  material.shear = {};
  material.shear.curve = shear;
  material.shear.rates = {{4.44e-4, 1, {}, {}}, {2.22e-3, 1.25, {}, {}}, {2.22e-2, 1.6, {}, {}}};
  return material;
}

/// Largest error allowed at the end of a verification.
double allowed(const Verification& v) {
  return v.what == Compared::force ? 0.1 : 0.04;
}

void check_verifications(const Characterisation& found) {
  ASSERT_EQ(found.verifications.size(), 7U);  // tension, three rates of bias extension, three cantilevers
  for (const Verification& v : found.verifications) {
    EXPECT_EQ(v.failure, "");
    EXPECT_FALSE(v.simulated.empty());
    EXPECT_LT(v.end_error, allowed(v)) << v.name;
    EXPECT_LT(v.error, v.what == Compared::force ? 0.1 : 0.08) << v.name;  // of a strip: on its way down
  }
}

class RoundTrip : public testing::TestWithParam<std::pair<bool, unsigned>> {};

TEST_P(RoundTrip, FindsTheTruth) {
  const auto [shipped, seed] = GetParam();
  const MaterialFields material = truth(shipped);
  const Fabric fabric = fabric_of(material);
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) /
                                       ("round_trip_" + std::to_string(seed) + (shipped ? "_shipped" : "_other"));
  test::write_synthetic_tests(folder, material, {.seed = seed});
  const TestsReading reading = read_tests(folder / "tests.json");
  for (const InputError& error : reading.errors) ADD_FAILURE() << error.text();
  ASSERT_TRUE(reading.errors.empty());
  const Characterisation found = characterise(reading.tests, 2);
  ASSERT_TRUE(found.tension && found.bias);
  const Curve& tension = fabric.tension.slowest();
  const double largest = tension(found.tension->valid_to);
  for (double share = 0.05; share <= 1; share += 0.05) {
    const double strain = share * found.tension->valid_to;
    EXPECT_NEAR(found.tension->curve(strain), tension(strain), 0.01 * largest) << strain;
  }
  const Fabric again = fabric_of(found.material);
  for (const double rate : fabric.shear.rates) {
    for (double angle = 2; angle <= 35; angle += 1) {
      const double expected = fabric.shear(angle * kDegree, rate, fabric.rate_floor);
      EXPECT_NEAR(again.shear(angle * kDegree, rate, again.rate_floor), expected, 0.03 * expected)
          << angle << " deg, " << rate << " 1/s";
    }
  }
  ASSERT_TRUE(found.compression);
  constexpr double kStrain = 0.003;
  const auto miss = [&](double rate) {
    return again.compression(kStrain, rate, again.rate_floor) /
               fabric.compression(kStrain, rate, fabric.rate_floor) -
           1;
  };
  EXPECT_NEAR(miss(0), 0, 0.02);
  for (const double rate : {1e-4, 2e-4, 4e-4}) EXPECT_NEAR(miss(rate), 0, 0.03) << rate << " 1/s";
  check_verifications(found);
}

INSTANTIATE_TEST_SUITE_P(All, RoundTrip,
                         testing::Values(std::pair(true, 1U), std::pair(true, 2U), std::pair(true, 3U),
                                         std::pair(false, 1U), std::pair(false, 2U), std::pair(false, 3U)));

}  // namespace
}  // namespace drapeplan
