#include "fem/rig/schedule.hpp"

#include <gtest/gtest.h>

namespace drapeplan {
namespace {

Schedule ramp() {
  return {.paths = {{{0, 1.0}, {2, 0.5}, {3, 0.5}}}, .blend_time = 0.2};
}

TEST(Schedule, StartsAndEndsAtRest) {
  const Schedule schedule = ramp();
  EXPECT_DOUBLE_EQ(schedule.command(0, 0).z, 1.0);
  EXPECT_DOUBLE_EQ(schedule.command(0, 0).vz, 0.0);
  EXPECT_NEAR(schedule.command(0, 3.2).z, 0.5, 1e-15);
  EXPECT_NEAR(schedule.command(0, 3.2).vz, 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(schedule.duration(), 3.2);
}

TEST(Schedule, MovesAtConstantVelocityAfterTheBlend) {
  const Schedule schedule = ramp();
  EXPECT_NEAR(schedule.command(0, 1.0).vz, -0.25, 1e-14);
  EXPECT_NEAR(schedule.command(0, 1.0).z, 1 - 0.25 * (1.0 - 0.1), 1e-14);  // half a blend late
  EXPECT_DOUBLE_EQ(schedule.largest_velocity(), 0.25);
}

TEST(Schedule, MovesInPlaneOnAPathOfItsOwn) {
  Schedule schedule = ramp();
  EXPECT_EQ(schedule.command(0, 1).xy, Eigen::Vector2d(0, 0));
  schedule.plane_paths = {{{0, {0.1, 0.2}}, {1, {0.1, 0.2}}, {2, {0.4, -0.2}}, {5, {0.4, -0.2}}}};
  EXPECT_LE((schedule.command(0, 0.9).xy - Eigen::Vector2d(0.1, 0.2)).norm(), 1e-15);
  EXPECT_LE((schedule.command(0, 1.6).xy - Eigen::Vector2d(0.25, 0)).norm(), 1e-14);  // half a blend late
  EXPECT_LE((schedule.command(0, 1.6).v_plane - Eigen::Vector2d(0.3, -0.4)).norm(), 1e-14);
  EXPECT_DOUBLE_EQ(schedule.duration(), 5.2);
  EXPECT_NEAR(schedule.largest_velocity(), 0.5, 1e-15);
}

TEST(Schedule, ReleasesAtItsTimeOrNever) {
  Schedule schedule = ramp();
  EXPECT_FALSE(schedule.released(0, 1e9));
  schedule.release = {1.5};
  EXPECT_FALSE(schedule.released(0, 1.4999));
  EXPECT_TRUE(schedule.released(0, 1.5));
}

TEST(Schedule, CommandsAVelocityThatIsTheDerivativeOfItsHeight) {
  const Schedule schedule = ramp();
  for (double t = 0.01; t < 3.2; t += 0.0371) {
    const double slope = (schedule.command(0, t + 1e-6).z - schedule.command(0, t - 1e-6).z) / 2e-6;
    EXPECT_NEAR(schedule.command(0, t).vz, slope, 2e-6);
  }
}

TEST(Schedule, WithoutBlendsAPathIsItsPolygonHoweverManyKnotsItHas) {
  Schedule schedule;
  schedule.paths.emplace_back();
  for (int k = 0; k <= 5000; ++k) schedule.paths[0].push_back({0.001 * k, 1 - 0.01 * (k % 2)});
  EXPECT_EQ(schedule.command(0, -1).z, 1);
  EXPECT_EQ(schedule.command(0, 0).z, 1);
  EXPECT_EQ(schedule.command(0, schedule.paths[0][3001].time).z, schedule.paths[0][3001].z);
  EXPECT_NEAR(schedule.command(0, 3.0005).z, 0.995, 1e-12);
  EXPECT_NEAR(schedule.command(0, 3.0005).vz, -10, 1e-6);
  EXPECT_EQ(schedule.command(0, 5).z, 1);
  EXPECT_EQ(schedule.command(0, 6).z, 1);
  EXPECT_EQ(schedule.command(0, 6).vz, 0);
}

}  // namespace
}  // namespace drapeplan
