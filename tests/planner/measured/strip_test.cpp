// Pictures of strips, and the shapes, strains and rates that are read from them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "mapping/error.hpp"
#include "planner/case/fields.hpp"
#include "planner/measured/strip_image.hpp"
#include "planner/measured/strip_shape.hpp"

namespace drapeplan {
namespace {

constexpr double kScale = 2e-4;  // [m] per pixel

/// A bright strip, four pixels thick, along y = shape(x) from column 20 on, with dirt beside it.
GreyImage drawn(const std::function<double(double)>& shape, int columns, bool dark = false) {
  GreyImage image{900, 600, std::vector<std::uint8_t>(900 * 600, dark ? 230 : 20)};
  const auto dot = [&](int column, int row) {
    if (row >= 0 && row < image.height) image.levels[size_t(row * image.width + column)] = dark ? 20 : 230;
  };
  for (int k = 0; k < columns; ++k) {
    const int middle = int(std::lround(50 - shape(k * kScale) / kScale));
    for (int row = middle - 2; row <= middle + 2; ++row) dot(20 + k, row);
  }
  for (int k = 0; k < 5; ++k) dot(700 + k, 500);
  return image;
}

double parabola(double x) {
  return -3 * x * x;
}

TEST(StripImage, HasTheMiddleOfTheStrip) {
  for (const bool dark : {false, true}) {
    const auto line = strip_midline(drawn(parabola, 600, dark), {.scale = kScale, .dark = dark});
    ASSERT_EQ(line.size(), 600U);
    EXPECT_EQ(line.front(), Eigen::Vector2d(0, 0));
    for (const Eigen::Vector2d& point : line) EXPECT_NEAR(point.y(), parabola(point.x()), 0.6 * kScale);
  }
}

TEST(StripImage, ReadsAPgmFileAndSaysWhatIsWrong) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("strip_" + std::to_string(::getpid()) + ".pgm");
  const GreyImage image = drawn(parabola, 600);
  std::ofstream(file, std::ios::binary) << "P5 900 600 255\n"
                                        << std::string(image.levels.begin(), image.levels.end());
  EXPECT_EQ(read_image(file).levels, image.levels);
  const auto reason = [](const std::function<void()>& call) {
    try {
      call();
    } catch (const WrongInput& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(reason([&] { (void)read_image(file.string() + ".none"); }).find("cannot be read as an image"),
            std::string::npos);
  const auto written = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return reason([&] { (void)read_image(file); });
  };
  EXPECT_NE(written("P5 # a comment\n900 600 255\n" + std::string(900 * 599, 'a')).find("it is cut off"),
            std::string::npos);
  EXPECT_NE(written("P5 30000 30000 255\nabc").find("it is cut off"), std::string::npos);
  EXPECT_NE(
      written("P5 900 600 65535\n" + std::string(2 * 900 * 600, 'a')).find("white is 65535; expected 255"),
      std::string::npos);
  EXPECT_NE(written("P6 10 10 255\n" + std::string(100, 'a')).find("it is cut off"), std::string::npos);
  EXPECT_NE(written("P5 7").find("white is 0"), std::string::npos);
  EXPECT_NE(written("\xFF\xD8\xFF\xDA" + std::string(100, 'a')).find("it is cut off"), std::string::npos);
  EXPECT_NE(reason([] { (void)read_image("/dev/zero"); }).find("no regular file"), std::string::npos);
  GreyImage cut = image;
  cut.height = 200;
  EXPECT_NE(reason([&] { strip_midline(cut, {.scale = kScale}); }).find("reaches the lower edge"),
            std::string::npos);
  const GreyImage black{900, 600, std::vector<std::uint8_t>(900 * 600, 10)};
  EXPECT_NE(reason([&] { strip_midline(black, {.scale = kScale}); }).find("shows no strip: nothing"),
            std::string::npos);
  EXPECT_NE(reason([&] { strip_midline(black, {.scale = kScale, .dark = true}); }).find("more than half"),
            std::string::npos);
  GreyImage two = image;
  for (int k = 0; k < 500; ++k) {
    for (int row = 400; row < 405; ++row) two.levels[size_t(row * 900 + 100 + k)] = 230;
  }
  EXPECT_NE(reason([&] { strip_midline(two, {.scale = kScale}); }).find("two strips"), std::string::npos);
}

TEST(StripShape, FindsAQuarticItsCurvatureAndItsStrain) {
  const auto quartic = [](double x) { return -0.2 * x - 1.5 * x * x - 6 * x * x * x + 20 * x * x * x * x; };
  std::vector<Eigen::Vector2d> line;
  for (int k = 0; k <= 100; ++k) line.emplace_back(0.0012 * k, quartic(0.0012 * k));
  const StripShape shape = strip_shape(line, 0.4);
  EXPECT_NEAR(shape.tip(), -quartic(0.12), 1e-12);
  EXPECT_NEAR(shape.slope(0), -0.2, 1e-9);
  EXPECT_NEAR(shape.curvature(0), -3 / std::pow(1 + 0.04, 1.5), 1e-7);
  EXPECT_NEAR(outer_strain(shape, 0, 3e-4), 1.5e-4 * 3 / std::pow(1.04, 1.5), 1e-9);
  double length = 0;
  for (size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  EXPECT_NEAR(shape.length(), length, 1e-5);
  EXPECT_NEAR(shape.place(1), 0.12, 1e-9);
}

TEST(DoublePowerLaw, FindsTwoPowers) {
  const DoublePowerLaw truth{2e-3, 0.12, -4e-4, -0.6};
  std::vector<double> time, value;
  for (double t = 0.4; t < 400; t *= 1.3) time.push_back(t), value.push_back(truth(t));
  const DoublePowerLaw law = fit_double_power(time, value);
  for (size_t k = 0; k < time.size(); ++k) {
    EXPECT_NEAR(law(time[k]), value[k], 2e-3 * value[k]);
    EXPECT_NEAR(law.rate(time[k]), truth.rate(time[k]), 0.05 * truth.rate(time[k])) << time[k];
  }
}

TEST(StripFrequency, IsThatOfTheArticle) {
  // [Krogh]: omega_1 = 11 1/s of a 150 mm strip of 314 g/m^2 means D = 1.56 N mm.
  EXPECT_NEAR(strip_frequency(1.56e-3, 0.314, 0.15), 11, 0.05);
}

}  // namespace
}  // namespace drapeplan
