// The file of tests: what belongs to which test, data that cannot be right, and a strip whose shape was
// measured.
#include "planner/measured/tests_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <random>

#include "planner/characterise/characterise.hpp"
#include "planner/method/normal.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

constexpr double kLength = 0.15, kGravity = 9.81;  // [m], [m/s^2]

/// A folder of its own with a file of tests, beside the data that it names.
class TestsFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  /// @param test  e.g. `"tension": [...]`.
  [[nodiscard]] TestsReading read(const std::string& test) const {
    write("tests.json", fmt::format(R"({{"format": "drapeplan-tests 1", "thickness": "0.3 mm",
      "areal_density": "314 g/m^2", "assumed": "{}/cases/materials/bmi-4hs.json",
      {}}})",
                                    DRAPEPLAN_SOURCE_DIR, test));
    return read_tests(folder_ / "tests.json");
  }

  [[nodiscard]] std::string error(const std::string& test) const {
    const TestsReading reading = read(test);
    return reading.errors.empty() ? "none" : reading.errors.front().text();
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("tests_file_test_" + std::to_string(::getpid()));
};

/// The strip at rest that the shipped material makes.
struct Strip {
  BendingLaw law;
  StripAtRest rest;
};
Strip strip_of(const MaterialFields& material) {
  const Fabric fabric = fabric_of(material);
  Strip strip{section_bending(fabric.tension.slowest(), fabric.compression.slowest(), fabric.thickness), {}};
  strip.rest = strip_at_rest(strip.law, kLength, kGravity * fabric.areal_density);
  return strip;
}

/// A profile's table. @param noise  standard deviation of both coordinates [m].
std::string profile_table(const StripAtRest& strip, double noise, unsigned seed) {
  std::mt19937_64 bits(seed);
  std::string text = "x (mm);Deflection (mm)\n";
  for (size_t k = 0; k < strip.places.size(); k += 4) {
    const Eigen::Vector2d error(standard_normal(bits), standard_normal(bits));
    const Eigen::Vector2d seen = strip.places[k] + noise * error;
    text += fmt::format("{:.3f};{:.3f}\n", 1e3 * seen.x(), -1e3 * seen.y());
  }
  return text;
}

const char* const kProfile =
    R"("cantilever": [{"length": "150 mm", "width": "25 mm", "profile": "shape.csv"}])";

TEST_F(TestsFile, GivesTheBendingLawOfAMeasuredProfile) {
  write("shape.csv", "");
  const Strip truth = strip_of(*read(kProfile).tests.assumed);
  for (const unsigned seed : {1U, 2U, 3U}) {
    constexpr double kNoise = 5e-5;  // [m]: a quarter of a pixel of the pictures
    write("shape.csv", profile_table(truth.rest, kNoise, seed));
    const TestsReading reading = read(kProfile);
    ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
    const Characterisation found = characterise(reading.tests, 1);
    ASSERT_EQ(found.profiles.size(), 1U);
    EXPECT_TRUE(found.strips.empty() && !found.compression) << "a shape at rest says nothing of rates";
    const ProfileLaw& profile = found.profiles.front();
    const double largest = truth.law(truth.rest.moment.front());
    for (const double share : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      const double moment = share * truth.rest.moment.front();
      EXPECT_NEAR(profile.law(moment), truth.law(moment), 0.05 * largest)
          << share << " of the moment, seed " << seed;
    }
    const double load = kGravity * reading.tests.areal_density;
    EXPECT_NEAR(strip_at_rest(profile.law, kLength, load).tip(), truth.rest.tip(), 0.01 * truth.rest.tip());
    EXPECT_NEAR(profile.material_drop, truth.rest.tip(), 1e-9) << "the assumed material is the truth";
    EXPECT_NEAR(profile.drop, truth.rest.tip(), 4 * kNoise);
    for (size_t k = 0; k < profile.law.strain.size(); ++k)
      EXPECT_NEAR(profile.material.stress[k], truth.law(profile.law.strain[k]), 1e-9);
  }
}

TEST_F(TestsFile, RefusesAProfileThatIsNone) {
  write("shape.csv", "");
  const Strip truth = strip_of(*read(kProfile).tests.assumed);
  const std::string good = profile_table(truth.rest, 0, 1), names = good.substr(0, good.find('\n') + 1);
  write("shape.csv", good);
  ASSERT_EQ(error(kProfile), "none");
  EXPECT_NE(error(R"("cantilever": [{"length": "120 mm", "width": "25 mm", "profile": "shape.csv"}])")
                .find("the strip is 150 mm long up to this place, not 120 mm"),
            std::string::npos);
  EXPECT_NE(
      error(
          R"("cantilever": [{"length": "150 mm", "width": "25 mm", "profile": "shape.csv", "file": "a.csv"}])")
          .find("needs one of three"),
      std::string::npos);
  EXPECT_NE(error(R"("cantilever": [{"length": "150 mm", "width": "25 mm"}])").find("needs one of three"),
            std::string::npos);
  write("shape.csv", good + "10;3\n");
  EXPECT_NE(error(kProfile).find("shape.csv:103: distance: does not increase"), std::string::npos)
      << error(kProfile);
  write("shape.csv", names + "0;0\n150;80\n");
  EXPECT_NE(error(kProfile).find("it needs 20 at least"), std::string::npos);
  std::string flat = names, up = names;
  for (int k = 0; k <= 30; ++k) flat += fmt::format("{};0\n", 5 * k), up += fmt::format("{};{}\n", 5 * k, -k);
  write("shape.csv", flat);
  EXPECT_NE(error(kProfile).find("too little to be measured"), std::string::npos);
  write("shape.csv", up);
  EXPECT_NE(error(kProfile).find("lies above the clamp"), std::string::npos);
}

TEST_F(TestsFile, RefusesForcesThatNoSpecimenHas) {
  const char* const tension =
      R"("tension": [{"file": "pull.csv", "width": "25 mm", "height": "150 mm", "rate": "2 mm/min"}])";
  const auto with = [&](const std::function<double(int)>& force, const char* test) {
    std::string text = "Extension (mm),Load (N)\n";
    for (int k = 0; k < 60; ++k) text += fmt::format("{},{}\n", 0.01 * k, force(k));
    write("pull.csv", text);
    return error(test);
  };
  EXPECT_EQ(with([](int k) { return 2.0 * k; }, tension), "none");
  EXPECT_NE(with([](int) { return 0.0; }, tension).find("0 N is the largest one"), std::string::npos);
  EXPECT_NE(with([](int k) { return -2.0 * k; }, tension).find("Pulling forces are > 0"), std::string::npos);
  EXPECT_NE(
      with([](int) { return 5.0; }, tension).find("pull.csv:2: force: 5 N is the largest one: no curve"),
      std::string::npos);
  EXPECT_NE(with([](int k) { return 1e-6 * k; }, tension).find("is no force of a test"), std::string::npos);
  EXPECT_NE(with([](int k) { return 1e6 * k; }, tension).find("is more than this specimen bears"),
            std::string::npos);
  EXPECT_NE(with([](int k) { return k == 30 ? 1e3 : 2.0 * k; }, tension)
                .find("pull.csv:32: force: 1000 N lies far"),
            std::string::npos);
  const std::string still = "Time (s),Extension (mm),Load (N)\n";
  std::string text = still;
  for (int k = 0; k < 20; ++k) text += "0,1,1\n";
  write("pull.csv", text);
  const TestsReading reading = read(tension);
  ASSERT_EQ(reading.errors.size(), 1U) << "what follows from the first fault is not said";
  EXPECT_NE(reading.errors.front().text().find("pull.csv:3: time: does not increase"), std::string::npos);
  EXPECT_NE(
      error(R"("tension": [{"file": "pull.csv", "width": "1 um", "height": "150 mm", "rate": "2 mm/min"}])")
          .find("/tension/0/width: \"1 um\": is less than 0.02 of the height"),
      std::string::npos);
}

TEST_F(TestsFile, RefusesTipsThatDoNotMove) {
  const char* const strip = R"("cantilever": [{"length": "150 mm", "width": "25 mm", "file": "tip.csv"}])";
  for (const auto& [factor, unit, reason] : {std::tuple(0.0, 1.0, "too little to be measured"),
                                             {1.0, 1e9, "s after the first row: the wrong unit"}}) {
    std::string text = "Time (s);Deflection (mm)\n";
    for (int k = 0; k < 20; ++k) text += fmt::format("{};{}\n", unit * k, factor * std::sqrt(k) * 10);
    write("tip.csv", text);
    EXPECT_NE(error(strip).find(reason), std::string::npos) << error(strip);
  }
}

}  // namespace
}  // namespace drapeplan
