#include "planner/views/profile.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Mold kPlane(PlaneShape{0.3}, {{-1, -1}, {1, 1}});
constexpr double kThickness = 0.0003;

/// The ply turned by a right angle about z and moved to (0.1, 0.2), at height z(x, y).
template <class Height>
Snapshot turned(const Mesh& mesh, const Height& height) {
  Snapshot ply;
  for (const Vector2d& rest : mesh.rest) {
    const Vector2d at(0.1 - rest.y(), 0.2 + rest.x());
    ply.position.emplace_back(at.x(), at.y(), height(at));
  }
  return ply;
}

TEST(Profile, OfALevelPlyOverAnInclineIsExact) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.013);
  const Snapshot ply = turned(mesh, [](const Vector2d&) { return 0.07; });
  // Along x, from the outside: the ply reaches from x = 0.05 to 0.15.
  const Profile line{.name = "x", .from = {0.0, 0.25}, .to = {0.2, 0.25}};
  const std::vector<ProfilePoint> profile = profile_of(line, mesh, ply, &kPlane, kThickness);
  ASSERT_EQ(profile.size(), size_t(kProfilePoints - 1) / 2 + 1);
  EXPECT_LE(std::abs(profile.front().along - 0.05), 1e-9);
  EXPECT_LE(std::abs(profile.back().along - 0.15), 1e-9);
  for (const ProfilePoint& point : profile) {
    EXPECT_LE((point.place - Vector3d(point.along, 0.25, 0.07)).norm(), 1e-9);
    EXPECT_LE(std::abs(point.mold + std::tan(0.3) * point.along), 1e-12);
    EXPECT_LE(std::abs(point.gap - ((0.07 - point.mold) * std::cos(0.3) - 0.5 * kThickness)), 1e-9);
  }
}

TEST(Profile, OfALineOfThePlyGoesWithThePly) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.013);
  const Snapshot ply = turned(mesh, [](const Vector2d& at) { return at.x() + 2 * at.y(); });
  const Profile line{.name = "warp", .frame = Profile::Frame::ply, .from = {-0.1, 0.03}, .to = {0.1, 0.03}};
  const std::vector<ProfilePoint> profile = profile_of(line, mesh, ply, nullptr, kThickness);
  ASSERT_EQ(profile.size(), size_t(kProfilePoints));
  EXPECT_LE((profile.front().place - Vector3d(0.07, 0.1, 0.27)).norm(), 1e-9);
  EXPECT_LE((profile.back().place - Vector3d(0.07, 0.3, 0.67)).norm(), 1e-9);
  EXPECT_TRUE(std::isnan(profile.back().gap));
}

TEST(Profile, OfAFoldTakesTheHighestLayer) {
  const Mesh mesh = rectangle_mesh(0.2, 0.1, 0.01);
  Snapshot ply;  // the right half lies 5 mm above the left one
  for (const Vector2d& rest : mesh.rest)
    ply.position.emplace_back(-std::abs(rest.x()), rest.y(), rest.x() > 0 ? 0.005 : 0.0);
  const Profile line{.name = "x", .from = {-0.09, 0.0}, .to = {-0.02, 0.0}};
  for (const ProfilePoint& point : profile_of(line, mesh, ply, nullptr, kThickness))
    EXPECT_LE(std::abs(point.place.z() - 0.005), 1e-12);
}

}  // namespace
}  // namespace drapeplan
