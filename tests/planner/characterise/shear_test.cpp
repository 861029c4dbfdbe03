#include "planner/characterise/shear.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TestTable table_of(const std::vector<double>& way, const std::vector<double>& force) {
  TestTable table;
  table.columns[TestQuantity::displacement] = way;
  table.columns[TestQuantity::force] = force;
  for (size_t k = 0; k < way.size(); ++k) table.lines.push_back(int(k) + 2);
  return table;
}

TEST(BiasExtension, HasTheAnglesAndRatesOfItsKinematics) {
  // H = 270 mm, W = 120 mm: L0 = 150 mm.
  const double degrees[] = {7.919, 16.526, 26.104, 37.189};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(bias_angle(0.01 * (k + 1), 0.15) / kDegree, degrees[k], 5e-4);
  EXPECT_NEAR(bias_rate(0, 0.15, 0.01 / 60), 2.222e-3, 1e-6);
  const double step = 1e-6, angle = bias_angle(0.03, 0.15);
  EXPECT_NEAR(bias_rate(angle, 0.15, 1), (bias_angle(0.03 + step, 0.15) - angle) / step, 1e-3);
}

/// Forces of a linear law without rates, by the balance of power.
StripTest linear_bias_test(double modulus, double thickness) {
  StripTest test{"linear", 0.12, 0.27, 1e-4, {}, {}};
  std::vector<double> way, force;
  for (int k = 0; k <= 400; ++k) {
    way.push_back(1e-4 * k);
    const double g = bias_angle(way.back(), 0.15), c = thickness * modulus;
    force.push_back(((2 * 0.27 - 3 * 0.12) * c * g + 0.12 * c * g / 2) /
                    ((0.27 / 0.12 - 1) * (std::cos(g / 2) - std::sin(g / 2))));
  }
  test.table = table_of(way, force);
  return test;
}

TEST(BiasExtension, FindsALinearLawFromItsFirstPieceOn) {
  const ShearLaw law = bias_extension_law({linear_bias_test(1e5, 3e-4)}, {.thickness = 3e-4});
  ASSERT_EQ(law.table.curves.size(), 1U);
  for (double degrees = 0.5; degrees < 37; degrees += 0.5)
    EXPECT_NEAR(law.table.slowest()(degrees * kDegree), 1e5 * degrees * kDegree, 0.004 * 1e5 * degrees * kDegree);
  EXPECT_NEAR(law.valid_to, 30 * kDegree, 1e-9);
  EXPECT_NEAR(law.measured_to / kDegree, 37, 0.5);
  // The article's measure is the conjugate one over the cosine.
  const ShearLaw force = bias_extension_law({linear_bias_test(1e5, 3e-4)},
                                            {.thickness = 3e-4, .measure = ShearMeasure::force});
  EXPECT_NEAR(force.table.slowest()(30 * kDegree), law.table.slowest()(30 * kDegree) / std::cos(30 * kDegree),
              6e-3 * force.table.slowest()(30 * kDegree));
}

TEST(BiasExtension, KeepsACurveThatFallsBesideTheOneThatDoesNot) {
  StripTest test = linear_bias_test(1e5, 3e-4);
  std::vector<double>& force = test.table.columns[TestQuantity::force];
  for (size_t k = 0; k < force.size(); ++k) force[k] *= 1 - 0.5 * std::exp(-std::pow((double(k) - 200) / 40, 2));
  const ShearLaw law = bias_extension_law({test}, {.thickness = 3e-4});
  const Curve &measured = law.measured.front(), &corrected = law.table.slowest();
  EXPECT_GT(measured(10 * kDegree), measured(15 * kDegree));
  for (double degrees = 1; degrees < 36; degrees += 1)
    EXPECT_GE(corrected(degrees * kDegree), corrected((degrees - 1) * kDegree));
}

TEST(PictureFrame, FindsALinearLaw) {
  FrameTest test;
  test.side = 0.2;
  test.specimen = 0.15;
  test.rate = 1e-4;
  std::vector<double> way, force;
  for (int k = 0; k <= 200; ++k) {
    const double g = k * 45 * kDegree / 200, half = std::numbers::pi / 4 - g / 2;
    way.push_back(2 * 0.2 * std::cos(half) - std::numbers::sqrt2 * 0.2);
    force.push_back(3e-4 * 1e5 * g * 0.15 * 0.15 / (0.2 * std::sin(half)));
  }
  test.table = table_of(way, force);
  const ShearLaw law = picture_frame_law({test}, {.thickness = 3e-4});
  for (double degrees = 1; degrees < 44; degrees += 1)
    EXPECT_NEAR(law.table.slowest()(degrees * kDegree), 1e5 * degrees * kDegree, 0.005 * 1e5 * degrees * kDegree);
  EXPECT_NEAR(law.valid_to / kDegree, 35, 1e-6);
}

TEST(BiasExtension, RefusesStripsOfDifferentSizes) {
  StripTest other = linear_bias_test(1e5, 3e-4);
  other.width = 0.1;
  EXPECT_THROW(bias_extension_law({linear_bias_test(1e5, 3e-4), other}, {.thickness = 3e-4}), WrongInput);
}

}  // namespace
}  // namespace drapeplan
