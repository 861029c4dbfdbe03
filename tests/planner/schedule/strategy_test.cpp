#include "planner/schedule/strategy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/planner/schedule/sequences.hpp"

namespace drapeplan {
namespace {

using test::article_frame;
using test::expect_sound;
using test::last_end;

TEST(Strategy, UniformIsOnePreshapeAndOneStrokeForAll) {
  const SequenceFrame frame = article_frame();
  const Strokes strokes = uniform_strokes(frame);
  expect_sound(frame, strokes);
  const Schedule schedule = to_schedule(frame, strokes);
  for (size_t g = 0; g < 25; ++g) {
    EXPECT_EQ(schedule.paths[g][1].time, 5);
    EXPECT_LE(std::abs(schedule.paths[g][1].z - frame.target_z[g] - 0.030), 1e-6);
    EXPECT_EQ(schedule.paths[g][2].time, 10);
    EXPECT_EQ(schedule.paths[g].size(), 4u);
  }
  EXPECT_EQ(schedule.paths[0].back().time, 11);
}

TEST(Strategy, RigsThatDriveXAndYMoveInPlaneDuringThePreshapeOnly) {
  SequenceFrame frame = article_frame();
  EXPECT_TRUE(to_schedule(frame, uniform_strokes(frame)).plane_paths.empty());
  for (int g = 0; g < 25; ++g) {
    frame.start_xy.push_back(frame.rig.place(g));
    frame.target_xy.push_back(frame.rig.place(g) * 0.9);
  }
  Schedule schedule = to_schedule(frame, wave_strokes(frame));
  ASSERT_EQ(schedule.plane_paths.size(), 25u);
  EXPECT_EQ(schedule.plane_paths[0].back().time, 5);
  EXPECT_LE((schedule.plane_paths[0].back().xy - frame.target_xy[0]).norm(), 1e-6);
  EXPECT_LE((schedule.plane_paths[0].front().xy - frame.start_xy[0]).norm(), 1e-6);
  frame.rig.max_velocity = 0.2 * 0.1 * std::sqrt(2) / 10;  // the corners' way in 10 s
  schedule = to_schedule(frame, wave_strokes(frame));
  EXPECT_GE(schedule.plane_paths[0].back().time, 10);
  EXPECT_LE(schedule.largest_velocity(), frame.rig.max_velocity * (1 + 1e-3));
}

TEST(Strategy, ReleaseCountsFromTheEndOfTheLastStroke) {
  SequenceFrame frame = article_frame();
  EXPECT_TRUE(to_schedule(frame, wave_strokes(frame)).release.empty());
  frame.rig.release_time = 0.25;
  const Schedule schedule = to_schedule(frame, wave_strokes(frame));
  ASSERT_EQ(schedule.release.size(), 25u);
  for (const auto& time : schedule.release) EXPECT_LE(std::abs(*time - (5 + 5.1 + 0.25)), 1e-9);
}

TEST(Strategy, ArticleWaveHasGroupsOfOneEightAndSixteen) {
  const SequenceFrame frame = article_frame();
  const Strokes strokes = wave_strokes(frame);
  expect_sound(frame, strokes);
  const auto at = [&](double t) {
    return std::count_if(strokes.begin(), strokes.end(),
                         [&](const Stroke& s) { return std::abs(s.start - t) < 1e-12; });
  };
  EXPECT_EQ(at(0.0), 1);
  EXPECT_EQ(at(0.8), 8);
  EXPECT_EQ(at(1.6), 16);
  EXPECT_EQ(strokes[12].start, 0);
  EXPECT_LE(std::abs(last_end(strokes) - 5.1), 1e-12);
}

TEST(Strategy, DelayFromTheEndGivesTheLongWave) {
  SequenceFrame frame = article_frame();
  frame.options.wave_delay_from = DelayFrom::end;
  EXPECT_LE(std::abs(last_end(wave_strokes(frame)) - 12.1), 1e-12);
}

TEST(Strategy, WaveFromACornerStartsThere) {
  SequenceFrame frame = article_frame();
  frame.options.wave_start = {-0.2, -0.2};
  const Strokes strokes = wave_strokes(frame);
  EXPECT_EQ(strokes[0].start, 0);
  EXPECT_LE(std::abs(strokes[24].start - 4 * 0.8), 1e-12);
}

TEST(Strategy, FastStrokesAreStretchedToTheLargestVelocityAndItIsSaid) {
  SequenceFrame frame = article_frame();
  EXPECT_EQ(stretched(frame, uniform_strokes(frame)), "");
  frame.options.uniform_duration = 0.01;
  frame.options.preshape_duration = 0.01;
  expect_sound(frame, uniform_strokes(frame));
  EXPECT_NE(stretched(frame, uniform_strokes(frame)).find("25 strokes take 0.160 s"), std::string::npos);
}

TEST(Strategy, FlatTargetsAndNoPreshapeTimeStillGiveIncreasingKnots) {
  SequenceFrame frame = article_frame();
  frame.target_z.assign(25, 0.02);
  frame.options.preshape_duration = 0;
  frame.options.settle = 0;
  expect_sound(frame, wave_strokes(frame));
}

TEST(Strategy, OneGripperHasAWaveToo) {
  SequenceFrame frame;
  frame.rig.columns = frame.rig.rows = 1;
  frame.rig.spacing = 0.1;
  frame.target_z = {0.01};
  expect_sound(frame, wave_strokes(frame));
}

TEST(Strategy, PadsThatAreDownAfterThePreshapeStayDown) {
  const SequenceFrame frame = article_frame();
  Strokes strokes = wave_strokes(frame);
  strokes[7].height = -frame.options.overtravel;
  strokes[8].height = -1;  // deeper than any command goes
  expect_sound(frame, strokes);
  const Schedule schedule = to_schedule(frame, strokes);
  for (const size_t g : {7, 8}) {
    ASSERT_EQ(schedule.paths[g].size(), 3u);
    EXPECT_EQ(schedule.paths[g][1].time, 5);
    EXPECT_LE(std::abs(schedule.paths[g][1].z - frame.target_z[g] + frame.options.overtravel), 1e-6);
  }
  EXPECT_EQ(schedule.paths[0].size(), 5u);
}

TEST(Strategy, GrippersLeaveLateAndBendTheirStrokesAsTheyAreTold) {
  const SequenceFrame frame = article_frame();
  Strokes strokes = uniform_strokes(frame);
  strokes[3] = {.start = 1, .duration = 4, .height = 0.020, .leave = 0.5, .bend = 0.25};
  expect_sound(frame, strokes);
  const std::vector<Knot> path = to_schedule(frame, strokes).paths[3];
  ASSERT_EQ(path.size(), 7u);
  EXPECT_EQ(path[1].time, 2.5);
  EXPECT_EQ(path[1].z, path[0].z);
  EXPECT_EQ(path[3].time, 6);
  EXPECT_EQ(path[4].time, 8);
  EXPECT_LE(std::abs(path[4].z - (frame.target_z[3] + 0.020 - 0.25 * 0.022)), 1e-6);
  EXPECT_EQ(path[5].time, 10);
}

TEST(Strategy, TheLargestAccelerationBoundsEveryChangeOfVelocity) {
  SequenceFrame frame = article_frame();
  frame.rig.max_acceleration = 0.1;
  frame.options.uniform_duration = frame.options.preshape_duration = 0.5;
  Strokes strokes = uniform_strokes(frame);
  for (Stroke& stroke : strokes) stroke.height = 0.3;  // up first, then down at once: both in one blend
  expect_sound(frame, strokes);
  EXPECT_NE(stretched(frame, strokes).find("0.005 m/s"), std::string::npos) << stretched(frame, strokes);
}

TEST(Strategy, LowerPreshapeKeepsTheStartAndGoesFurtherDown) {
  const SequenceFrame frame = article_frame();
  WaveParameters wave = baseline_wave(frame);
  wave.preshape_height = 0.01;
  const Schedule schedule = to_schedule(frame, wave_strokes(frame, wave));
  EXPECT_LE(std::abs(schedule.paths[0][0].z - frame.start_z()), 1e-6);
  EXPECT_LE(std::abs(schedule.paths[0][1].z - frame.target_z[0] - 0.01), 1e-6);
}

}  // namespace
}  // namespace drapeplan
