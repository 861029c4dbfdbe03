#include "planner/method/field_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/schedule/families.hpp"

namespace drapeplan {
namespace {

constexpr int kPlaces = 4, kFields = 30;

/// Fields that are linear in the place, but for a bend.
Eigen::VectorXd fields_at(const Eigen::VectorXd& place, int level, double bend = 0) {
  Eigen::VectorXd fields(kFields);
  for (int f = 0; f < kFields; ++f) {
    fields[f] = 0.3 * level;
    for (int k = 0; k < kPlaces; ++k) fields[f] += std::sin(1.7 * f + 2.3 * k) * place[k];
    fields[f] += bend * std::sin(3 * place[0] + f);
  }
  return fields;
}

std::vector<Observation> observations(int count, int level = 0, double bend = 0) {
  std::vector<Observation> list;
  for (int k = 0; k < count; ++k) {
    const Eigen::VectorXd place = even_point(k, kPlaces);
    list.push_back({place, level, fields_at(place, level, bend), 0});
  }
  return list;
}

std::vector<const Observation*> all_of(const std::vector<Observation>& list) {
  std::vector<const Observation*> pointers;
  for (const Observation& one : list) pointers.push_back(&one);
  return pointers;
}

const Eigen::VectorXd kScale = Eigen::VectorXd::Constant(kFields, 0.1);

double error_at(const FieldModel& model, const Eigen::VectorXd& place, int level, double bend) {
  return (model.predict(place).fields - fields_at(place, level, bend)).lpNorm<Eigen::Infinity>();
}

/// Leaving one out is the model of all others. These have another mean and other lengths, so only about.
void expect_left_out(const FieldModel& whole, std::vector<Observation> list, std::ptrdiff_t k) {
  const Observation one = list[size_t(k)];
  const FieldModel::Miss left_out = whole.left_out(k);
  list.erase(list.begin() + k);
  const Kernel kernel = whole.kernel();
  const FieldModel others(all_of(list), kScale, one.level, &kernel, 1);
  const FieldModel::Prediction prediction = others.predict(one.place);
  const Eigen::VectorXd miss = one.fields - prediction.fields;
  EXPECT_LE((miss - left_out.fields).norm(), 0.3 * miss.norm());
  EXPECT_NEAR(prediction.spread, left_out.spread, 0.3 * left_out.spread);
}

TEST(FieldModel, LearnsWhatIsNearlyLinearFromAFewPlaces) {
  const Eigen::VectorXd place = Eigen::VectorXd::Constant(kPlaces, 0.4);
  const std::vector<Observation> few = observations(12, 0, 0.2), many = observations(60, 0, 0.2);
  const FieldModel poor(all_of(few), kScale, 0, nullptr, 1), good(all_of(many), kScale, 0, nullptr, 1);
  EXPECT_LE(error_at(good, place, 0, 0.2), 0.05);
  EXPECT_LE(error_at(good, place, 0, 0.2), error_at(poor, place, 0, 0.2));
  EXPECT_LE(good.missed(), 0.05);
  EXPECT_LT(good.missed(), poor.missed());
}

TEST(FieldModel, SpreadGrowsWithTheDistance) {
  const std::vector<Observation> list = observations(20);
  const FieldModel model(all_of(list), kScale, 0, nullptr, 1);
  const double here = model.predict(list[3].place).spread;
  const double far = model.predict(Eigen::VectorXd::Constant(kPlaces, 4)).spread;
  EXPECT_GT(here, 0);
  EXPECT_GT(far, 3 * here);
}

TEST(FieldModel, LeavingOneOutIsTheModelOfAllOthers) {
  const std::vector<Observation> list = observations(15, 0, 0.3);
  expect_left_out(FieldModel(all_of(list), kScale, 0, nullptr, 1), list, 7);
}

TEST(FieldModel, ACheaperLevelTeachesTheNextOne) {
  std::vector<Observation> list = observations(40, 0, 0.2);
  const Eigen::VectorXd place = Eigen::VectorXd::Constant(kPlaces, 0.6);
  for (const Observation& one : observations(4, 1, 0.2)) list.push_back(one);
  const FieldModel model(all_of(list), kScale, 1, nullptr, 1);
  const std::vector<Observation> alone = observations(4, 1, 0.2);
  const FieldModel poor(all_of(alone), kScale, 1, nullptr, 1);
  EXPECT_LE(error_at(model, place, 1, 0.2), 0.1);
  EXPECT_LE(error_at(model, place, 1, 0.2), 0.5 * error_at(poor, place, 1, 0.2));
}

/// Where one level has been seen, the other one is less sure of itself; leaving one out is the others' model
/// here as well.
TEST(FieldModel, LevelsAreToldApart) {
  std::vector<Observation> list = observations(20, 0, 0.2);
  for (const Observation& one : observations(6, 1, 0.2)) list.push_back(one);
  const Kernel kernel{.linear = 0.6, .length = 1.4, .noise = 0.003, .shared = 0.8};
  const FieldModel cheap(all_of(list), kScale, 0, &kernel, 1), fine(all_of(list), kScale, 1, &kernel, 1);
  EXPECT_GT(fine.predict(list[15].place).spread, 1.5 * cheap.predict(list[15].place).spread);
  expect_left_out(fine, list, 22);
}

TEST(FieldModel, HasTheSameBitsForEveryNumberOfThreads) {
  const std::vector<Observation> list = observations(30, 0, 0.2);
  const FieldModel one(all_of(list), kScale, 0, nullptr, 1), two(all_of(list), kScale, 0, nullptr, 2);
  const Eigen::VectorXd place = Eigen::VectorXd::Constant(kPlaces, 0.3);
  EXPECT_EQ(one.predict(place).fields, two.predict(place).fields);
  EXPECT_EQ(one.predict(place).spread, two.predict(place).spread);
}

TEST(FieldModel, EqualPlacesAndConstantFieldsAreNoTrouble) {
  std::vector<Observation> list = observations(2);
  list[1] = list[0];
  const FieldModel model(all_of(list), kScale, 0, nullptr, 1);
  EXPECT_LE((model.predict(list[0].place).fields - list[0].fields).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_TRUE(std::isfinite(model.predict(Eigen::VectorXd::Constant(kPlaces, 0.9)).spread));
}

}  // namespace
}  // namespace drapeplan
