// What tests of schedules share: a frame, and the promises of every schedule.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "planner/schedule/check.hpp"
#include "planner/schedule/strategy.hpp"

namespace drapeplan::test {

/// The article's 5x5 rig over a mold that rises along x and y.
inline SequenceFrame article_frame() {
  SequenceFrame frame;
  frame.rig.columns = frame.rig.rows = 5;
  frame.rig.spacing = 0.1;
  for (int g = 0; g < 25; ++g) {
    frame.target_z.push_back(0.05 + 0.1 * frame.rig.place(g)[0] + 0.05 * frame.rig.place(g)[1]);
  }
  return frame;
}

inline double last_end(const Strokes& s) {
  double last = 0;
  for (const Stroke& stroke : s) last = std::max(last, stroke.start + stroke.duration);
  return last;
}

inline double first_start(const Strokes& s) {
  double first = 1e9;
  for (const Stroke& stroke : s) first = std::min(first, stroke.start);
  return first;
}

/// All promises of to_schedule about one schedule.
inline void expect_sound(const SequenceFrame& frame, const Strokes& strokes) {
  const Schedule schedule = to_schedule(frame, strokes);
  ASSERT_EQ(schedule.paths.size(), frame.target_z.size());
  std::set<double> ups;  // when movements upwards end
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    const auto& path = schedule.paths[g];
    EXPECT_EQ(path.front().time, 0);
    EXPECT_LE(std::abs(path.front().z - frame.start_z()), 1e-6);
    EXPECT_LE(std::abs(path.back().z - (frame.target_z[g] - frame.options.overtravel)), 1e-6);
    EXPECT_EQ(path.back().time, schedule.paths[0].back().time);
    for (size_t k = 1; k < path.size(); ++k) {
      EXPECT_LT(path[k - 1].time, path[k].time);
      if (path[k].z > path[k - 1].z) ups.insert(path[k].time);
    }
  }
  EXPECT_LE(ups.size(), 1u) << "only the preshape may go up";
  EXPECT_EQ(rig_refusals(schedule, frame.rig), std::vector<std::string>());
  EXPECT_LE(first_start(strokes), 0);
}

}  // namespace drapeplan::test
