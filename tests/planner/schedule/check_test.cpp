#include "planner/schedule/check.hpp"

#include <gtest/gtest.h>

#include "tests/planner/schedule/sequences.hpp"

namespace drapeplan {
namespace {

/// Two grippers on a rigid bar of 100 mm, at rest 0.3 m up.
struct Pair {
  RigOptions rig;
  Schedule schedule;
  Pair() {
    rig.columns = 2;
    rig.rows = 1;
    rig.spacing = 0.1;
    schedule.blend_time = 0.1;
    schedule.paths = {{{0, 0.3}, {10, 0.3}}, {{0, 0.3}, {10, 0.3}}};
  }
  [[nodiscard]] std::string refusals() const {
    std::string text;
    for (const std::string& one : rig_refusals(schedule, rig)) text += one + "\n";
    return text;
  }
};

TEST(RigRefusals, AreNoneForWhatTheRigCanDo) {
  Pair pair;
  EXPECT_EQ(pair.refusals(), "");
  pair.schedule.paths[0] = {{0, 0.3}, {10, 0.201}};
  EXPECT_EQ(pair.refusals(), "");
}

TEST(RigRefusals, NameAnInterlinkThatWouldHaveToBeLonger) {
  Pair pair;
  pair.schedule.paths[0] = {{0, 0.3}, {5, 0.19}, {10, 0.3}};
  EXPECT_EQ(
      pair.refusals(),
      "grippers [1, 1] and [2, 1] are to be 109.4 mm apart in height at 5.05 s: their interlink is 100.0 "
      "mm long\n");
  pair.rig.interlinks->play = {0, 0.010};
  EXPECT_EQ(pair.refusals(), "") << "it is telescopic";
  pair.rig.interlinks->play = {0, 0};
  pair.rig.interlinks->stiffness = 1e3;
  EXPECT_EQ(pair.refusals(), "") << "it gives way";
  pair.rig.interlinks.reset();
  EXPECT_EQ(pair.refusals(), "");
}

TEST(RigRefusals, NameVelocityAccelerationAndTheForceForIt) {
  Pair pair;
  pair.schedule.paths[1] = {{0, 0.3}, {1, 0.25}, {10, 0.25}};
  pair.rig.max_velocity = 0.04;
  EXPECT_EQ(pair.refusals(), "moves at up to 0.05 m/s, more than grippers.max_velocity (0.04 m/s)\n");
  pair.rig.max_velocity = 0.2;
  pair.rig.max_acceleration = 0.4;
  EXPECT_EQ(pair.refusals(),
            "gripper [2, 1] accelerates by 0.5 m/s^2, more than grippers.max_acceleration (0.4 m/s^2)\n");
  pair.rig.max_acceleration.reset();
  pair.rig.pad_mass = 150;
  EXPECT_EQ(pair.refusals(),
            "gripper [2, 1] needs 75 N to change its velocity within the blend time of 0.1 s, more than "
            "grippers.actuator_force_limit (50 N)\n");
}

TEST(RigRefusals, AddUpChangesOfVelocityWithinOneBlend) {
  Pair pair;
  pair.schedule.paths[1] = {{0, 0.3}, {1, 0.31}, {1.05, 0.31}, {2, 0.3}};  // 10 mm/s up, then down
  pair.rig.max_acceleration = 0.15;
  EXPECT_NE(pair.refusals().find("accelerates by 0.205"), std::string::npos) << pair.refusals();
}

TEST(RigRefusals, LookAtWaysInThePlane) {
  Pair pair;
  pair.rig.driven = Driven::xyz;
  pair.rig.interlinks.reset();
  pair.rig.max_acceleration = 0.4;
  pair.rig.pad_mass = 110;  // 33 and 44 N along the axes, 55 N together: each actuator has 50
  pair.schedule.plane_paths = {{{0, {0, 0}}, {1, {0.03, 0.04}}}, {{0, {0.1, 0}}}};
  EXPECT_EQ(pair.refusals(),
            "gripper [1, 1] accelerates by 0.5 m/s^2, more than grippers.max_acceleration (0.4 m/s^2)\n");
}

}  // namespace
}  // namespace drapeplan
