#include "planner/base/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace drapeplan {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Median, IsTheMiddleOrTheMeanOfBothMiddleOnes) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Ranks, TiesShareTheirMean) {
  EXPECT_EQ(ranks({10, 30, 20, 20}), (std::vector<double>{1, 4, 2.5, 2.5}));
}

TEST(RankCorrelation, OfTheSameAndTheOppositeOrder) {
  const std::vector<double> up{1, 2, 4, 8, 16}, down{5, 4, 3, 2, 1};
  EXPECT_NEAR(spearman(up, {0.1, 0.2, 0.3, 7, 8}), 1, 1e-15);
  EXPECT_NEAR(spearman(up, down), -1, 1e-15);
  EXPECT_NEAR(kendall(up, down), -1, 1e-15);
  EXPECT_NEAR(kendall(up, up), 1, 1e-15);
}

// By hand: differences of ranks 1, 1, 0, 0, 0 give 1 - 6 * 2 / (5 * 24); one pair of ten in the opposite
// order.
TEST(RankCorrelation, OfOneNeighbouringSwap) {
  const std::vector<double> a{1, 2, 3, 4, 5}, b{2, 1, 3, 4, 5};
  EXPECT_NEAR(spearman(a, b), 0.9, 1e-15);
  EXPECT_NEAR(kendall(a, b), 0.8, 1e-15);
}

TEST(RankCorrelation, RefusesWhatHasNoRank) {
  EXPECT_THROW((void)spearman({1, 2}, {1}), std::invalid_argument);
  EXPECT_THROW((void)kendall({1, kNan}, {1, 2}), std::invalid_argument);
  EXPECT_TRUE(std::isnan(spearman({1, 1}, {1, 2})));
  EXPECT_TRUE(std::isnan(kendall({}, {})));
}

TEST(DifferenceNoise, IsFoundUnderASmoothFunction) {
  constexpr double kNoise = 1e-3;
  double ratio_sum = 0;
  constexpr int kTrials = 40;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    std::mt19937 random(trial);
    std::normal_distribution<double> noise(0, kNoise);
    std::vector<double> values;
    for (int k = 0; k < 7; ++k) values.push_back(std::sin(0.01 * k) + 3 + noise(random));
    ratio_sum += difference_noise(values).noise / kNoise;
  }
  EXPECT_NEAR(ratio_sum / kTrials, 1, 0.25);  // seven values tell a deviation to a third
}

TEST(DifferenceNoise, OfASmoothFunctionIsNextToNothing) {
  std::vector<double> values;
  for (int k = 0; k < 7; ++k) values.push_back(1 + 0.1 * k + 0.01 * k * k);
  const NoiseEstimate estimate = difference_noise(values);
  EXPECT_LE(estimate.noise, 1e-14);
  EXPECT_THROW((void)difference_noise({1, 2, 3}), std::invalid_argument);
}

TEST(ObservedOrder, IsReadOffExactErrors) {
  const std::vector<double> size{1, 2, 4};
  EXPECT_NEAR(observed_order(size, {1e-3, 4e-3, 16e-3}), 2, 0.011);
  EXPECT_TRUE(std::isnan(observed_order({1, 2}, {1e-3, kNan})));
  EXPECT_TRUE(std::isnan(observed_order({1, 1}, {1e-3, 2e-3})));
}

TEST(ObservedOrder, OfErrorsThatDoNotFallIsNone) {
  EXPECT_TRUE(std::isnan(observed_order({1, 2, 4}, {3e-3, 2e-3, 3e-3})));
}

TEST(ObservedOrder, CountsThatTheReferenceHasAnErrorToo) {
  const double r = 0.5;
  std::vector<double> size{0.7, 1, 2}, error;
  for (const double h : size) error.push_back(3 * (std::pow(h, 1.5) - std::pow(r, 1.5)));
  EXPECT_NEAR(observed_order(size, error, r), 1.5, 0.011);
}

TEST(ParetoFront, HoldsWhatNoOtherPointBeats) {
  EXPECT_EQ(pareto_front({1, 2, 3, 4, 2}, {9, 5, 6, 1, 5.5}), (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(pareto_front({1, kNan}, {kNan, 1}), std::vector<int>{});
}

}  // namespace
}  // namespace drapeplan
