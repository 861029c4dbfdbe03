#include "mapping/surface/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

TEST(Spline, OneCellOfEqualCoefficientsIsThatHeightEverywhere) {
  const SplinePatches patches({{0.1, 0.2}, {0.5, 0.25}, Eigen::MatrixXd::Constant(4, 4, 0.7)});
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(0.3, 0.4), Eigen::Vector2d(-2, 5)}) {
    const Jet f = patches.jet(at.x(), at.y());
    EXPECT_NEAR(f.z, 0.7, 1e-12);
    EXPECT_NEAR(f.zx, 0, 1e-11);
    EXPECT_NEAR(f.zyyy, 0, 1e-11);
  }
}

TEST(Spline, CoefficientsOnAPlaneAreThatPlane) {
  SplineShape shape{{-0.1, 0.3}, {0.02, 0.03}, Eigen::MatrixXd(9, 7)};
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 7; ++j) shape.coefficients(i, j) = 2 * (i - 1) * 0.02 - 3 * (j - 1) * 0.03;
  }
  const Jet f = SplinePatches(shape).jet(-0.1 + 0.057, 0.3 + 0.081);
  EXPECT_NEAR(f.z, 2 * 0.057 - 3 * 0.081, 1e-14);
  EXPECT_NEAR(f.zx, 2, 1e-12);
  EXPECT_NEAR(f.zy, -3, 1e-12);
  EXPECT_NEAR(f.zxx, 0, 1e-9);
}

TEST(Spline, CurvatureDoesNotJumpBetweenCells) {
  const Mold mold = spline_mold();
  const auto& shape = std::get<SplineShape>(mold.shape());
  const double x = shape.origin.x() + 5 * shape.spacing.x(), y = shape.origin.y() + 7 * shape.spacing.y();
  constexpr double kBeside = 1e-12;
  const Jet before = mold.jet(x - kBeside, y - kBeside), after = mold.jet(x + kBeside, y + kBeside);
  EXPECT_NEAR(before.z, after.z, 1e-11);
  EXPECT_NEAR(before.zx, after.zx, 1e-10);
  EXPECT_NEAR(before.zxx, after.zxx, 1e-9);
  EXPECT_NEAR(before.zxy, after.zxy, 1e-9);
  EXPECT_NEAR(before.zyy, after.zyy, 1e-9);
  EXPECT_GT(std::abs(before.zxxx - after.zxxx) + std::abs(before.zyyy - after.zyyy), 1e-6);
}

TEST(Spline, BatchesOfAnyLengthAndPlacesBesideTheGridEqualTheJets) {
  const Mold mold = spline_mold();
  for (const int n : {1, 2, 3, 5, 63, 65, 130}) {
    std::vector<double> x, y, z(size_t(n) + 1, 7.0), zx(z), zy(z);
    for (int p = 0; p < n; ++p) x.push_back(-0.3 + 0.01 * p), y.push_back(0.7 - 0.007 * p);
    mold.heights(n, x.data(), y.data(), z.data(), zx.data(), zy.data());
    for (size_t p = 0; p < size_t(n); ++p) {
      const Jet f = mold.jet(x[p], y[p]);
      EXPECT_NEAR(z[p], f.z, 1e-12);
      EXPECT_NEAR(zx[p], f.zx, 1e-11);
      EXPECT_NEAR(zy[p], f.zy, 1e-11);
    }
    EXPECT_EQ(z.back(), 7.0);  // nothing behind the results is written
  }
}

TEST(Spline, APlaceThatIsNotANumberHasNoHeight) {
  const Mold mold = spline_mold();
  const double x = std::numeric_limits<double>::quiet_NaN(), y = 0.1;
  double z = 0, zx = 0, zy = 0;
  mold.heights(1, &x, &y, &z, &zx, &zy);
  EXPECT_TRUE(std::isnan(z) && std::isnan(zx));
  EXPECT_TRUE(std::isnan(mold.jet(y, x).z));
}

}  // namespace
}  // namespace drapeplan
