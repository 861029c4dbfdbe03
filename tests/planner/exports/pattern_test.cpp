#include "planner/exports/pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "mapping/net.hpp"
#include "planner/exports/dxf.hpp"
#include "tests/mapping/nets.hpp"
#include "tests/planner/exports/vtu_text.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;

/// What follows a group of code 0, up to the next: the last value of each code.
struct Entity {
  std::string kind;
  std::map<int, std::string> groups;

  [[nodiscard]] double number(int code) const { return std::stod(groups.at(code)); }
  /// In metres.
  [[nodiscard]] Vector2d place(int code) const { return 1e-3 * Vector2d(number(code), number(code + 10)); }
  [[nodiscard]] std::string layer() const { return groups.at(8); }
};

/// A DXF file by its group codes: pairs of lines.
struct Drawing {
  std::map<std::string, std::string> header;
  std::set<std::string> layers;
  std::vector<Entity> entities;
  std::vector<std::string> sections;
  bool ended = false;

  explicit Drawing(const std::string& text) {
    std::istringstream stream(text);
    std::string code_line, value, variable, section;
    std::vector<Entity> all;
    while (std::getline(stream, code_line)) {
      EXPECT_TRUE(bool(std::getline(stream, value))) << "a group has two lines";
      EXPECT_EQ(code_line.size(), 3u) << code_line;
      const int code = std::stoi(code_line);
      if (code == 9)
        variable = value;
      else if (!variable.empty())
        header[std::exchange(variable, "")] = value;
      if (code == 0)
        all.push_back({value, {}});
      else if (!all.empty())
        all.back().groups[code] = value;
    }
    for (const Entity& one : all) {
      if (one.kind == "SECTION")
        sections.push_back(section = one.groups.at(2));
      else if (one.kind == "EOF")
        ended = true;
      else if (one.kind == "LAYER")
        layers.insert(one.groups.at(2));
      else if (section == "ENTITIES" && one.kind != "ENDSEC")
        entities.push_back(one);
    }
  }
  [[nodiscard]] std::vector<Entity> of(const std::string& kind, const std::string& layer) const {
    std::vector<Entity> found;
    for (const Entity& one : entities)
      if (one.kind == kind && one.layer() == layer) found.push_back(one);
    return found;
  }
};

Case rig_case() {
  Case definition;
  definition.name = "Fl\u00fcgel";
  definition.ply = {0.405, 0.305, {0.2, 0.3}, 0.5};
  definition.grippers.emplace();
  definition.grippers->columns = 3;
  definition.grippers->rows = 2;
  definition.grippers->spacing = 0.1;
  definition.grippers->pad_radius = 0.02;
  return definition;
}

TEST(Pattern, IsAFileOfReleaseTwelveInMillimetres) {
  const Drawing drawing(pattern_text(rig_case()));
  EXPECT_EQ(drawing.header.at("$ACADVER"), "AC1009");
  EXPECT_EQ(drawing.header.at("$INSUNITS"), "4");
  EXPECT_EQ(drawing.header.at("$MEASUREMENT"), "1");
  EXPECT_EQ(drawing.sections, (std::vector<std::string>{"HEADER", "TABLES", "BLOCKS", "ENTITIES"}));
  EXPECT_TRUE(drawing.ended);
  EXPECT_EQ(drawing.layers, (std::set<std::string>{"CUT", "GRIPPERS", "FIBRES", "DATUM", "TEXT"}));
  for (const Entity& one : drawing.entities) EXPECT_EQ(drawing.layers.count(one.layer()), 1u) << one.layer();
  for (const char c : pattern_text(rig_case())) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F)) << int(c);
}

TEST(Pattern, OutlineIsThatOfTheFlatPly) {
  Case definition = rig_case();
  for (int round = 0; round < 2; ++round) {
    if (round == 1) definition.ply = l_shaped_ply();
    const Polygon outline = corners_of(definition.ply);
    const Drawing drawing(pattern_text(definition));
    ASSERT_EQ(drawing.of("POLYLINE", "CUT").size(), 1u);
    EXPECT_EQ(drawing.of("POLYLINE", "CUT")[0].groups.at(70), "1") << "closed";
    EXPECT_EQ(drawing.of("SEQEND", "CUT").size(), 1u);
    const std::vector<Entity> corners = drawing.of("VERTEX", "CUT");
    ASSERT_EQ(corners.size(), outline.size());
    for (size_t k = 0; k < corners.size(); ++k) EXPECT_LE((corners[k].place(10) - outline[k]).norm(), 1e-9);
  }
}

TEST(Pattern, PadsAreCirclesWithNamesAndCrosses) {
  const Case definition = rig_case();
  const RigOptions& rig = *definition.grippers;
  const Drawing drawing(pattern_text(definition));
  const std::vector<Entity> circles = drawing.of("CIRCLE", "GRIPPERS"),
                            lines = drawing.of("LINE", "GRIPPERS");
  ASSERT_EQ(circles.size(), 6u);
  ASSERT_EQ(lines.size(), 12u);
  std::map<std::string, Vector2d> names;
  for (const Entity& text : drawing.of("TEXT", "TEXT")) names[text.groups.at(1)] = text.place(10);
  for (int g = 0; g < rig.count(); ++g) {
    const auto k = size_t(g);
    EXPECT_LE((circles[k].place(10) - rig.place(g)).norm(), 1e-9);
    EXPECT_NEAR(circles[k].number(40), 20, 1e-6);
    for (const size_t line : {2 * k, 2 * k + 1})
      EXPECT_LE((0.5 * (lines[line].place(10) + lines[line].place(11)) - rig.place(g)).norm(), 1e-9);
    ASSERT_EQ(names.count(rig.name(g)), 1u) << rig.name(g);
    EXPECT_LE((names.at(rig.name(g)) - rig.place(g)).norm(), rig.pad_radius) << "a name stands in its circle";
  }
}

TEST(Pattern, TicksLieOnThePlyLongAlongTheWarpAndShortAlongTheWeft) {
  Case definition = rig_case();
  definition.ply = l_shaped_ply();
  const std::vector<Entity> ticks = Drawing(pattern_text(definition)).of("LINE", "FIBRES");
  ASSERT_GE(ticks.size(), 8u);
  ASSERT_EQ(ticks.size() % 2, 0u);
  for (size_t k = 0; k < ticks.size(); ++k) {
    const Vector2d along = ticks[k].place(11) - ticks[k].place(10);
    EXPECT_TRUE(contains(definition.ply.outline, 0.5 * (ticks[k].place(10) + ticks[k].place(11))));
    EXPECT_EQ(along[k % 2 == 0 ? 1 : 0], 0) << "first the warp, then the weft";
    EXPECT_NEAR(along.norm(), (k % 2 == 0 ? 1 : 0.5) * 0.25 / 20, 1e-9);
  }
}

TEST(Pattern, DatumIsTheOriginOfThePlyFrame) {
  const Drawing drawing(pattern_text(rig_case()));
  const std::vector<Entity> datum = drawing.of("LINE", "DATUM");
  ASSERT_EQ(datum.size(), 2u);
  for (const Entity& line : datum) EXPECT_LE((line.place(10) + line.place(11)).norm(), 1e-9);
  std::map<std::string, Vector2d> texts;
  for (const Entity& text : drawing.of("TEXT", "TEXT")) texts[text.groups.at(1)] = text.place(10);
  EXPECT_GT(texts.at("WARP").x(), 0);
  EXPECT_GT(texts.at("WEFT").y(), 0);
  EXPECT_EQ(texts.count("Fl?gel: flat ply in mm, seen from the side of the grippers"), 1u);
}

TEST(Pattern, APlyWithoutGrippersHasNone) {
  Case definition = rig_case();
  definition.grippers.reset();
  const Drawing drawing(pattern_text(definition));
  EXPECT_TRUE(drawing.of("CIRCLE", "GRIPPERS").empty());
  EXPECT_EQ(drawing.of("TEXT", "TEXT").size(), 3u);
  const test::Folder folder;
  ASSERT_EQ(write_pattern(folder.path(), definition).size(), 1u);
  EXPECT_EQ(test::text_of(folder / "pattern.dxf"), pattern_text(definition));
}

TEST(Dxf, WhatCannotBeDrawnIsRefused) {
  DxfDrawing drawing({{"A", 7}});
  EXPECT_THROW(drawing.add_line("B", {0, 0}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(drawing.add_circle("A", {std::numeric_limits<double>::quiet_NaN(), 0}, 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace drapeplan
