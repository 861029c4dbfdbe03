#include "planner/method/composite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "planner/method/cmaes.hpp"

namespace drapeplan {
namespace {

constexpr Eigen::Index kDimension = 12, kFields = 40;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Fields are linear in the place but for some bending; all are zero at one place.
Eigen::VectorXd fields_at(const Eigen::VectorXd& place) {
  Eigen::VectorXd fields(kFields);
  for (Eigen::Index f = 0; f < kFields; ++f) {
    double sum = 0;
    for (Eigen::Index k = 0; k < kDimension; ++k)
      sum += std::sin(1.3 * double(f) + 2.1 * double(k)) * (place[k] - 0.62);
    fields[f] = sum + 0.1 * std::sin(3 * sum);
  }
  return fields;
}

/// A largest value and a root mean square: kinks everywhere.
double objective(const Eigen::VectorXd& fields) {
  return fields.lpNorm<Eigen::Infinity>() + fields.norm() / std::sqrt(double(kFields));
}

const SearchSpace kSpace{kDimension, [](const Eigen::VectorXd& x) { return x; },
                         [](const Eigen::VectorXd& x) { return x; }};

CompositeSearch search_with(bool fields, int threads = 1) {
  const ObjectiveNear near = [](const Eigen::VectorXd&) { return objective; };
  return {near, fields ? Eigen::VectorXd::Constant(kFields, 0.05) : Eigen::VectorXd(), {.threads = threads}};
}

/// @return the best value of so many evaluations from a corner of the box, after a dozen points beside it.
double run(CompositeSearch& search, int evaluations, bool with_fields, bool failures = false) {
  double best = kInfinity;
  int done = 0;
  const auto evaluate = [&](const Eigen::VectorXd& x) {
    const Eigen::VectorXd fields = fields_at(x);
    std::vector<float> told;
    if (with_fields) told.assign(fields.data(), fields.data() + fields.size());
    const bool failed = failures && done % 7 == 3;
    const double value = failed ? kInfinity : objective(fields);
    search.observe(x, 0, told, value);
    best = std::min(best, value);
    ++done;
  };
  for (Eigen::Index k = 0; k < kDimension; ++k)
    evaluate(Eigen::VectorXd::Constant(kDimension, 0.2) + 0.05 * Eigen::VectorXd::Unit(kDimension, k));
  while (done < evaluations) {
    const Eigen::MatrixXd x = search.ask(kSpace);
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      EXPECT_TRUE((x.col(k).array() >= 0).all() && (x.col(k).array() <= 1).all());
      evaluate(x.col(k));
    }
    search.end_batch();
  }
  return best;
}

TEST(CompositeSearch, FindsInSixtyEvaluationsWhatCmaEsDoesNotInThreeHundred) {
  CompositeSearch search = search_with(true);
  const double best = run(search, 60, true);
  CmaEs other(Eigen::VectorXd::Constant(kDimension, 0.2), {.sigma0 = 0.1});
  double best_of_other = kInfinity;
  for (int done = 0; done < 300; done += other.population()) {
    const Eigen::MatrixXd x = other.ask();
    Eigen::VectorXd values(x.cols());
    for (Eigen::Index k = 0; k < x.cols(); ++k) values[k] = objective(fields_at(x.col(k)));
    best_of_other = std::min(best_of_other, values.minCoeff());
    other.tell(values);
  }
  EXPECT_LE(best, 0.2);
  EXPECT_LT(best, best_of_other);
}

TEST(CompositeSearch, WithoutFieldsItLearnsFromValues) {
  CompositeSearch search = search_with(false);
  const double start = objective(fields_at(Eigen::VectorXd::Constant(kDimension, 0.2)));
  EXPECT_LE(run(search, 120, false), 0.4 * start);
}

TEST(CompositeSearch, OneFailureInSevenStopsNothing) {
  CompositeSearch search = search_with(true);
  EXPECT_LE(run(search, 80, true, true), 0.2);
}

TEST(CompositeSearch, HandsOutTheSameForEveryNumberOfThreads) {
  CompositeSearch one = search_with(true, 1), two = search_with(true, 2);
  run(one, 30, true);
  run(two, 30, true);
  EXPECT_EQ(one.ask(kSpace), two.ask(kSpace));
  EXPECT_EQ(one.ask(kSpace, 1).cols(), 1);
}

TEST(CompositeSearch, SeeksWhatIsBestAtTheFidelityThatItAimsAt) {
  // At level 1 the first field is larger by one: there the objective is another one, and so is its optimum.
  const auto shifted = [](const Eigen::VectorXd& place) {
    Eigen::VectorXd fields = fields_at(place);
    fields[0] += 1;
    return fields;
  };
  const auto observe = [](CompositeSearch& search, const Eigen::VectorXd& x, int level, const Eigen::VectorXd& f) {
    search.observe(x, level, std::vector<float>(f.data(), f.data() + f.size()), objective(f));
  };
  CompositeSearch plain = search_with(true), aims = search_with(true);
  for (CompositeSearch* search : {&plain, &aims}) {
    for (Eigen::Index k = 0; k < kDimension; ++k) {
      const Eigen::VectorXd x =
          Eigen::VectorXd::Constant(kDimension, 0.6) + 0.05 * Eigen::VectorXd::Unit(kDimension, k);
      observe(*search, x, 0, fields_at(x));
      if (k < 2) observe(*search, x, 1, shifted(x));
    }
  }
  aims.aim_at(1);
  const Eigen::VectorXd seen = Eigen::VectorXd::Constant(kDimension, 0.6) + 0.05 * Eigen::VectorXd::Unit(kDimension, 0);
  EXPECT_NEAR(aims.value_at(seen), objective(shifted(seen)), 1e-5);
  EXPECT_NEAR(plain.value_at(seen), objective(fields_at(seen)), 1e-5);
  EXPECT_EQ(aims.value_at(Eigen::VectorXd::Zero(kDimension)), kInfinity);
  for (int batch = 0; batch < 12; ++batch) {
    for (CompositeSearch* search : {&plain, &aims}) {
      const Eigen::MatrixXd x = search->ask(kSpace);
      for (Eigen::Index k = 0; k < x.cols(); ++k) observe(*search, x.col(k), 0, fields_at(x.col(k)));
      search->end_batch();
    }
  }
  EXPECT_LT(objective(shifted(aims.best_place())), objective(shifted(plain.best_place())));
  EXPECT_LT(objective(fields_at(plain.best_place())), objective(fields_at(aims.best_place())));
  aims.set_level(0);
  EXPECT_NEAR(aims.value_at(seen), objective(fields_at(seen)), 1e-5);
}

TEST(CompositeSearch, AsksOnlyForWhatIsPossible) {
  CompositeSearch search = search_with(true);
  run(search, 30, true);
  SearchSpace space = kSpace;
  // Half-way from the best that was seen to what would be asked for, along the first coordinate.
  const Eigen::VectorXd seen = search.best_place(), wish = search.ask(kSpace, 1).col(0);
  const double way = wish[0] - seen[0];
  space.possible = [&](const Eigen::VectorXd& x) { return (x[0] - seen[0]) / way <= 0.5; };
  EXPECT_FALSE(space.possible(wish));
  const Eigen::MatrixXd batch = search.ask(space);
  for (Eigen::Index k = 0; k < batch.cols(); ++k) EXPECT_TRUE(space.possible(batch.col(k))) << k;
}

TEST(CompositeSearch, IsReadyOnceThereIsSomethingToLearnFrom) {
  CompositeSearch search = search_with(false);
  EXPECT_FALSE(search.ready());
  search.observe(Eigen::VectorXd::Constant(kDimension, 0.2), 0, {}, 3);
  search.observe(Eigen::VectorXd::Constant(kDimension, 0.3), 0, {}, kInfinity);
  EXPECT_FALSE(search.ready());
  search.observe(Eigen::VectorXd::Constant(kDimension, 0.4), 0, {}, 2);
  EXPECT_TRUE(search.ready());
  search.set_level(1);
  EXPECT_FALSE(search.ready()) << "nothing was seen there";
  search.observe(Eigen::VectorXd::Constant(kDimension, 0.4), 1, {}, 2);
  EXPECT_TRUE(search.ready());
}

}  // namespace
}  // namespace drapeplan
