#include "mapping/mold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

constexpr double kPi = std::numbers::pi;

struct Scene {
  const char* name;
  Mold mold;
};

std::vector<Scene> all_shapes() {
  return {{"plane", inclined_plane(0.4)},
          {"article", article_mold()},
          {"quintic",
           Mold(PolynomialShape{{{5, 0, 3.0}, {2, 3, -7.0}, {0, 1, 0.3}, {1, 4, 2.0}}}, {{0, 0}, {1, 1}})},
          {"degree 9", Mold(PolynomialShape{{{6, 3, 5.0}, {0, 7, -2.0}, {4, 0, 0.3}}}, {{0, 0}, {1, 1}})},
          {"sphere", sphere({0.1, 0.3, -0.2}, 0.7)},
          {"cylinder", cylinder({0.2, 0.1, 0.05}, 0.6, 0.8)},
          {"spline", spline_mold()}};
}

double central(const Mold& mold, double Jet::*of, double x, double y, bool along_x) {
  constexpr double kStep = 1e-5;
  const double dx = along_x ? kStep : 0, dy = along_x ? 0 : kStep;
  return (mold.jet(x + dx, y + dy).*of - mold.jet(x - dx, y - dy).*of) / (2 * kStep);
}

TEST(Mold, EveryDerivativeMatchesCentralDifferences) {
  struct Pair {
    double Jet::*lower;
    double Jet::*higher;
    bool along_x;
  };
  const Pair pairs[] = {
      {&Jet::z, &Jet::zx, true},      {&Jet::z, &Jet::zy, false},     {&Jet::zx, &Jet::zxx, true},
      {&Jet::zx, &Jet::zxy, false},   {&Jet::zy, &Jet::zxy, true},    {&Jet::zy, &Jet::zyy, false},
      {&Jet::zxx, &Jet::zxxx, true},  {&Jet::zxx, &Jet::zxxy, false}, {&Jet::zxy, &Jet::zxxy, true},
      {&Jet::zxy, &Jet::zxyy, false}, {&Jet::zyy, &Jet::zxyy, true},  {&Jet::zyy, &Jet::zyyy, false}};
  for (const Scene& scene : all_shapes()) {
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.13, 0.29), Eigen::Vector2d(0.4, 0.05)}) {
      const Jet f = scene.mold.jet(at.x(), at.y());
      for (const Pair& pair : pairs) {
        const double error =
            std::abs(central(scene.mold, pair.lower, at.x(), at.y(), pair.along_x) - f.*pair.higher);
        EXPECT_LE(error, 1e-7 * (1 + std::abs(f.*pair.higher))) << scene.name;
      }
    }
  }
}

TEST(Mold, BatchHeightsEqualTheJets) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 0.5);
  for (const int n : {0, 1, 7, 64, 200}) {
    std::vector<double> x(n), y(n), z(n), zx(n), zy(n);
    for (int p = 0; p < n; ++p) x[p] = unit(random), y[p] = unit(random);
    for (const Scene& scene : all_shapes()) {
      scene.mold.heights(n, x.data(), y.data(), z.data(), zx.data(), zy.data());
      for (int p = 0; p < n; ++p) {
        const Jet f = scene.mold.jet(x[p], y[p]);
        EXPECT_LE(std::abs(z[p] - f.z), 1e-14) << scene.name;
        EXPECT_LE(std::abs(zx[p] - f.zx), 1e-13) << scene.name;
        EXPECT_LE(std::abs(zy[p] - f.zy), 1e-13) << scene.name;
      }
    }
  }
}

TEST(Mold, HeightsOfTheArticlesMoldFollowItsEquation) {
  const Mold mold = article_mold();
  const double x = 0.31, y = 0.12;
  const double z = 1.004 * x + 1.089 * y - 3.667 * x * x - 4.4 * x * y - 3.75 * y * y + 3.086 * x * x * x +
                   8.889 * x * x * y + 4.321 * y * y * y;
  EXPECT_NEAR(mold.height(x, y), z, 1e-15);
}

TEST(Mold, GaussianCurvatureOfTheArticlesMoldMatchesItsFigure) {
  const CurvatureRange range = gaussian_curvature_range(article_mold());
  EXPECT_NEAR(range.smallest, -25.46, 0.01);
  EXPECT_NEAR(range.largest, 23.41, 0.01);
}

TEST(Mold, NormalCurvatureOfASphereIsOneOverRadius) {
  const Mold mold = sphere({0, 0, 0}, 0.5);
  for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1, 0), Eigen::Vector2d(-0.3, 2)}) {
    EXPECT_NEAR(mold.normal_curvature(0.2, -0.3, direction), -2, 1e-12);  // a dome is not hollow
  }
  EXPECT_NEAR(mold.gaussian_curvature(0.2, -0.3), 4, 1e-12);
}

TEST(Mold, ACylinderIsFlatAlongItsAxis) {
  const Mold mold = cylinder({0, 0, 0}, 0.3, 0.5);
  EXPECT_NEAR(mold.normal_curvature(0.1, 0.2, {std::cos(0.3), std::sin(0.3)}), 0, 1e-13);
  EXPECT_NEAR(mold.normal_curvature(0.1, 0.2, {-std::sin(0.3), std::cos(0.3)}), -2, 1e-12);
  EXPECT_NEAR(mold.gaussian_curvature(0.1, 0.2), 0, 1e-12);
}

TEST(Mold, APlaneFallsTowardsPositiveX) {
  const Mold mold = inclined_plane(kPi / 6);
  EXPECT_NEAR(mold.height(1, 5), -1 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR((mold.normal(0, 0) - Eigen::Vector3d(0.5, 0, std::sqrt(0.75))).norm(), 0, 1e-15);
}

TEST(Mold, ClosestPointUndoesAnOffsetAlongTheNormal) {
  for (const Scene& scene : all_shapes()) {
    for (const double distance : {-0.02, 0.0, 1e-4, 0.03}) {
      for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.1, 0.25), Eigen::Vector2d(0.4, 0.42)}) {
        const Eigen::Vector3d foot = scene.mold.point(at.x(), at.y());
        const Eigen::Vector3d normal = scene.mold.normal(at.x(), at.y());
        const ClosestPoint found = scene.mold.closest(foot + distance * normal);
        EXPECT_TRUE(found.converged) << scene.name;
        EXPECT_LE((found.foot - foot).norm(), 5e-13) << scene.name << ' ' << distance;
        EXPECT_NEAR(found.signed_distance, distance, 5e-13) << scene.name;
        EXPECT_LE((found.normal - normal).norm(), 1e-11) << scene.name;
      }
    }
  }
}

TEST(Mold, ClosestPointOfAFarPointIsNearerThanAnySample) {
  const Mold mold = article_mold();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> plan(0.0, 0.45), rise(0.0, 0.3);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d p(plan(random), plan(random), rise(random));
    const ClosestPoint found = mold.closest(p);
    ASSERT_TRUE(found.converged) << p.transpose();
    double nearest = std::numeric_limits<double>::infinity();
    for (double x = -0.3; x < 0.75; x += 0.005) {
      for (double y = -0.3; y < 0.75; y += 0.005) {
        nearest = std::min(nearest, (mold.point(x, y) - p).norm());
      }
    }
    EXPECT_LE(std::abs(found.signed_distance), nearest) << p.transpose();
  }
}

TEST(Mold, ClosestPointWorksBesideTheDomainOfASphere) {
  const ClosestPoint found = sphere({0, 0, 0}, 0.5).closest({0.8, 0, 0.6});
  EXPECT_TRUE(found.converged);
  EXPECT_LE((found.foot - Eigen::Vector3d(0.4, 0, 0.3)).norm(), 1e-12);
  EXPECT_NEAR(found.signed_distance, 0.5, 1e-12);
}

TEST(Mold, ClosestPointSaysWhenThereIsNone) {
  EXPECT_FALSE(sphere({0, 0, 0}, 0.5).closest({0.8, 0, -0.6}).converged);
  EXPECT_FALSE(article_mold().closest({std::nan(""), 0, 0}).converged);
}

TEST(Mold, HeightsBeyondTheEquatorAreNotNumbers) {
  EXPECT_TRUE(std::isnan(sphere({0, 0, 0}, 0.5).height(0.5, 0.1)));
  EXPECT_TRUE(std::isnan(cylinder({0, 0, 0}, 0, 0.5).height(3, 0.5)));
  const double x = 0.4, y = 0.4;
  double z = 0, zx = 0, zy = 0;
  sphere({0, 0, 0}, 0.5).heights(1, &x, &y, &z, &zx, &zy);
  EXPECT_TRUE(std::isnan(z) && std::isnan(zx) && std::isnan(zy));
}

TEST(Mold, RefusesWhatIsNoMold) {
  const Extent unit{{0, 0}, {1, 1}};
  EXPECT_THROW(Mold(PlaneShape{}, {{0, 0}, {0, 1}}), std::invalid_argument);
  EXPECT_THROW(Mold(PlaneShape{}, {{0, 0}, {std::nan(""), 1}}), std::invalid_argument);
  EXPECT_THROW(Mold(PlaneShape{kPi / 2}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(SphereShape{{0, 0, 0}, 0}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(CylinderShape{{0, 0, 0}, 0, std::nan("")}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(PolynomialShape{{{-1, 0, 1.0}}}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(PolynomialShape{{{1, 0, std::nan("")}}}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(SplineShape{}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(SplineShape{{0, 0}, {1, 0}, Eigen::MatrixXd::Zero(4, 4)}, unit), std::invalid_argument);
  EXPECT_THROW(Mold(SplineShape{{0, 0}, {1, 1}, Eigen::MatrixXd::Constant(4, 4, std::nan(""))}, unit),
               std::invalid_argument);
  EXPECT_EQ(Mold(PolynomialShape{}, unit).height(0.3, 0.4), 0);
}

}  // namespace
}  // namespace drapeplan
