#include "mapping/surface/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace drapeplan {
namespace {

const Extent kBox{{-0.2, 0.1}, {0.3, 0.4}};

std::vector<FitPoint> scattered(const std::function<double(double, double)>& height, int n) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<FitPoint> points;
  for (int k = 0; k < n; ++k) {
    const Eigen::Array2d share(unit(random), unit(random));
    const Eigen::Vector2d at = kBox.lower.array() + share * (kBox.upper - kBox.lower).array();
    points.push_back({{at.x(), at.y(), height(at.x(), at.y())}, 0.15 / n});
  }
  return points;
}

TEST(Fit, AQuadraticIsMetExactlyHoweverSmoothAndGoesOnBesideTheExtent) {
  const auto quadratic = [](double x, double y) { return 0.3 - x + 2 * y + 3 * x * x - 4 * x * y + y * y; };
  const SplinePatches patches(fit_spline(scattered(quadratic, 300), kBox, {10, 6}, 0.05));
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(0, 0.2), Eigen::Vector2d(0.3, 0.4), Eigen::Vector2d(0.38, 0.45)}) {
    const Jet f = patches.jet(at.x(), at.y());
    EXPECT_NEAR(f.z, quadratic(at.x(), at.y()), 1e-9);
    EXPECT_NEAR(f.zxx, 6, 1e-5);
    EXPECT_NEAR(f.zxy, -4, 1e-5);
  }
}

TEST(Fit, HeightsOfASmoothSurfaceConvergeWithTheFourthPowerOfTheCell) {
  const auto waves = [](double x, double y) { return 0.02 * std::sin(9 * x + 0.3) * std::cos(11 * y); };
  const std::vector<FitPoint> points = scattered(waves, 20000);
  double before = 0;
  for (const int cells : {6, 12, 24}) {
    const SplinePatches patches(fit_spline(points, kBox, {cells, cells}, 0.02 / cells));
    double squares = 0;
    for (int k = 0; k < 400; ++k) {
      const double x = -0.15 + 0.02 * (k % 20), y = 0.13 + 0.012 * (k / 20);
      const double error = patches.jet(x, y).z - waves(x, y);
      squares += error * error;
    }
    const double error = std::sqrt(squares / 400);
    if (before > 0) {
      EXPECT_GT(std::log2(before / error), 3.6);
      EXPECT_LT(std::log2(before / error), 4.8);
    }
    before = error;
  }
}

TEST(Fit, AWaveOfTwoPiSmoothingKeepsHalfItsHeight) {
  constexpr double kLength = 0.008;
  const auto wave = [](double x, double) { return 1e-3 * std::cos(x / kLength); };
  const SplinePatches patches(fit_spline(scattered(wave, 40000), kBox, {80, 12}, kLength));
  const double crest = 2 * std::numbers::pi * kLength;
  EXPECT_NEAR(patches.jet(crest, 0.25).z, 0.5e-3, 0.05e-3);
}

}  // namespace
}  // namespace drapeplan
