#include "planner/drape/strategy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace drapeplan {
namespace {

/// The article's 5x5 rig over a mold that rises along x and y.
SequenceFrame article_frame() {
  SequenceFrame frame;
  frame.rig.columns = frame.rig.rows = 5;
  frame.rig.spacing = 0.1;
  for (int g = 0; g < 25; ++g) {
    frame.target_z.push_back(0.05 + 0.1 * frame.rig.place(g)[0] + 0.05 * frame.rig.place(g)[1]);
  }
  return frame;
}

Eigen::VectorXd random_point(int n, unsigned seed) {
  std::mt19937 bits(seed);
  Eigen::VectorXd x(n);
  for (int i = 0; i < n; ++i) x[i] = double(bits()) / double(std::mt19937::max());
  return x;
}

double last_end(const Strokes& s) {
  double last = 0;
  for (size_t g = 0; g < s.start.size(); ++g) last = std::max(last, s.start[g] + s.duration[g]);
  return last;
}

/// All promises of to_schedule about one schedule.
void expect_sound(const SequenceFrame& frame, const Strokes& strokes) {
  const Schedule schedule = to_schedule(frame, strokes);
  ASSERT_EQ(schedule.paths.size(), frame.target_z.size());
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    const auto& path = schedule.paths[g];
    EXPECT_EQ(path.front().time, 0);
    EXPECT_LE(std::abs(path.front().z - frame.start_z()), 1e-6);
    EXPECT_LE(std::abs(path.back().z - (frame.target_z[g] - frame.options.overtravel)), 1e-6);
    EXPECT_EQ(path.back().time, schedule.paths[0].back().time);
    for (size_t k = 1; k < path.size(); ++k) {
      EXPECT_LT(path[k - 1].time, path[k].time);
      EXPECT_LE(path[k].z, path[k - 1].z);
    }
  }
  EXPECT_LE(schedule.largest_velocity(), frame.rig.max_velocity * (1 + 1e-3));
  EXPECT_LE(*std::min_element(strokes.start.begin(), strokes.start.end()), 0);
}

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
    return std::count_if(strokes.start.begin(), strokes.start.end(),
                         [&](double s) { return std::abs(s - t) < 1e-12; });
  };
  EXPECT_EQ(at(0.0), 1);
  EXPECT_EQ(at(0.8), 8);
  EXPECT_EQ(at(1.6), 16);
  EXPECT_EQ(strokes.start[12], 0);
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
  EXPECT_EQ(strokes.start[0], 0);
  EXPECT_LE(std::abs(strokes.start[24] - 4 * 0.8), 1e-12);
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
  expect_sound(frame, WaveFamily(frame).decode(random_point(WaveFamily::kDimension, 3)));
}

TEST(Strategy, EveryMemberOfBothFamiliesIsSoundAndNotTooLong) {
  const SequenceFrame frame = article_frame();
  const WaveFamily waves(frame);
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Strokes wave = waves.decode(random_point(WaveFamily::kDimension, seed));
    expect_sound(frame, wave);
    EXPECT_LE(last_end(wave), frame.longest_sequence + 1e-9);
    const GripperFamily grippers(frame, wave);
    const Strokes strokes = grippers.decode(random_point(grippers.dimension(), seed + 1000));
    expect_sound(frame, strokes);
    EXPECT_LE(last_end(strokes), frame.longest_sequence + 1e-9);
    EXPECT_GE(*std::min_element(strokes.duration.begin(), strokes.duration.end()),
              frame.shortest_stroke - 1e-9);
  }
}

TEST(Strategy, EncodedBaselinesAreTheSameSchedulesInEveryFamily) {
  const SequenceFrame frame = article_frame();
  const WaveFamily waves(frame);
  WaveParameters flat = baseline_wave(frame);
  flat.delay = 0;
  flat.duration = frame.options.uniform_duration;
  const auto equal = [&](const Strokes& a, const Strokes& b) {
    const Schedule p = to_schedule(frame, a), q = to_schedule(frame, b);
    for (size_t g = 0; g < 25; ++g) {
      if (p.paths[g].size() != q.paths[g].size()) return false;
      for (size_t k = 0; k < p.paths[g].size(); ++k) {
        if (p.paths[g][k].time != q.paths[g][k].time || p.paths[g][k].z != q.paths[g][k].z) return false;
      }
    }
    return true;
  };
  EXPECT_TRUE(equal(waves.decode(waves.encode(flat)), uniform_strokes(frame)));
  EXPECT_TRUE(equal(waves.decode(waves.encode(baseline_wave(frame))), wave_strokes(frame)));
  for (const Strokes& base : {uniform_strokes(frame), wave_strokes(frame)}) {
    const GripperFamily grippers(frame, base);
    EXPECT_EQ(grippers.encode_base().size(), grippers.dimension());
    EXPECT_TRUE(equal(grippers.decode(grippers.encode_base()), base));
  }
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
