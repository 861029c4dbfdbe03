#include "planner/tables/curve_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <random>

namespace drapeplan {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

CurveReading read(const std::string& text, Dimension abscissa = Dimension::strain, const CurveColumns& columns = {}) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("curve_file_test_" + std::to_string(::getpid()) + ".csv");
  std::ofstream(file, std::ios::binary) << text;
  CurveReading reading = read_curve(file, abscissa, columns);
  std::filesystem::remove(file);
  return reading;
}

/// Rows of a record: strain in per cent, stress in MPa.
std::string record(int rows, double longest, const std::function<double(double)>& stress) {
  std::string text = "Strain (%),Stress (MPa)\n";
  for (int k = 0; k < rows; ++k) {
    const double strain = longest * k / (rows - 1);
    text += std::to_string(strain) + "," + std::to_string(stress(strain)) + "\n";
  }
  return text;
}

std::string error(const CurveReading& reading) {
  return reading.errors.empty() ? std::string("none") : reading.errors.front().text();
}

TEST(CurveFile, FewRowsAreTheCurve) {
  const CurveReading stated = read("Dehnung [%];Spannung [N/mm^2]\n0;0\n0,1;5,5\n0,67;66,7\n");
  ASSERT_EQ(error(stated), "none");
  EXPECT_EQ(stated.curve.strain, (std::vector<double>{0, 0.1 / 1e2, 0.67 / 1e2}));
  EXPECT_EQ(stated.curve.stress, (std::vector<double>{0, 5.5e6, 66.7 * 1e6}));
  EXPECT_EQ(stated.fit.knots, 0U);
  // Without a row at rest it is put in front; shear has angles, in any unit.
  const CurveReading shear = read("gamma,tau\nrad,kPa\n0.1,20\n0.5,30\n", Dimension::angle);
  ASSERT_EQ(error(shear), "none");
  EXPECT_EQ(shear.curve.strain, (std::vector<double>{0, 0.1, 0.5}));
  EXPECT_EQ(shear.curve.stress, (std::vector<double>{0, 20e3, 30e3}));
  const CurveReading named = read("a [1],b [GPa]\n0.01,0.5\n0.02,1\n", Dimension::strain, {"a", "b"});
  ASSERT_EQ(error(named), "none");
  EXPECT_EQ(named.curve.stress.back(), 1e9);
}

TEST(CurveFile, NoiseIsSmoothedAndItsSizeIsSaid) {
  // Steep, flat, steep: a shear curve, with noise of 2 % of its largest stress.
  const auto truth = [](double angle) { return 0.1 * std::tanh(angle / 5) + 0.9 * std::pow(angle / 50, 8); };
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.02);
  std::string text = "angle (deg);shear stress (MPa)\n";
  for (int k = 0; k <= 600; ++k) {
    const double angle = 50.0 * k / 600;
    text += std::to_string(angle) + ";" + std::to_string(truth(angle) + noise(random)) + "\n";
  }
  const CurveReading reading = read(text, Dimension::angle);
  ASSERT_EQ(error(reading), "none");
  EXPECT_NEAR(reading.fit.residual, 0.02, 0.002) << "the noise, and nothing else";
  EXPECT_GE(reading.fit.knots, 8U);
  EXPECT_LE(reading.fit.knots, 32U);
  EXPECT_EQ(reading.curve.stress.front(), 0);
  for (size_t k = 1; k < reading.curve.stress.size(); ++k)
    EXPECT_GE(reading.curve.stress[k], reading.curve.stress[k - 1]);
  for (double angle = 2; angle < 50; angle += 1)
    EXPECT_NEAR(1e-6 * reading.curve(angle * kDegree), truth(angle), 0.02) << angle;
  EXPECT_EQ(fit_text("shear.csv", {601, 16, 0.0123}),
            "shear.csv: 601 rows, smoothed to 16 knots; it misses them by 1.2 % of the largest stress (r.m.s.)");
}

TEST(CurveFile, ManyRowsWithoutNoiseAreMetClosely) {
  const CurveReading reading = read(record(3000, 0.67, [](double e) { return 66.7 * std::pow(e / 0.67, 1.3); }));
  ASSERT_EQ(error(reading), "none");
  EXPECT_LE(reading.fit.residual, 1e-3);
  EXPECT_LE(reading.fit.knots, 64U);
}

TEST(CurveFile, SaysWhatIsWrongAndWhere) {
  const std::string head = "Strain (%),Stress (MPa)\n";
  const auto wrong = [&](const std::string& text) { return error(read(text)); };
  EXPECT_NE(error(read_curve("/there/is/none.csv", Dimension::strain, {})).find("cannot be read"), std::string::npos);
  EXPECT_NE(wrong(head + "0,0\n0.1,5\n0.05,6\n").find(".csv:4: strain: goes back from 0.1 % to 0.05 %"),
            std::string::npos);
  EXPECT_NE(wrong(head + "0,0\n0.1,5\n0.1,6\n").find(".csv:4: strain: does not grow"), std::string::npos);
  EXPECT_NE(wrong(head + "0,0\n0.1,5\n0.2,4.9\n").find(".csv:4: stress: falls from 5 MPa to 4.9 MPa"),
            std::string::npos);
  EXPECT_NE(wrong(head + "0,2\n0.1,5\n0.2,6\n").find(".csv:2: stress: is 2 MPa at no strain"), std::string::npos);
  EXPECT_NE(wrong(head + "0,0\n-0.1,-5\n-0.2,-6\n").find("magnitudes"), std::string::npos);
  EXPECT_NE(wrong(head + "0,0\n0.1,0\n").find("nowhere above zero"), std::string::npos);
  EXPECT_NE(wrong("Strain,Stress (MPa)\n0,0\n0.1,5\n").find(":1: Strain: has no unit"), std::string::npos);
  EXPECT_NE(wrong("Strain (%),Force (N)\n0,0\n0.1,5\n").find("no row names columns for the strain"),
            std::string::npos);
  // A specimen that fails: the row at the top is named.
  const auto fails = [](double e) { return e < 0.5 ? 100 * e : 100 * (1 - e); };
  EXPECT_NE(wrong(record(201, 0.8, fails)).find("a curve must not fall; end the table where"), std::string::npos);
  // Two specimens one after another are out of order; mixed row by row they are no curve.
  const std::string one = record(50, 0.5, [](double e) { return 100 * e; });
  EXPECT_NE(wrong(one + one.substr(one.find('\n') + 1)).find(".csv:52: strain: goes back from 0.5 %"), std::string::npos);
  // A record that goes on while the specimen is unloaded, step by step.
  std::string unloaded = one;
  for (int k = 48; k >= 0; --k) unloaded += std::to_string(0.5 * k / 49) + "," + std::to_string(k) + "\n";
  EXPECT_NE(wrong(unloaded).find(".csv:52: strain: goes back from 0.5 % to 0.4898 %"), std::string::npos)
      << wrong(unloaded);
  int row = 0;
  EXPECT_NE(wrong(record(400, 0.5, [&](double e) { return ++row % 2 == 0 ? 100 * e : 10 * e; })).find("no curve fits"),
            std::string::npos);
}

}  // namespace
}  // namespace drapeplan
