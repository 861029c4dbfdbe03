#include "planner/report/picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "planner/report/charts.hpp"
#include "planner/report/contour.hpp"
#include "planner/report/svg.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Extent kExtent{{-0.15, -0.15}, {0.15, 0.15}};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Every tag that is opened is closed, in order; quotes are even. Returns the first fault.
std::string markup_fault(const std::string& text) {
  std::vector<std::string> open;
  for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const size_t end = text.find('>', at);
    if (end == std::string::npos) return "tag without end";
    const std::string tag = text.substr(at + 1, end - at - 1);
    if (count(tag, "\"") % 2 != 0) return "odd quotes in <" + tag + ">";
    const std::string name =
        tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" />", 1) - (tag[0] == '/' ? 1 : 0));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != name) return "</" + name + "> closes nothing";
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

DrapePanel panel(double gap) {
  DrapePanel result;
  result.title = "wave";
  result.mesh = rectangle_mesh(0.2, 0.2, 0.02);
  for (const auto& uv : result.mesh.rest) {
    result.position.emplace_back(uv.x(), uv.y(), 0.0);
    result.gap.push_back(gap * (uv.x() + 0.1) / 0.2);
  }
  result.boundary = {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}};
  result.pads = {{0, 0, 0}, {0.05, 0.05, 0}};
  result.pad_radius = 0.02;
  return result;
}

/// Signed area of closed "M..L..Z" path data [px^2].
double path_area(const std::string& data) {
  double area = 0;
  std::vector<Vector2d> loop;
  const char* at = data.c_str();
  while (*at != '\0') {
    double x = 0, y = 0;
    int used = 0;
    if (*at == 'Z') {
      for (size_t k = 0; k < loop.size(); ++k) {
        const Vector2d &a = loop[k], &b = loop[(k + 1) % loop.size()];
        area += 0.5 * (a.x() * b.y() - b.x() * a.y());
      }
      loop.clear();
      ++at;
    } else if (std::sscanf(at + 1, "%lf %lf%n", &x, &y, &used) == 2) {
      loop.emplace_back(x, y);
      at += 1 + used;
    } else {
      return kNan;
    }
  }
  return area;
}

/// A square of 100 px with 5 x 5 elements whose value is `field(x, y)`.
template <class Field>
Triangles square(Field field) {
  const Mesh mesh = rectangle_mesh(100, 100, 20);
  std::vector<double> values;
  for (const Vector2d& p : mesh.rest) values.push_back(field(p.x(), p.y()));
  return refine(mesh.rest, values, mesh.quads, 4);
}

TEST(Contour, RegionAboveTheSmallestValueIsTheWholePlyInOneLoop) {
  const std::string region = region_above(square([](double x, double) { return x + 50; }), 0);
  EXPECT_LE(std::abs(path_area(region) - 1e4), 1e-6);
  EXPECT_EQ(count(region, "M"), 1u);
}

TEST(Contour, LevelOfALinearFieldCutsItsShareOff) {
  const Triangles field = square([](double x, double y) { return x + 0.5 * y; });
  EXPECT_LE(std::abs(path_area(region_above(field, 0)) - 5e3), 5.0);  // half, but for snapping to 1/20 px
  EXPECT_EQ(region_above(field, 1000), "");
}

TEST(Contour, TwoHillsGiveTwoLoops) {
  const auto hill = [](double x, double y) { return std::abs(x) - 0.001 * y * y - 30; };
  EXPECT_EQ(count(region_above(square(hill), 5), "M"), 2u);
}

TEST(Colour, LightnessFallsFromPaleToDark) {
  double before = 1e9;
  for (int k = 0; k <= 20; ++k) {
    unsigned r = 0, g = 0, b = 0;
    ASSERT_EQ(std::sscanf(sequential_colour(k / 20.0).c_str(), "#%02x%02x%02x", &r, &g, &b), 3);
    const double luminance = 0.2126 * std::pow(r / 255.0, 2.2) + 0.7152 * std::pow(g / 255.0, 2.2) +
                             0.0722 * std::pow(b / 255.0, 2.2);
    EXPECT_LT(luminance, before);
    before = luminance;
  }
  EXPECT_EQ(sequential_colour(kNan), sequential_colour(0));
  EXPECT_EQ(sequential_colour(7), sequential_colour(1));
}

TEST(Colour, StepsAreRoundNumbers) {
  EXPECT_LE(std::abs(nice_step(12.2, 14) - 1), 1e-12);
  EXPECT_LE(std::abs(nice_step(10, 5) - 2), 1e-12);
  EXPECT_LE(std::abs(nice_step(0.0061, 5) - 0.002), 1e-15);
  EXPECT_EQ(decimals_of(0.5), 1);
  EXPECT_EQ(decimals_of(0.25), 2);
  EXPECT_EQ(decimals_of(20), 0);
}

TEST(Picture, PanelsShareOneScaleAndPrintTheirLargestValues) {
  DrapePanel wave = panel(0.0122), optimised = panel(0.003);
  optimised.title = "optimised";
  optimised.largest_offset = {{Eigen::Vector3d(0.1, 0.1, 0), Eigen::Vector3d(0.1, 0.1, 0.0042)}};
  const std::string svg = drape_picture({wave, optimised}, kExtent);
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_TRUE(contains(svg, ">wave<") && contains(svg, ">optimised<"));
  EXPECT_TRUE(contains(svg, "largest gap  12.2\u2009mm") && contains(svg, "largest gap  3.0\u2009mm"));
  EXPECT_TRUE(contains(svg, "largest boundary offset  4.2\u2009mm"));
  // 13 bands of 1 mm: the wave reaches them all, the optimised drape only the lowest four (0, 1, 2 and 3 mm).
  EXPECT_GE(count(svg, "<path"), 13u + 3u);
  EXPECT_LE(count(svg, "<path"), 13u + 4u);
}

TEST(Picture, FoldsHaveNumbersAndPadsThatMatterAreFilled) {
  DrapePanel why = panel(0.01);
  EXPECT_TRUE(contains(drape_picture({why}, kExtent), ">largest gap<"));
  why.folds = {{0, 0, 0}, {0.05, 0.05, 0}};
  why.weights.assign(why.pads.size(), 0.5);
  const std::string svg = drape_picture({why}, kExtent);
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_TRUE(contains(svg, ">1<") && contains(svg, ">2<") && contains(svg, ">folds<"));
  EXPECT_TRUE(contains(svg, ">stroke that matters<"));
  EXPECT_FALSE(contains(svg, ">largest gap<")) << "the first fold is the largest gap";
}

TEST(Picture, TitlesAreEscaped) {
  DrapePanel odd = panel(0.001);
  odd.title = "a < b & \"c\"";
  const std::string svg = drape_picture({odd}, kExtent);
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_TRUE(contains(svg, "a &lt; b &amp; &quot;c&quot;"));
}

TEST(Picture, ValuesThatAreNotFiniteDoNotReachTheFile) {
  DrapePanel broken = panel(0.005);
  broken.position[5].x() = kNan;
  broken.position[6].y() = 1e300;
  broken.gap[7] = kNan;
  broken.gap[8] = std::numeric_limits<double>::infinity();
  broken.pads[0].z() = kNan;
  const std::string svg = drape_picture({broken}, kExtent);
  EXPECT_EQ(markup_fault(svg), "");
  for (const char* word : {"nan", "inf", "\u2013", "e+"}) EXPECT_FALSE(contains(svg, word)) << word;
}

TEST(Picture, PlyOnTheMoldAndBarePanelsAreDrawn) {
  DrapePanel bare = panel(0);
  bare.boundary.clear();
  bare.pads.clear();
  const std::string svg = drape_picture({bare}, kExtent);
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_FALSE(contains(svg, "prescribed boundary"));
  EXPECT_THROW(drape_picture({}, kExtent), std::invalid_argument);
  bare.gap.pop_back();
  EXPECT_THROW(drape_picture({bare}, kExtent), std::invalid_argument);
}

TEST(Chart, EmptyOneAndBrokenPointsAreDrawn) {
  EXPECT_EQ(markup_fault(line_chart({"t", "x", "y", {}})), "");
  EXPECT_EQ(markup_fault(line_chart({"t", "x", "y", {{"one", {{3, 4}}}}})), "");
  const std::string svg =
      line_chart({"t", "x", "y", {{"a", {{0, 1}, {1, kNan}, {2, 1}}}, {"b", {{0, 1}}, true}}});
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_FALSE(contains(svg, "nan"));
}

/// Two grippers: preshape, rest, stroke; the second one later and in two speeds.
Schedule two_grippers() {
  return {
      {{{0, 0.5}, {4.9, 0.4}, {6, 0.4}, {9, 0.3}}, {{0, 0.5}, {4.9, 0.4}, {7, 0.4}, {8, 0.35}, {11.4, 0.3}}},
      0.1};
}

TEST(SchedulePicture, ShowsStrokesInOrderOfArrival) {
  RigOptions rig;
  rig.columns = 2;
  rig.rows = 1;
  const std::string svg = schedule_picture(two_grippers(), rig, "wave <1>");
  EXPECT_EQ(markup_fault(svg), "");
  EXPECT_TRUE(contains(svg, "wave &lt;1&gt;"));
  EXPECT_EQ(count(svg, "\u2193 100 mm"), 4u);  // two preshapes, two strokes; two speeds are one stroke
  EXPECT_LT(svg.find(">[1, 1]<"), svg.find(">[2, 1]<"));
  EXPECT_TRUE(contains(svg, ">9.1<") && contains(svg, ">11.5<"));
  rig.rows = 2;
  EXPECT_THROW(schedule_picture(two_grippers(), rig, ""), std::invalid_argument);
}

TEST(SchedulePicture, AGripperHasTheSameColourInTheChartOfHeights) {
  RigOptions rig;
  rig.columns = 2;
  rig.rows = 1;
  const std::string sequence = schedule_picture(two_grippers(), rig, "wave");
  const Chart heights = height_chart(two_grippers(), rig, "wave");
  ASSERT_EQ(heights.series.size(), 2u);
  EXPECT_NE(*heights.series[0].shade, *heights.series[1].shade);
  for (const ChartSeries& series : heights.series) {
    const std::string colour = sequential_colour(*series.shade);
    EXPECT_TRUE(contains(sequence, "fill=\"" + colour + "\"")) << series.name;
    EXPECT_TRUE(contains(line_chart(heights), "stroke=\"" + colour + "\"")) << series.name;
  }
}

TEST(SchedulePicture, GrippersThatNeverMoveAreDrawn) {
  RigOptions rig;
  rig.columns = 1;
  rig.rows = 1;
  EXPECT_EQ(markup_fault(schedule_picture({{{{0, 0.5}}}, 0}, rig, "still")), "");
  EXPECT_EQ(markup_fault(line_chart(height_chart({{{{0, 0.5}}}, 0}, rig, "still"))), "");
}

}  // namespace
}  // namespace drapeplan
