#include "mapping/geodesic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "mapping/error.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

// Point of the great circle from `start` in the direction that projects to `direction`, after the arc `s`.
Eigen::Vector3d great_circle(const Mold& mold, const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                             double s) {
  const SphereShape& shape = std::get<SphereShape>(mold.shape());
  const Eigen::Vector3d radial = (mold.point(start.x(), start.y()) - shape.centre) / shape.radius;
  const double rise = -(radial.head<2>().dot(direction)) / radial.z();
  const Eigen::Vector3d tangent = Eigen::Vector3d(direction.x(), direction.y(), rise).normalized();
  const double angle = s / shape.radius;
  return shape.centre + shape.radius * (std::cos(angle) * radial + std::sin(angle) * tangent);
}

TEST(Geodesic, ConvergesToAGreatCircleWithFourthOrder) {
  const Mold mold = sphere({0.1, 0.2, 0.3}, 0.5);
  const Eigen::Vector2d start(0.0, 0.15), direction(1, 0.4);
  double previous = 0;
  for (const int count : {10, 20, 40, 80}) {
    const Geodesic line = shoot_geodesic(mold, start, direction, 0.4 / count, count);
    ASSERT_EQ(line.points.size(), static_cast<size_t>(count) + 1);
    const double error = (line.points.back() - great_circle(mold, start, direction, 0.4)).norm();
    EXPECT_TRUE(error > 0);
    if (count > 10) {
      EXPECT_GE(std::log2(previous / error), 3.7) << count;
      EXPECT_LE(std::log2(previous / error), 4.4) << count;
    }
    previous = error;
  }
}

TEST(Geodesic, PointsLieOnTheMoldAtEqualArcs) {
  const Mold mold = sphere({0, 0, 0}, 0.5);
  const Geodesic line = shoot_geodesic(mold, {0.1, 0}, {0, 1}, 0.01, 30);
  for (size_t k = 0; k < line.points.size(); ++k) {
    const Eigen::Vector3d exact = great_circle(mold, {0.1, 0}, {0, 1}, 0.01 * static_cast<double>(k));
    EXPECT_LE((line.points[k] - exact).norm(), 1e-9);
    EXPECT_NEAR(line.points[k].norm(), 0.5, 1e-15);
  }
  EXPECT_NEAR(line.end_direction.norm(), 1, 1e-15);
  EXPECT_NEAR(line.end_direction.dot(line.points.back()), 0, 1e-15);
}

TEST(Geodesic, OnAPlaneItIsAStraightLine) {
  const Geodesic line = shoot_geodesic(inclined_plane(0.7), {0, 0}, {1, 2}, 0.1, 5);
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -std::tan(0.7)).normalized();
  for (size_t k = 0; k < line.points.size(); ++k) {
    EXPECT_LE((line.points[k] - 0.1 * static_cast<double>(k) * direction).norm(), 1e-15);
  }
}

TEST(Geodesic, OfNoStepsIsItsStart) {
  const Geodesic line = shoot_geodesic(article_mold(), {0.2, 0.2}, {1, 0}, 0.1, 0);
  ASSERT_EQ(line.points.size(), 1U);
  EXPECT_EQ(line.points[0].x(), 0.2);
}

TEST(Geodesic, BackwardsLeadsToTheStart) {
  const Mold mold = article_mold();
  const Geodesic there = shoot_geodesic(mold, {0.1, 0.3}, {1, -0.5}, 0.001, 300);
  const Eigen::Vector3d& end = there.points.back();
  const Geodesic back = shoot_geodesic(mold, end.head<2>(), -there.end_direction.head<2>(), 0.001, 300);
  EXPECT_LE((back.points.back() - there.points.front()).norm(), 1e-10);
}

TEST(Geodesic, DirectionOnASphereIsThatOfTheGreatCircle) {
  const Mold mold = sphere({0.1, 0.2, 0.3}, 0.5);
  const Eigen::Vector2d start(0.0, 0.15), direction = Eigen::Vector2d(1, -0.3).normalized();
  const Eigen::Vector3d goal = great_circle(mold, start, direction, 0.45);
  EXPECT_LE((geodesic_direction(mold, start, goal.head<2>()) - direction).norm(), 1e-10);
}

TEST(Geodesic, DirectionOnTheArticlesMoldLeadsThroughTheGoal) {
  const Mold mold = article_mold();
  const Eigen::Vector2d start(0.225, 0.225);
  for (const Eigen::Vector2d& goal :
       {Eigen::Vector2d(0.45, 0.225), Eigen::Vector2d(0.225, 0.45), Eigen::Vector2d(0, 0.225),
        Eigen::Vector2d(0, 0), Eigen::Vector2d(0.45, 0.45)}) {
    const Eigen::Vector3d target = mold.point(goal.x(), goal.y());
    const Geodesic line = shoot_geodesic(mold, start, geodesic_direction(mold, start, goal), 1e-4, 6000);
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t k = 1; k < line.points.size(); ++k) {
      const Eigen::Vector3d edge = (line.points[k] - line.points[k - 1]) / 1e-4;
      const Eigen::Vector3d offset = target - line.points[k];
      if (std::abs(offset.dot(edge)) <= 1e-4) nearest = std::min(nearest, offset.cross(edge).norm());
    }
    EXPECT_LE(nearest, 2e-8) << goal.transpose();  // the sag of a chord of 0.1 mm
  }
}

TEST(Geodesic, NamesThePlaceWhereTheMoldEnds) {
  const Mold mold = sphere({0, 0, 0}, 0.5);
  try {
    shoot_geodesic(mold, {0, 0}, {1, 0}, 0.01, 100);
    FAIL() << "no error";
  } catch (const NotFinished& error) {
    EXPECT_NE(std::string(error.what()).find("(0.49"), std::string::npos) << error.what();
  }
  EXPECT_THROW(geodesic_direction(mold, {0, 0}, {0.6, 0}), NotFinished);
  EXPECT_THROW(geodesic_direction(mold, {0.1, 0}, {0.1, 0}), NotFinished);
  EXPECT_THROW(shoot_geodesic(mold, {0.6, 0}, {1, 0}, 0.01, 1), NotFinished);
  EXPECT_THROW(shoot_geodesic(mold, {0, 0}, {0, 0}, 0.01, 1), std::invalid_argument);
  EXPECT_THROW(shoot_geodesic(mold, {0, 0}, {1, 0}, std::nan(""), 1), std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
