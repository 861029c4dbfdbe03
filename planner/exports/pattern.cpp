#include "planner/exports/pattern.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mapping/net.hpp"
#include "planner/base/text.hpp"
#include "planner/exports/dxf.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;

constexpr const char *kCut = "CUT", *kGrippers = "GRIPPERS", *kFibres = "FIBRES", *kDatum = "DATUM",
                     *kText = "TEXT";
constexpr const char* kFile = "pattern.dxf";

// Shares of the ply's shorter side: small beside the ply, and read on a plot of it.
constexpr double kTick = 1.0 / 20;      // of the warp; those of the weft are half as long
constexpr double kLetters = 1.0 / 60;   // height
constexpr int kTicks = 4;               // along either side of the bounding box
constexpr double kCrossOfJoint = 0.25;  // from its middle to each end, of the pad's radius
constexpr double kLettersOfPad = 0.2;   // height, of the pad's radius

void add_grippers(const RigOptions& rig, DxfDrawing& drawing) {
  const double arm = kCrossOfJoint * rig.pad_radius, height = kLettersOfPad * rig.pad_radius;
  for (int g = 0; g < rig.count(); ++g) {
    const Vector2d centre = rig.place(g);
    drawing.add_circle(kGrippers, centre, rig.pad_radius);
    drawing.add_cross(kGrippers, centre, arm);
    drawing.add_text(kText, centre + Vector2d(arm, arm), height, rig.name(g));
  }
}

void add_fibres(const Polygon& outline, const Eigen::AlignedBox2d& box, double length, DxfDrawing& drawing) {
  for (int j = 0; j < kTicks; ++j) {
    for (int i = 0; i < kTicks; ++i) {
      const Vector2d share((i + 0.5) / kTicks, (j + 0.5) / kTicks);
      const Vector2d middle = box.min() + share.cwiseProduct(box.sizes());
      if (!contains(outline, middle)) continue;
      const Vector2d warp(0.5 * length, 0), weft(0, 0.25 * length);
      drawing.add_line(kFibres, middle - warp, middle + warp);
      drawing.add_line(kFibres, middle - weft, middle + weft);
    }
  }
}

}  // namespace

std::string pattern_text(const Case& definition) {
  DxfDrawing drawing({{kCut, 7}, {kGrippers, 5}, {kFibres, 3}, {kDatum, 1}, {kText, 4}});
  const Polygon outline = corners_of(definition.ply);
  const Eigen::AlignedBox2d box = bounding_box(outline);
  const double side = box.sizes().minCoeff(), tick = kTick * side, letters = kLetters * side;
  drawing.add_closed(kCut, outline);
  if (definition.grippers) add_grippers(*definition.grippers, drawing);
  add_fibres(outline, box, tick, drawing);
  drawing.add_cross(kDatum, Vector2d::Zero(), tick);
  drawing.add_text(kText, {tick, 0}, letters, "WARP");
  drawing.add_text(kText, {0, tick}, letters, "WEFT");
  drawing.add_text(kText, box.min() - Vector2d(0, 2 * letters), letters,
                   fmt::format("{}: flat ply in mm, seen from the side of the grippers", definition.name));
  return drawing.text();
}

NamedFiles write_pattern(const std::filesystem::path& folder, const Case& definition) {
  write_text(folder / kFile, pattern_text(definition));
  return {{kFile, "the flat ply with its grippers, to be cut and marked (DXF)"}};
}

}  // namespace drapeplan
