// Curves of a material from tables, how far they hold, and the materials that are shipped.
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "planner/case/file.hpp"
#include "planner/drape/run_checks.hpp"
#include "planner/search/plan.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const fs::path kCases = fs::path(DRAPEPLAN_SOURCE_DIR) / "cases";

std::string all_text(const std::vector<InputError>& errors) {
  std::string text;
  for (const InputError& error : errors) text += error.text() + '\n';
  return text;
}

/// A case in one folder, its material in another one, and the material's tables beside it.
class MaterialFolder : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::path(testing::TempDir()) / ("materials_test_" + std::to_string(::getpid()));
    fs::create_directories(root_ / "materials");
    write("materials/tension.csv", "Strain (%);Stress (MPa)\n0;0\n0,1;5,6264\n0,67;66,7\n");
    material_ = {{"law", "tables"},
                 {"thickness", "0.3 mm"},
                 {"areal_density", "314 g/m^2"},
                 {"transverse_shear_modulus", "0.2 MPa"},
                 {"tension", {{"file", "tension.csv"}, {"source", "Pulled"}, {"valid_to", "0.67 %"}, {"band", 0.03}}},
                 {"compression", {{"points", {{"%", "MPa"}, {0, 0}, {1, 5}}}}},
                 {"shear", {{"points", {{"deg", "MPa"}, {0, 0}, {50, 1}}}, {"valid_to", "30 deg"}}}};
    case_ = {{"format", "drapeplan-case 1"},
             {"name", "strip"},
             {"ply", {{"width", "150 mm"}, {"height", "25 mm"}}},
             {"material", "materials/own.json"},
             {"duration", "1 s"}};
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root_ / name, std::ios::binary) << text;
  }
  CaseReading read(const std::vector<std::string>& overrides = {}) const {
    write("materials/own.json", material_.dump(1));
    write("case.json", case_.dump(1));
    return read_case(root_ / "case.json", overrides);
  }

  fs::path root_;
  json material_, case_;
};

TEST_F(MaterialFolder, TablesLieBesideTheFileThatNamesThem) {
  const CaseReading reading = read();
  ASSERT_TRUE(reading.errors.empty()) << all_text(reading.errors);
  EXPECT_TRUE(reading.notes.empty()) << "nothing was smoothed";
  EXPECT_EQ(reading.definition.material.tension.slowest().stress.back(), 66.7 * 1e6);
  EXPECT_EQ(reading.definition.material_notes.tension.source,
            "Pulled. Points: tension.csv: 3 rows, taken as they are");
  // An override names files beside the case.
  write("other.csv", "Strain (%);Stress (MPa)\n0;0\n1;7\n");
  const CaseReading other = read({"material.tension.file=other.csv"});
  ASSERT_TRUE(other.errors.empty()) << all_text(other.errors);
  EXPECT_EQ(other.definition.material.tension.slowest().stress.back(), 7e6);
}

TEST_F(MaterialFolder, TheResolvedCaseHoldsTheCurveAndItsNotes) {
  const Case definition = read().definition;
  const json resolved = resolved_case(definition);
  const json& tension = resolved["material"]["tension"];
  EXPECT_FALSE(tension.contains("file"));
  EXPECT_FALSE(tension.contains("columns"));
  EXPECT_EQ(tension["points"][2], json({0.1, 5.6264}));
  EXPECT_EQ(tension["valid_to"], "0.67 %");
  EXPECT_EQ(tension["band"], 0.03);
  EXPECT_EQ(resolved["material"]["shear"]["valid_to"], "30 deg");
  fs::remove(root_ / "materials/tension.csv");
  write("resolved.json", resolved.dump());
  const CaseReading again = read_case(root_ / "resolved.json");
  ASSERT_TRUE(again.errors.empty()) << all_text(again.errors);
  EXPECT_EQ(resolved_case(again.definition), resolved);
}

TEST_F(MaterialFolder, TheHashFollowsTheCurveAndNotItsFile) {
  const std::uint64_t hash = case_hash(read().definition);
  fs::rename(root_ / "materials/tension.csv", root_ / "materials/renamed.csv");
  material_["tension"]["file"] = "../materials/renamed.csv";
  material_["tension"]["valid_to"] = "0.5 %";
  material_["tension"]["band"] = 0.1;
  EXPECT_EQ(case_hash(read().definition), hash);
  write("materials/renamed.csv", "Strain (%);Stress (MPa)\n0;0\n0,1;5,6264\n0,67;66,8\n");
  EXPECT_NE(case_hash(read().definition), hash);
}

TEST_F(MaterialFolder, EveryRateMayHaveATableOfItsOwn) {
  write("materials/slow.csv", "angle (deg),stress (kPa)\n0,0\n10,20\n50,900\n");
  write("materials/fast.csv", "angle (deg),stress (kPa)\n0,0\n10,40\n50,999\n");
  material_["shear"] = {{"rates",
                         {{{"rate", "1e-3 1/s"}, {"file", "slow.csv"}},
                          {{"rate", "1e-2 1/s"}, {"file", "fast.csv"}, {"factor", 2}}}}};
  const CaseReading reading = read();
  ASSERT_TRUE(reading.errors.empty()) << all_text(reading.errors);
  const StressTable& shear = reading.definition.material.shear;
  ASSERT_EQ(shear.curves.size(), 2U);
  EXPECT_EQ(shear.curves[0].stress.back(), 900e3);
  EXPECT_EQ(shear.curves[1].stress.back(), 2 * 999e3);
}

TEST_F(MaterialFolder, NoiseIsNotedWithWhatTheCurveMisses) {
  std::string text = "Strain (%),Stress (MPa)\n";
  for (int k = 0; k <= 200; ++k)
    text += std::to_string(0.005 * k) + "," + std::to_string(0.3 * k + (k % 2 == 0 ? 0.6 : -0.6)) + "\n";
  write("materials/tension.csv", text);
  const CaseReading reading = read();
  ASSERT_TRUE(reading.errors.empty()) << all_text(reading.errors);
  ASSERT_EQ(reading.notes.size(), 1U);
  EXPECT_NE(reading.notes.front().find("/material/tension: tension.csv: 201 rows, smoothed to 8 knots; it misses them "
                                       "by 0.99 % of the largest stress"),
            std::string::npos)
      << reading.notes.front();
  EXPECT_NE(reading.definition.material_notes.tension.source.find("smoothed to 8 knots"), std::string::npos);
}

TEST_F(MaterialFolder, WrongTablesAreNamedWithFileAndLine) {
  const auto errors = [&] { return all_text(read().errors); };
  write("materials/tension.csv", "Strain (%);Stress (MPa)\n0;0\n0,1;5\n0,2;4\n");
  EXPECT_NE(errors().find("materials/tension.csv:4: stress: falls"), std::string::npos) << errors();
  material_["tension"]["file"] = "gone.csv";
  EXPECT_NE(errors().find("materials/gone.csv: cannot be read"), std::string::npos) << errors();
  material_["tension"].erase("file");
  EXPECT_NE(errors().find("/tension: \"points\" is missing; a curve has either points or a file"), std::string::npos)
      << errors();
  material_["tension"]["file"] = "tension.csv";
  material_["tension"]["points"] = {{"%", "MPa"}, {0, 0}, {1, 5}};
  EXPECT_NE(errors().find("/tension/file: \"tension.csv\": belongs to a curve without points"), std::string::npos)
      << errors();
  material_["tension"].erase("points");
  write("materials/tension.csv", "Strain (1);Stress (MPa)\n0;0\n2;5\n");
  EXPECT_NE(errors().find("/tension/file: \"tension.csv\": reaches beyond a strain of 100 %"), std::string::npos)
      << errors();
}

TEST(RangeWarnings, NameTheCurvesThatADrapeLeft) {
  MaterialNotes notes;
  Score score;
  score.valid = true;
  score.max_shear_deg = 33.21;
  score.max_fibre_strain = 0.008;
  EXPECT_TRUE(range_warnings(notes, score).empty());
  notes.shear.valid_to = 30 * std::numbers::pi / 180;
  notes.tension.valid_to = 0.0067;
  notes.compression.valid_to = 0.01;
  EXPECT_EQ(range_warnings(notes, score),
            (std::vector<std::string>{
                "the largest shear is 33.2 deg, beyond what material.shear holds for (30.0 deg)",
                "the largest fibre tension is 0.8 %, beyond what material.tension holds for (0.67 %)"}));
  score.valid = false;
  EXPECT_TRUE(range_warnings(notes, score).empty());
}

TEST(ShippedMaterials, AreGoodInACaseAndNameTheirSources) {
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(kCases / "materials")) {
    if (entry.path().extension() != ".json") continue;
    ++count;
    const std::string file = "materials/" + entry.path().filename().string();
    const CaseReading reading = read_case(kCases / "flexdraper-quick.json", {"material=" + file});
    EXPECT_TRUE(reading.errors.empty()) << all_text(reading.errors);
    const MaterialNotes& notes = reading.definition.material_notes;
    EXPECT_FALSE(notes.name.empty()) << file;
    EXPECT_FALSE(notes.source.empty()) << file;
    for (const CurveNotes* curve : {&notes.tension, &notes.compression, &notes.shear}) {
      const bool says = curve->source.find("Measured") != std::string::npos ||
                        curve->source.find("Published") != std::string::npos ||
                        curve->source.find("Assumed") != std::string::npos;
      EXPECT_TRUE(says) << file << ": " << curve->source;
    }
    std::ifstream readme(kCases / "README.md");
    const std::string text{std::istreambuf_iterator<char>(readme), {}};
    EXPECT_NE(text.find("`materials/" + entry.path().stem().string() + "`"), std::string::npos)
        << file << " is missing in cases/README.md";
  }
  EXPECT_GE(count, 4U);
}

}  // namespace
}  // namespace drapeplan
