// How a mapping lays the ply down, against ply.position and ply.angle; and that a user is told.
#include "planner/drape/map_result.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

Case shipped(const std::string& name, const std::vector<std::string>& overrides = {}) {
  CaseReading reading = read_case(DRAPEPLAN_SOURCE_DIR "/cases/" + name + ".json", overrides);
  EXPECT_TRUE(reading.errors.empty());
  return std::move(reading.definition);
}

// On a plane the map is rigid, so that the placement is known exactly. No grippers: corners are compared.
Case flat(const std::vector<std::string>& overrides) {
  std::vector<std::string> all = {"mold.angle=\"0 deg\"", "mapping.generators=axes"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return shipped("plane-mapping", all);
}

int told(const Case& definition) {
  int count = 0;
  for (const std::string& warning : map_warnings(definition, map_case(definition)))
    count += warning.find("ply.position and ply.angle") != std::string::npos ? 1 : 0;
  return count;
}

TEST(Placement, IsZeroWhereTheMappingFollowsThePly) {
  for (const char* angle : {"0 deg", "30 deg", "-100 deg"}) {
    const Case definition = flat({std::string("ply.angle=\"") + angle + "\""});
    const Placement placement = placement_of(definition, map_case(definition));
    EXPECT_LE(placement.shift, 1e-12);
    EXPECT_LE(std::abs(placement.turn_deg), 1e-9) << angle;
    EXPECT_LE(std::abs(placement.warp_turn_deg), 1e-9) << angle;
    EXPECT_LE(placement.moved, 1e-9);
    EXPECT_LE(placement.farthest, 1e-9);
    EXPECT_EQ(told(definition), 0);
  }
}

TEST(Placement, IsTheDistanceAndAngleByWhichTheMappingMissesThePly) {
  Case definition = flat({});
  const MapResult as_it_says = map_case(definition);
  definition.ply.position += Eigen::Vector2d(0.03, -0.04);
  const Placement shifted = placement_of(definition, as_it_says);
  EXPECT_NEAR(shifted.shift, 0.05, 1e-12);
  EXPECT_NEAR(shifted.moved, 0.05, 1e-9);
  EXPECT_NEAR(shifted.farthest, 0.05, 1e-9);
  EXPECT_LE(std::abs(shifted.turn_deg), 1e-9);
  EXPECT_EQ(told(definition), 1);

  definition = flat({});
  definition.ply.angle += 0.5;
  const Placement turned = placement_of(definition, as_it_says);
  const double degrees = -0.5 * 180 / 3.14159265358979323846;
  EXPECT_NEAR(turned.turn_deg, degrees, 1e-9);
  EXPECT_NEAR(turned.warp_turn_deg, degrees, 1e-9);
  EXPECT_GT(turned.moved, 0.01);
  EXPECT_NEAR(turned.moved, turned.farthest, 1e-9);
}

TEST(Placement, OfAShippedRigIsNotTold) {
  for (const char* name : {"flexdraper-5x5", "flexdraper-quick", "flexdraper-4"})
    EXPECT_EQ(told(shipped(name)), 0) << name;
}

TEST(Placement, ThatMidSidesTurnBackIsTold) {
  const std::vector<std::string> turned = {"ply.angle=\"30 deg\""};
  const Case definition = shipped("flexdraper-quick", turned);
  EXPECT_EQ(told(definition), 1);
  const Placement placement = placement_of(definition, map_case(definition));
  EXPECT_NEAR(placement.turn_deg, -30, 3);
  EXPECT_NEAR(placement.warp_turn_deg, -30, 6);
  EXPECT_EQ(told(shipped("flexdraper-quick", {turned[0], "mapping.generators=axes"})), 0);
  // Without a word on generators the mapping follows the ply.
  EXPECT_EQ(told(shipped("flexdraper-quick", {turned[0], "mapping.generators=null"})), 0);
}

TEST(Placement, OfAStartBesideThePlyIsTold) {
  const std::vector<std::string> beside = {"mapping.start=[\"265 mm\",\"225 mm\"]",
                                           "mapping.generators=axes"};
  const Placement placement =
      placement_of(shipped("flexdraper-quick", beside), map_case(shipped("flexdraper-quick", beside)));
  EXPECT_NEAR(placement.shift, 0.04, 1e-12);
  EXPECT_EQ(told(shipped("flexdraper-quick", beside)), 1);
}

}  // namespace
}  // namespace drapeplan
