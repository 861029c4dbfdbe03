#include "planner/score/score.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "planner/drape/result_fields.hpp"

namespace drapeplan {
namespace {

/// Every part has a value of its own.
Score numbered() {
  Score score;
  double next = 1;
  for (const ScorePart& part : kScoreParts) score.*part.value = next++;
  score.valid = true;
  return score;
}

TEST(ScoreParts, EveryNumberOfAScoreHasOneLine) {
  const Score score = numbered();
  const auto* first = reinterpret_cast<const std::byte*>(&score.max_gap);
  const auto* end = reinterpret_cast<const std::byte*>(&score.valid);
  EXPECT_EQ(size_t(end - first), kScoreParts.size() * sizeof(double));
  std::set<double> values;
  std::set<std::string> keys, labels;
  for (const ScorePart& part : kScoreParts) {
    values.insert(score.*part.value);
    keys.insert(part.key);
    labels.insert(part.label);
  }
  EXPECT_EQ(values.size(), kScoreParts.size());
  EXPECT_EQ(keys.size(), kScoreParts.size());
  EXPECT_EQ(labels.size(), kScoreParts.size());
}

TEST(ScoreParts, ResultsHoldEveryPartAndOfAFailedRunTheReason) {
  Score score = numbered();
  nlohmann::json out = score_json(score);
  for (const ScorePart& part : kScoreParts) EXPECT_EQ(out.at(part.key).get<double>(), score.*part.value);
  for (const char* key :
       {"max_gap", "rms_gap", "wrinkled_area", "max_boundary_offset", "rms_boundary_offset", "max_shear_deg",
        "max_fibre_strain", "max_fibre_compression", "max_actuator_force", "duration", "objective"}) {
    EXPECT_TRUE(out.contains(key)) << key;
  }
  score.valid = false;
  score.reason = "diverged";
  out = score_json(score);
  EXPECT_TRUE(out.at("max_gap").is_null());
  EXPECT_EQ(out.at("objective").get<double>(), score.objective);
  EXPECT_EQ(out.at("reason"), "diverged");
}

TEST(ScoreParts, TextsHaveLabelValueAndUnit) {
  Score score;
  score.max_gap = 0.00315;
  score.max_boundary_offset = 0.00669;
  score.objective = 30.16;
  score.valid = true;
  EXPECT_EQ(title_of(kScoreParts.front()), "largest gap [mm]");
  EXPECT_EQ(title_of(kScoreParts.back()), "objective");
  for (const ScorePart& part : kScoreParts)
    EXPECT_NE(score_text(score).find(part.label), std::string::npos) << part.label;
  score.max_gap = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(value_text(kScoreParts.front(), score), "\u2013");
  score.valid = false;
  score.reason = "diverged";
  EXPECT_EQ(score_text(score), "diverged");
}

TEST(ForceText, SpeaksOfTheLimitOnlyWhereItWasReached) {
  Score score;
  score.valid = true;
  EXPECT_EQ(force_text(score, 50, 0.01), "");
  score.saturated = 8;
  score.duration = 14.2;
  score.max_lag = 0.0083;
  EXPECT_EQ(
      force_text(score, 50, 0.01),
      "Some actuator is at its limit of 50 N for 8.0 of 14.2 s, and joints are up to 8.3 mm behind their "
      "commands, of 10 mm allowed: more force could move the ply further.");
}

}  // namespace
}  // namespace drapeplan
