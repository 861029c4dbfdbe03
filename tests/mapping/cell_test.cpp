#include "mapping/cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

double energy(const Cell& cell, const Eigen::Vector3d& p) {
  const double a = (p - cell.second).norm() / cell.first_length - 1;
  const double b = (p - cell.first).norm() / cell.second_length - 1;
  return (a * a + b * b) / 4;
}

TEST(Cell, OnAPlaneTheFreeCornerClosesTheParallelogram) {
  const Mold mold = inclined_plane(0.5);
  const Eigen::Vector3d base = mold.point(0, 0), first = mold.point(0.1, 0.02),
                        second = mold.point(-0.01, 0.07);
  const Cell cell{base, first, second, (first - base).norm(), (second - base).norm()};
  const FreeCorner corner = place_free_corner(mold, cell);
  EXPECT_TRUE(corner.converged);
  EXPECT_LE((corner.point - (first + second - base)).norm(), 1e-16);
}

TEST(Cell, EdgesKeepTheirLengthWhereTheyCan) {
  const Mold mold = article_mold();
  const Eigen::Vector3d base = mold.point(0.2, 0.1), first = mold.point(0.24, 0.1),
                        second = mold.point(0.2, 0.13);
  const Cell cell{base, first, second, (first - base).norm(), (second - base).norm()};
  const FreeCorner corner = place_free_corner(mold, cell);
  EXPECT_TRUE(corner.converged);
  EXPECT_NEAR((corner.point - second).norm(), cell.first_length, 1e-15);
  EXPECT_NEAR((corner.point - first).norm(), cell.second_length, 1e-15);
  EXPECT_EQ(corner.point.z(), mold.height(corner.point.x(), corner.point.y()));
}

TEST(Cell, WhereEdgesCannotMeetTheEnergyIsSmallest) {
  const Mold mold = article_mold();
  const Eigen::Vector3d base = mold.point(0.2, 0.1), first = mold.point(0.24, 0.1),
                        second = mold.point(0.2, 0.13);
  const Cell cell{base, first, second, 0.02, 0.02};  // 40 mm together do not span the 50 mm of the diagonal
  const FreeCorner corner = place_free_corner(mold, cell);
  ASSERT_TRUE(corner.converged);
  const double smallest = energy(cell, corner.point);
  EXPECT_GT(smallest, 1e-3);
  for (const double radius : {1e-6, 1e-4, 1e-3, 5e-3}) {
    for (int k = 0; k < 24; ++k) {
      const double angle = 2 * std::numbers::pi * k / 24;
      const Eigen::Vector3d beside = mold.point(corner.point.x() + radius * std::cos(angle),
                                                corner.point.y() + radius * std::sin(angle));
      EXPECT_GT(energy(cell, beside), smallest) << radius << ' ' << k;
    }
  }
}

TEST(Cell, BeyondTheMoldThereIsNoCorner) {
  const Mold mold = sphere({0, 0, 0}, 0.5);
  const Eigen::Vector3d base = mold.point(0.34, 0.34), first = mold.point(0.36, 0.34),
                        second = mold.point(0.34, 0.36);
  EXPECT_FALSE(place_free_corner(mold, {base, first, second, 0.3, 0.3}).converged);
}

}  // namespace
}  // namespace drapeplan
