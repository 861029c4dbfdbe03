// A ply that likes certain arrival times, to search schedules for without a drape.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "mapping/error.hpp"
#include "planner/search/stages.hpp"
#include "tests/planner/search/noise.hpp"

namespace drapeplan {

inline SequenceFrame frame_of(int columns, int rows) {
  SequenceFrame frame;
  frame.rig.columns = columns;
  frame.rig.rows = rows;
  frame.rig.spacing = 0.1;
  for (int g = 0; g < frame.rig.count(); ++g) frame.target_z.push_back(0.05 + 0.1 * frame.rig.place(g)[0]);
  return frame;
}

/// The arrival times [s] that the synthetic ply likes: a wave from off the centre, plus what no wave can
/// give.
inline std::vector<double> liked_arrivals(const SequenceFrame& frame) {
  std::vector<double> arrivals;
  for (int g = 0; g < frame.rig.count(); ++g) {
    const double distance = (frame.rig.place(g) - Eigen::Vector2d(-0.06, 0.08)).norm() / frame.rig.spacing;
    arrivals.push_back(2.5 + 1.4 * distance + 0.5 * std::sin(3.7 * g));
  }
  return arrivals;
}

/// r.m.s. deviation of the arrival times (last movement of each gripper, gauge removed) from the liked ones
/// [s].
inline double deviation(const SequenceFrame& frame, const Schedule& schedule) {
  const std::vector<double> liked = liked_arrivals(frame);
  std::vector<double> error;
  double mean = 0;
  for (size_t g = 0; g < liked.size(); ++g) {
    const auto& path = schedule.paths[g];
    error.push_back(path[path.size() - 2].time - frame.options.preshape_duration - liked[g]);
    mean += error.back() / double(liked.size());
  }
  double sum = 0;
  for (const double e : error) sum += (e - mean) * (e - mean);
  return std::sqrt(sum / double(liked.size()));
}

/// 0.1 + deviation, 1 % noise, about one in twelve fails; "screen" is biased and noisier than "report".
inline Evaluate synthetic(const SequenceFrame& frame, std::atomic<int>* runs = nullptr) {
  return [frame, runs](const Schedule& schedule, const std::string& fidelity) {
    if (runs) ++*runs;
    const std::uint64_t hash = schedule_hash(schedule);
    const bool screen = fidelity == "screen";
    if (screen && test::hash_noise(hash, 17) > 1 - 1.0 / 6) throw NotFinished("not finite at node 3");
    Outcome outcome;
    outcome.score.valid = true;
    outcome.score.duration = schedule.duration();
    outcome.score.objective = (0.1 + deviation(frame, schedule)) * (screen ? 1.2 : 1.0) *
                              (1 + (screen ? 0.01 : 0.002) * test::hash_noise(hash, screen ? 1 : 2));
    return outcome;
  };
}

inline StagedOptions options_of(int evaluations) {
  StagedOptions options;
  options.optimise.evaluations = evaluations;
  return options;
}

inline void expect_same(const StagedResult& a, const StagedResult& b) {
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(schedule_hash(a.best.schedule), schedule_hash(b.best.schedule));
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.failed_evaluations, b.failed_evaluations);
  ASSERT_EQ(a.history.size(), b.history.size());
  for (size_t k = 0; k < a.history.size(); ++k) {
    EXPECT_EQ(a.history[k].schedule_hash, b.history[k].schedule_hash);
    EXPECT_EQ(a.history[k].objective, b.history[k].objective);
    EXPECT_EQ(a.history[k].best_so_far, b.history[k].best_so_far);
  }
}

}  // namespace drapeplan
