#include "planner/case/file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "planner/base/quantity.hpp"
#include "tests/mapping/molds.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path kCases = fs::path(DRAPEPLAN_SOURCE_DIR) / "cases";
const fs::path kBadCases = fs::path(DRAPEPLAN_SOURCE_DIR) / "tests/bad_cases";

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A scratch file of this process that goes away.
struct ScratchFile {
  fs::path path;
  explicit ScratchFile(const std::string& text)
      : path(fs::path(testing::TempDir()) / ("case_file_test_" + std::to_string(::getpid()) + ".json")) {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~ScratchFile() { fs::remove(path); }
};

std::string all_text(const std::vector<InputError>& errors) {
  std::string text;
  for (const InputError& error : errors) text += error.text() + '\n';
  return text;
}

Case good_case(const fs::path& file, const std::vector<std::string>& overrides = {}) {
  CaseReading reading = read_case(file, overrides);
  EXPECT_TRUE(reading.errors.empty()) << all_text(reading.errors);
  return std::move(reading.definition);
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(CaseFile, EveryCaseOfTheProjectIsGoodAndEchoesToTheSameEcho) {
  const auto files = files_in(kCases);
  ASSERT_GE(files.size(), 6U);
  for (const fs::path& file : files) {
    const json resolved = resolved_case(good_case(file));
    const ScratchFile echo(resolved.dump(2));
    const json again = resolved_case(good_case(echo.path));
    EXPECT_EQ(resolved, again) << file << "\n" << json::diff(resolved, again).dump(1);
  }
}

TEST(CaseFile, TheEchoKeepsEveryBit) {
  const std::vector<std::string> awkward{"ply.width=\"0.40500000000000003 m\"",
                                         "ply.angle=\"0.1 rad\"",
                                         "grippers.tilt_limit=\"59.99999999999999 deg\"",
                                         "score.locking_angle=\"0.7 rad\"",
                                         "friction.coefficient=0.1",
                                         "material.compression.factor=0.0531"};
  const Case first = good_case(kCases / "flexdraper-5x5.json", awkward);
  const ScratchFile echo(resolved_case(first).dump());
  const Case second = good_case(echo.path);
  EXPECT_EQ(first.ply.width, second.ply.width);
  EXPECT_EQ(first.ply.angle, second.ply.angle);
  EXPECT_EQ(first.grippers->tilt_limit, second.grippers->tilt_limit);
  EXPECT_EQ(first.score.locking_angle_deg, second.score.locking_angle_deg);
  EXPECT_EQ(*first.friction, *second.friction);
  EXPECT_EQ(first.material.compression.slowest().stress, second.material.compression.slowest().stress);
  EXPECT_EQ(first.material.tension.slowest().strain, second.material.tension.slowest().strain);
  EXPECT_EQ(first.material.shear.slowest().strain, second.material.shear.slowest().strain);
  EXPECT_EQ(first.material.shear.slowest().stress, second.material.shear.slowest().stress);
}

TEST(CaseFile, TheFlexdraperCaseHoldsWhatThePaperSays) {
  const Case definition = good_case(kCases / "flexdraper-5x5.json");
  EXPECT_EQ(definition.material.thickness, 0.3e-3);
  EXPECT_EQ(definition.material.areal_density, 0.314);
  EXPECT_NEAR(definition.material.tension.slowest()(0.0067), 66.7e6, 1);
  EXPECT_EQ(definition.ply.width, 0.405);
  EXPECT_EQ(*definition.friction, 1.5);
  EXPECT_EQ(*definition.damping, 22);
  EXPECT_EQ(*definition.gravity, 9.81);
  ASSERT_TRUE(definition.grippers && definition.mold && definition.mapping);
  EXPECT_EQ(definition.grippers->count(), 25);
  EXPECT_EQ(definition.grippers->fixed, (std::array<int, 2>{3, 3}));
  const CurvatureRange range = gaussian_curvature_range(*definition.mold);
  EXPECT_NEAR(range.smallest, -25.46, 0.01);
  EXPECT_NEAR(range.largest, 23.41, 0.01);
  EXPECT_EQ(definition.fidelities.at("report").mesh_size, 0.0075);
  EXPECT_GT(definition.fidelities.at("search").time_scaling, definition.fidelities.at("report").time_scaling);
  EXPECT_EQ(definition.fidelities.at("search").section_points,
            definition.fidelities.at("report").section_points);
}

TEST(CaseFile, InterlinksAreTrueOrFalseOrSayWhatTheyAre) {
  const auto with = [](const std::string& value) {
    return good_case(kCases / "flexdraper-quick.json", {"grippers.interlinks=" + value});
  };
  EXPECT_FALSE(with("false").grippers->interlinks);
  const Case plain = with("true"), absent = with("null");
  for (const Case& one : {plain, absent}) {
    ASSERT_TRUE(one.grippers->interlinks);
    EXPECT_TRUE(one.grippers->interlinks->lengths.empty() && !one.grippers->interlinks->has_play());
  }
  const Case same = with(R"({"length": "98 mm", "closing": [0.2, 0.5], "play": ["1 mm", "2 mm"]})");
  EXPECT_EQ(same.grippers->interlinks->lengths, std::vector<double>(12, 0.098));
  const double preshape = same.schedule.preshape_duration;
  EXPECT_EQ(same.grippers->interlinks->closing, Eigen::Vector2d(0.2 * preshape, 0.5 * preshape));
  EXPECT_EQ(same.grippers->interlinks->play, Eigen::Vector2d(0.001, 0.002));
  const std::string rows = R"([[["97 mm", "98 mm"], ["97 mm", "98 mm"], ["97 mm", "98 mm"]],
                               [["95 mm", "96 mm", "97 mm"], ["95 mm", "96 mm", "97 mm"]]])";
  const Case each = with(R"({"length": )" + rows + R"(, "stiffness": "20 N/mm"})");
  const std::vector<double> along{0.097, 0.098, 0.097, 0.098, 0.097, 0.098,
                                  0.095, 0.096, 0.097, 0.095, 0.096, 0.097};
  EXPECT_EQ(each.grippers->interlinks->lengths, along);
  EXPECT_EQ(each.grippers->interlinks->stiffness, 2e4);
  const Case mapped = with(R"({"length": "mapped"})");
  EXPECT_TRUE(mapped.grippers->interlinks->lengths.empty()) << "known once the ply is mapped";
  for (const Case& one : {same, each, mapped, with("false")}) {
    const ScratchFile echo(resolved_case(one).dump());
    EXPECT_EQ(resolved_case(good_case(echo.path)), resolved_case(one));
  }
}

TEST(CaseFile, AnAbsentSectionIsAbsentPhysics) {
  const Case definition = good_case(kCases / "sphere-mapping.json");
  EXPECT_FALSE(definition.grippers || definition.gravity || definition.damping || definition.friction);
  EXPECT_EQ(definition.material.thickness, 0);
  const json resolved = resolved_case(definition);
  for (const char* absent : {"grippers", "gravity", "material", "fem", "schedule", "optimise", "probes"}) {
    EXPECT_FALSE(resolved.contains(absent)) << absent;
  }
}

TEST(CaseFile, MappingStartsUnderThePlyUnlessToldOtherwise) {
  const Case definition = good_case(kCases / "flexdraper-5x5.json", {"mapping.start=null"});
  EXPECT_EQ(definition.mapping->start, definition.ply.position);
}

TEST(CaseFile, OverridesReachReferencedFiles) {
  const Case definition =
      good_case(kCases / "cantilever-150.json", {"material.thickness=0.4 mm", "gravity=null"});
  EXPECT_EQ(definition.material.thickness, 0.4e-3);
  EXPECT_FALSE(definition.gravity);
  const Case linear = good_case(kCases / "elastica.json", {"material.modulus=\"0.7 GPa\""});
  EXPECT_EQ(linear.material.tension.slowest()(0.01), 0.7e7);
  EXPECT_EQ(linear.material.compression.slowest()(0.01), 0.7e7);
  EXPECT_EQ(linear.material.shear.slowest()(0.5), 0.5 * 1e6);
  EXPECT_EQ(resolved_case(linear)["material"]["modulus"], "700 MPa");
}

TEST(CaseFile, FemIsTheReportingFidelityAndTheStartOfTheOthers) {
  const Case definition =
      good_case(kCases / "flexdraper-5x5.json",
                {"fem.mesh_size=12 mm", "fem.section_points=5", "fidelities.screen.mesh_size=20 mm"});
  EXPECT_EQ(definition.fidelities.at("report").mesh_size, 0.012);
  EXPECT_EQ(definition.fidelities.at("screen").mesh_size, 0.020);
  EXPECT_EQ(definition.fidelities.at("screen").section_points, 5);
}

TEST(CaseFile, FidelitiesMayHaveAnyName) {
  Case definition = good_case(kCases / "flexdraper-5x5.json");
  definition.fidelities["~2/a.b \xc3\xa9"].mesh_size = 0.02;
  definition.material.shear.curves[0].stress[1] = 1e-310;  // denormal: text must not refuse it
  const ScratchFile echo(resolved_case(definition).dump());
  EXPECT_EQ(good_case(echo.path).fidelities.at("~2/a.b \xc3\xa9").mesh_size, 0.02);
  EXPECT_EQ(good_case(echo.path).material.shear.slowest().stress[1], 1e-310);
}

TEST(CaseFile, APolynomialMayBeStatedInMillimetres) {
  // z/mm = 0.01 (x/mm)^2 is z = 10/m x^2.
  const Case definition =
      good_case(kCases / "flexdraper-5x5.json",
                {"mold.unit=1 mm", "mold.terms=[{\"x\":2,\"y\":0,\"coefficient\":0.01}]"});
  EXPECT_NEAR(definition.mold->height(0.1, 0.3), 0.1, 1e-15);
}

TEST(CaseFile, AWrongOverrideIsNamedInTheError) {
  const auto wrong = [](const std::string& text) {
    const CaseReading reading = read_case(kCases / "flexdraper-5x5.json", {text});
    return reading.errors.size() == 1 ? reading.errors.front().text() : "not one error";
  };
  EXPECT_EQ(wrong("ply.width=3"),
            "--set ply.width=3: /ply/width: 3: a bare number has no unit; expected a length "
            "as text, e.g. \"0.3 mm\"");
  EXPECT_EQ(wrong("pli.width=3"), "--set pli.width=3: /pli: unknown key \"pli\"; did you mean \"ply\"?");
  EXPECT_NE(wrong("nothing").find("expected path=value"), std::string::npos);
  EXPECT_NE(wrong("=3").find("expected path=value"), std::string::npos);
  EXPECT_NE(wrong("ply.position.7=\"1 mm\"").find("no index"), std::string::npos);
  EXPECT_NE(wrong("name.first=x").find("below a value"), std::string::npos);
}

TEST(CaseFile, ABadMaterialFileIsNamedWithItsOwnLineAndPath) {
  const ScratchFile material(
      "{\n  \"law\": \"linear\",\n  \"thickness\": \"0.3 mm\",\n  \"modulus\": 7\n}\n");
  const CaseReading reading =
      read_case(kCases / "elastica.json", {"material=\"" + material.path.string() + "\""});
  const std::string text = all_text(reading.errors);
  EXPECT_NE(text.find(material.path.string() + ":4: /modulus: 7: a bare number"), std::string::npos) << text;
  EXPECT_NE(text.find(material.path.string() + ":1: \"areal_density\" is missing"), std::string::npos)
      << text;
}

/// Every bad case stands beside the parts of the message that it must give.
TEST(CaseFile, EveryBadCaseGivesTheMessageExpected) {
  int compared = 0;
  for (const fs::path& file : files_in(kBadCases)) {
    const CaseReading reading = read_case(file);
    const std::string text = all_text(reading.errors);
    EXPECT_FALSE(reading.errors.empty()) << file;
    std::istringstream expected(text_of(fs::path(file).replace_extension(".expected")));
    for (std::string line; std::getline(expected, line);) {
      EXPECT_NE(text.find(line), std::string::npos) << file << "\nexpected: " << line << "\ngot:\n" << text;
      ++compared;
    }
    for (const InputError& error : reading.errors)
      EXPECT_TRUE(error.file.ends_with(".json") || error.file.ends_with(".csv")) << error.text();
  }
  EXPECT_GE(compared, 35);
}

TEST(CaseFile, ErrorsStandInTheOrderOfTheFile) {
  const CaseReading reading = read_case(kBadCases / "five_errors.json");
  ASSERT_EQ(reading.errors.size(), 5U) << all_text(reading.errors);
  for (size_t k = 1; k < reading.errors.size(); ++k)
    EXPECT_LE(reading.errors[k - 1].line, reading.errors[k].line);
  EXPECT_GT(reading.errors.front().line, 0);
}

TEST(CaseFile, AMissingFileIsAnErrorWithItsName) {
  const CaseReading reading = read_case("no/such/case.json");
  ASSERT_EQ(reading.errors.size(), 1U);
  EXPECT_EQ(reading.errors[0].text(), "no/such/case.json: cannot be read: No such file or directory");
  EXPECT_EQ(read_case(kCases).errors.size(), 1U);  // a folder
}

TEST(Quantity, NumbersAreTheNearestDoublesOfTheDecimal) {
  std::string fault;
  EXPECT_EQ(parse_quantity("0.3 mm", Dimension::length, fault), 0.0003);
  EXPECT_EQ(parse_quantity("9 mm", Dimension::length, fault), 9 / 1e3);  // unlike 9 * 1e-3
  EXPECT_EQ(parse_quantity("314 g/m^2", Dimension::areal_density, fault), 0.314);
  EXPECT_EQ(parse_quantity("10N/mm", Dimension::line_stiffness, fault), 1e4);
  EXPECT_EQ(parse_quantity("+1.2e-3 m", Dimension::length, fault), 0.0012);
  EXPECT_EQ(parse_quantity("0.2 GPa", Dimension::stress, fault), 2e8);
  EXPECT_FALSE(parse_quantity("inf m", Dimension::length, fault));
  EXPECT_FALSE(parse_quantity("1e308 GPa", Dimension::stress, fault));
  EXPECT_FALSE(parse_quantity("", Dimension::length, fault));
  EXPECT_FALSE(parse_quantity("+-1 m", Dimension::length, fault));
  EXPECT_FALSE(parse_quantity("0x10 m", Dimension::length, fault));
}

TEST(Quantity, TextAndBackKeepsEveryBit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-12, 12), mantissa(-10, 10);
  for (const Dimension dimension :
       {Dimension::length, Dimension::angle, Dimension::degrees, Dimension::stress, Dimension::areal_density,
        Dimension::velocity, Dimension::rate}) {
    for (int k = 0; k < 2000; ++k) {
      const double value = mantissa(random) * std::pow(10, exponent(random));
      std::string fault;
      ASSERT_EQ(parse_quantity(format_quantity(value, dimension), dimension, fault), value) << fault;
    }
  }
  EXPECT_EQ(format_quantity(0.0003, Dimension::length), "0.3 mm");
  EXPECT_EQ(format_quantity(0, Dimension::length), "0 mm");
}

TEST(Schema, StatesUnitsRangesAndDefaults) {
  const json schema = case_schema();
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  const json& offset = schema["properties"]["grippers"]["properties"]["joint_offset"];
  EXPECT_EQ(offset["default"], "5 mm");
  EXPECT_EQ(offset["x-allowed"], ">= 0 mm and <= 1000 mm");
  EXPECT_EQ(schema["dependentRequired"]["grippers"], (json{"mold", "mapping", "material"}));
  EXPECT_EQ(schema["properties"]["fem"]["properties"]["section_points"]["enum"], (json{1, 3, 5}));
}

TEST(Explain, TellsMeaningUnitRangeAndDefault) {
  std::string nearest;
  const std::string text = explain_field("grippers.joint_offset", nearest);
  for (const char* part : {"joint above the ply", "a length", ">= 0 mm", "default: \"5 mm\""}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  EXPECT_NE(explain_field("fidelities.screen.mesh_size", nearest).find("element edge"), std::string::npos);
  EXPECT_NE(explain_field("probes.0.place", nearest).find("In the ply"), std::string::npos);
  EXPECT_NE(explain_field("grippers", nearest).find("grippers.spacing"), std::string::npos);
  EXPECT_NE(explain_field("material.modulus", nearest).find("only if: law = linear"), std::string::npos);
  EXPECT_TRUE(explain_field("gripers.joint_ofset", nearest).empty());
  EXPECT_EQ(nearest, "grippers.joint_offset");
  EXPECT_TRUE(explain_field("", nearest).empty());
}

}  // namespace
}  // namespace drapeplan
