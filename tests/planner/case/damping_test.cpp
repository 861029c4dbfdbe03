// Mass damping stated by a strip: [Krogh], Eqs. (4) and (5).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// cases/elastica.json with another damping section: the article's strip, 150 mm long, as a linear law.
CaseReading strip_case(const json& damping, const json& material = {}) {
  json document = json::parse(std::ifstream(fs::path(DRAPEPLAN_SOURCE_DIR) / "cases/elastica.json"));
  document["damping"] = damping;
  for (const auto& [key, value] : material.items()) document["material"][key] = value;
  const fs::path file =
      fs::path(testing::TempDir()) / ("damping_test_" + std::to_string(::getpid()) + ".json");
  std::ofstream(file) << document;
  CaseReading reading = read_case(file, {});
  fs::remove(file);
  return reading;
}

double alpha_of(const json& damping, const json& material = {}) {
  const CaseReading reading = strip_case(damping, material);
  for (const InputError& error : reading.errors) ADD_FAILURE() << error.text();
  return reading.definition.damping.value_or(NAN);
}

/// t = 0.3 mm, m = 0.314 kg/m^2, L = 150 mm.
double modulus_at(double frequency) {
  return 12 * 0.314 * std::pow(0.15, 4) / std::pow(3e-4, 3) * std::pow(frequency / std::pow(1.8751, 2), 2);
}

json pascal(double value) {
  return std::to_string(value) + " Pa";
}

TEST(Damping, OfTheArticlesStripIs22PerSecond) {
  EXPECT_NEAR(modulus_at(11), 691.5e6, 0.5e6);
  const json strip = {
      {"by", "strip"}, {"ratio", 1}, {"length", "150 mm"}, {"modulus", pascal(modulus_at(11))}};
  EXPECT_NEAR(alpha_of(strip), 22, 1e-4);
  EXPECT_EQ(alpha_of({{"alpha", "22 1/s"}}), 22);
}

TEST(Damping, TakesTheModulusOfALinearLaw) {
  const json strip = {{"by", "strip"}, {"length", "150 mm"}};
  EXPECT_NEAR(alpha_of(strip, {{"modulus", pascal(modulus_at(11))}}), 22, 1e-4);
}

TEST(Damping, GrowsWithRatioAndRootOfModulusAndFallsWithSquaredLength) {
  const json strip = {
      {"by", "strip"}, {"ratio", 0.5}, {"length", "150 mm"}, {"modulus", pascal(modulus_at(11))}};
  json stiffer = strip, longer = strip;
  stiffer["modulus"] = pascal(4 * modulus_at(11));
  longer["length"] = "300 mm";
  EXPECT_NEAR(alpha_of(strip), 11, 1e-4);
  EXPECT_NEAR(alpha_of(stiffer), 22, 1e-4);
  EXPECT_NEAR(alpha_of(longer), 2.75, 1e-4);
}

}  // namespace
}  // namespace drapeplan
