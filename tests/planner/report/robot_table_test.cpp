#include "planner/report/robot_table.hpp"

#include <gtest/gtest.h>

#include "planner/schedule/strategy.hpp"
#include "tests/planner/schedule/sequences.hpp"

namespace drapeplan {
namespace {

Case case_of(const RigOptions& rig) {
  Case definition;
  definition.grippers = rig;
  definition.score.lag_tolerance = 0.010;
  return definition;
}

Score score_of(double lag) {
  Score score;
  score.valid = true;
  score.max_lag = lag;
  score.max_actuator_force = 42;
  return score;
}

/// One gripper that falls from 100 mm to -2 mm in two seconds, at 51 mm/s.
Schedule one_stroke() {
  return {.paths = {{{0, 0.1}, {2, -0.002}}}, .blend_time = 0.1};
}

RigOptions one_gripper() {
  RigOptions rig;
  rig.columns = rig.rows = 1;
  return rig;
}

std::string cell(const ReportTable& table, const std::string& what, size_t column = 1) {
  for (const ReportTable::Row& row : table.rows) {
    if (row.cells[0] == what) return row.cells[column] + (row.failed ? " !" : "");
  }
  return "no such row";
}

TEST(RobotTable, HasRangeSpeedForceAndLagBesideTheirLimits) {
  const ReportTable table = robot_table("wave", one_stroke(), case_of(one_gripper()), score_of(0.0034));
  EXPECT_EQ(cell(table, "sequence"), "wave, 2.10 s");
  EXPECT_EQ(cell(table, "heights of the joints"), "-2.0 mm to 100.0 mm");
  EXPECT_EQ(cell(table, "largest speed"), "51 mm/s");
  EXPECT_EQ(cell(table, "largest speed", 2), "200 mm/s");
  EXPECT_EQ(cell(table, "largest force of an actuator, simulated"), "42.0 N");
  EXPECT_EQ(cell(table, "joints behind their commands, simulated"), "3.4 mm");
  EXPECT_EQ(cell(table, "suction"), "on to the end");
  EXPECT_EQ(cell(table, "trajectory for ROS 2"), "schedule_ros2.yaml");
}

TEST(RobotTable, WhatTheRigCannotFollowStandsOutWithItsReason) {
  RigOptions slow = one_gripper();
  slow.max_velocity = 0.04;
  const ReportTable table = robot_table("wave", one_stroke(), case_of(slow), score_of(0.012));
  EXPECT_EQ(cell(table, "joints behind their commands, simulated"), "12.0 mm !");
  const std::string reason = cell(table, "trajectory for ROS 2");
  EXPECT_NE(reason.find("none: moves at up to 0.051 m/s"), std::string::npos) << reason;
}

TEST(RobotTable, SaysWhenSuctionEnds) {
  Schedule schedule = one_stroke();
  schedule.release = {1.5};
  EXPECT_EQ(cell(robot_table("wave", schedule, case_of(one_gripper()), score_of(0)), "suction"),
            "ends at 1.50 s");
}

}  // namespace
}  // namespace drapeplan
