#include "planner/report/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planner/base/text.hpp"
#include "planner/report/contour.hpp"
#include "planner/report/svg.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Layout [px].
constexpr double kPanelSize = 360;  // longer side of the part that is seen
constexpr double kPanelGap = 30;
constexpr double kLeft = 58;     // for the ticks of the y axis
constexpr double kTop = 58;      // for titles
constexpr double kBottom = 138;  // for ticks, values and two rows of the legend
constexpr double kLegendRow = 22;
constexpr double kColourBar = 104;    // with its ticks and its title
constexpr double kRingDistance = 15;  // between circles on the prescribed boundary
constexpr double kFarAway = 1e5;      // no coordinate is larger than that

constexpr double kPieceSize = 3;      // edge of the pieces an element is split into
constexpr double kViewMargin = 0.02;  // around what is seen, over its longer side
constexpr double kOverhang = 0.25;    // a ply is seen this far beyond the mold, over the mold's longer side

/// Part of the x-y plane that a panel shows, and the scale.
struct View {
  Vector2d lower, upper;  ///< [m]
  double scale = 1;       ///< [px/m]

  [[nodiscard]] Vector2d size() const { return (upper - lower) * scale; }
  /// Pixel of a point, from the panel's upper left corner.
  [[nodiscard]] Vector2d pixel(const Vector3d& p) const {
    return {std::clamp((p.x() - lower.x()) * scale, -kFarAway, kFarAway),
            std::clamp((upper.y() - p.y()) * scale, -kFarAway, kFarAway)};
  }
};

constexpr const char* kEmphasis = "#8e44ad";  // no colour of the gaps, nor of the boundary

double finite_or_zero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

void check(const std::vector<DrapePanel>& panels) {
  if (panels.empty()) throw std::invalid_argument("drape_picture: no panels");
  for (const DrapePanel& panel : panels) {
    const size_t nodes = panel.mesh.rest.size();
    if (panel.position.size() == nodes && panel.gap.size() == nodes) continue;
    throw std::invalid_argument(
        fmt::format("drape_picture: panel \"{}\" has {} positions and {} gaps for {} nodes", panel.title,
                    panel.position.size(), panel.gap.size(), nodes));
  }
}

View common_view(const std::vector<DrapePanel>& panels, const Extent& mold) {
  View view{mold.lower, mold.upper};
  const double side = (mold.upper - mold.lower).maxCoeff();
  const Vector2d lowest = mold.lower.array() - kOverhang * side,
                 highest = mold.upper.array() + kOverhang * side;
  const auto include = [&](const std::vector<Vector3d>& points) {
    for (const Vector3d& point : points) {
      if (!point.allFinite()) continue;
      view.lower = view.lower.cwiseMin(point.head<2>()).cwiseMax(lowest);
      view.upper = view.upper.cwiseMax(point.head<2>()).cwiseMin(highest);
    }
  };
  for (const DrapePanel& panel : panels) {
    include(panel.position);
    include(panel.boundary);
  }
  const double margin = kViewMargin * (view.upper - view.lower).maxCoeff();
  view.lower.array() -= margin;
  view.upper.array() += margin;
  view.scale = kPanelSize / (view.upper - view.lower).maxCoeff();
  return view;
}

/// Colour scale that all panels share [m].
Bands common_bands(const std::vector<DrapePanel>& panels) {
  double largest = 0;
  for (const DrapePanel& panel : panels) {
    for (const double gap : panel.gap) largest = std::max(largest, finite_or_zero(gap));
  }
  constexpr double kNoGap = 0.001;  // [m]: one band where the ply lies on the mold everywhere
  return largest > 0 ? bands_up_to(largest) : Bands{kNoGap, 1};
}

std::vector<Vector2d> pixels(const View& view, const std::vector<Vector3d>& points) {
  std::vector<Vector2d> places;
  for (const Vector3d& point : points) {
    if (point.allFinite()) places.push_back(view.pixel(point));
  }
  return places;
}

void draw_bands(Svg& svg, const DrapePanel& panel, const View& view, const Bands& bands) {
  std::vector<Vector2d> places;
  std::vector<double> gaps;
  for (size_t node = 0; node < panel.position.size(); ++node) {
    places.push_back(panel.position[node].allFinite() ? view.pixel(panel.position[node]) : Vector2d(0, 0));
    gaps.push_back(std::max(0.0, finite_or_zero(panel.gap[node])));
  }
  std::vector<std::array<int, 4>> quads;
  double longest = 0;  // edge of an element [px]
  for (const auto& quad : panel.mesh.quads) {
    const auto finite = [&](int node) { return panel.position[size_t(node)].allFinite(); };
    if (!std::all_of(quad.begin(), quad.end(), finite)) continue;
    quads.push_back(quad);
    longest = std::max(longest, (places[size_t(quad[1])] - places[size_t(quad[0])]).norm());
  }
  const int parts = std::clamp(int(std::ceil(longest / kPieceSize)), 1, 8);
  const Triangles triangles = refine(places, gaps, quads, parts);
  // Painter's order: each band covers all higher ones too, which leaves no seams between bands.
  for (int band = 0; band < bands.count; ++band) {
    const std::string region = region_above(triangles, band * bands.step);
    if (!region.empty()) svg.path(region, {.fill = bands.colour(band)});
  }
}

/// Red line with circles at equal distances along it.
void draw_boundary(Svg& svg, const std::vector<Vector2d>& line) {
  if (line.size() < 2) return;
  svg.polyline(line, {.stroke = ink::kBoundary, .width = 1.3});
  double until_ring = 0;
  for (size_t k = 1; k < line.size(); ++k) {
    const double length = (line[k] - line[k - 1]).norm();
    double at = until_ring;
    for (; at < length; at += kRingDistance) {
      const Vector2d centre = line[k - 1] + (line[k] - line[k - 1]) * (at / length);
      svg.circle(centre, 2.6, {.fill = "#ffffff", .stroke = ink::kBoundary, .width = 1.1});
    }
    until_ring = at - length;
  }
}

void draw_cross(Svg& svg, const Vector2d& p) {
  for (const auto& [colour, width] : {std::pair{"#ffffff", 4.0}, std::pair{ink::kText, 1.8}}) {
    svg.line(p - Vector2d(6, 0), p + Vector2d(6, 0), {.stroke = colour, .width = width});
    svg.line(p - Vector2d(0, 6), p + Vector2d(0, 6), {.stroke = colour, .width = width});
  }
}

/// A double-headed measure between two points, with a dot at either end.
void draw_measure(Svg& svg, const Vector2d& a, const Vector2d& b) {
  svg.line(a, b, {.stroke = "#ffffff", .width = 5});
  svg.line(a, b, {.stroke = ink::kText, .width = 2});
  for (const Vector2d& end : {a, b})
    svg.circle(end, 3, {.fill = ink::kText, .stroke = "#ffffff", .width = 1});
}

/// Value beside a mark, on the side where there is more room; `taken` keeps two labels apart.
void draw_label(Svg& svg, const View& view, const Vector2d& mark, const std::string& text,
                std::vector<Vector2d>& taken) {
  const Vector2d size = view.size();
  const bool left = mark.x() < 0.5 * size.x();
  Vector2d place = mark + Vector2d(left ? 10 : -10, mark.y() < 0.5 * size.y() ? 20 : -12);
  place.y() = std::clamp(place.y(), 16.0, size.y() - 8);
  constexpr double kLineHeight = 18, kLabelWidth = 70;
  for (const Vector2d& other : taken) {
    if (std::abs(other.y() - place.y()) >= kLineHeight || std::abs(other.x() - place.x()) >= kLabelWidth)
      continue;
    place.y() = other.y() + (mark.y() < 0.5 * size.y() ? kLineHeight : -kLineHeight);
  }
  taken.push_back(place);
  svg.text(place, text,
           {.size = 13, .anchor = left ? Svg::Anchor::start : Svg::Anchor::end, .bold = true, .halo = true});
}

std::string millimetres(double metres) {
  return fixed(1000 * metres, 1) + "\u2009mm";
}

/// Numbers of folds, in discs.
void draw_folds(Svg& svg, const std::vector<Vector2d>& folds) {
  for (size_t k = 0; k < folds.size(); ++k) {
    svg.circle(folds[k], 9, {.fill = "#ffffff", .stroke = ink::kText, .width = 1.4});
    svg.text(folds[k] + Vector2d(0, 4.5), fmt::to_string(k + 1),
             {.size = 12, .anchor = Svg::Anchor::middle, .bold = true});
  }
}

/// The marks of the largest values and their numbers; returns the lines to print below the panel.
std::vector<std::string> draw_marks(Svg& svg, const DrapePanel& panel, const View& view) {
  std::vector<std::string> lines;
  std::vector<Vector2d> taken;
  const auto largest = std::max_element(panel.gap.begin(), panel.gap.end(), [](double a, double b) {
    return finite_or_zero(a) < finite_or_zero(b);
  });
  if (panel.largest_offset) {
    const auto& [edge, boundary] = *panel.largest_offset;
    draw_measure(svg, view.pixel(edge), view.pixel(boundary));
    draw_label(svg, view, 0.5 * (view.pixel(edge) + view.pixel(boundary)),
               millimetres((edge - boundary).norm()), taken);
  }
  if (largest != panel.gap.end()) {
    const Vector3d& place = panel.position[size_t(largest - panel.gap.begin())];
    lines.push_back("largest gap  " + millimetres(*largest));
    if (place.allFinite() && finite_or_zero(*largest) > 0 && panel.folds.empty()) {
      draw_cross(svg, view.pixel(place));
      draw_label(svg, view, view.pixel(place), millimetres(*largest), taken);
    }
  }
  if (panel.largest_offset) {
    const auto& [edge, boundary] = *panel.largest_offset;
    lines.push_back("largest boundary offset  " + millimetres((edge - boundary).norm()));
  }
  return lines;
}

/// Ticks at round millimetres of the mold's frame, along x and, for the first panel, along y.
void draw_ticks(Svg& svg, const Vector2d& corner, const View& view, const Extent& mold, bool with_y) {
  const double step = nice_step((mold.upper - mold.lower).maxCoeff(), 5);
  const double bottom = corner.y() + view.size().y();
  for (double x = std::ceil(mold.lower.x() / step - 1e-9) * step; x <= mold.upper.x() + 1e-9 * step;
       x += step) {
    const double at = corner.x() + (x - view.lower.x()) * view.scale;
    svg.line({at, bottom}, {at, bottom + 4}, {.stroke = ink::kSoft});
    svg.text({at, bottom + 17}, fixed(1000 * x, 0),
             {.size = 11, .anchor = Svg::Anchor::middle, .colour = ink::kSoft});
  }
  svg.text({corner.x() + view.size().x(), bottom + 33}, "x [mm]",
           {.size = 11, .anchor = Svg::Anchor::end, .colour = ink::kSoft});
  if (!with_y) return;
  for (double y = std::ceil(mold.lower.y() / step - 1e-9) * step; y <= mold.upper.y() + 1e-9 * step;
       y += step) {
    const double at = corner.y() + (view.upper.y() - y) * view.scale;
    svg.line({corner.x() - 4, at}, {corner.x(), at}, {.stroke = ink::kSoft});
    svg.text({corner.x() - 8, at + 4}, fixed(1000 * y, 0),
             {.size = 11, .anchor = Svg::Anchor::end, .colour = ink::kSoft});
  }
  svg.text({corner.x() - 42, corner.y() + 0.5 * view.size().y()}, "y [mm]",
           {.size = 11, .anchor = Svg::Anchor::middle, .colour = ink::kSoft, .turn = -90});
}

void draw_panel(Svg& svg, const DrapePanel& panel, const Vector2d& corner, const View& view,
                const Bands& bands, const Extent& mold, bool first) {
  const Vector2d size = view.size();
  svg.text({corner.x(), corner.y() - (panel.subtitle.empty() ? 12 : 28)}, panel.title,
           {.size = 16, .bold = true});
  svg.text({corner.x(), corner.y() - 10}, panel.subtitle, {.size = 12, .colour = ink::kSoft});
  svg.open_window(corner, size);
  const Vector2d upper_left = view.pixel({mold.lower.x(), mold.upper.y(), 0});
  svg.rectangle(upper_left, (mold.upper - mold.lower) * view.scale,
                {.fill = ink::kSurface, .stroke = "#aab3bf", .width = 1.2});
  draw_bands(svg, panel, view, bands);
  std::vector<Vector3d> outline;
  for (const int node : panel.mesh.outline) outline.push_back(panel.position[size_t(node)]);
  if (!outline.empty()) outline.push_back(outline.front());
  svg.polyline(pixels(view, outline), {.stroke = ink::kText, .width = 1.2});
  const std::vector<Vector2d> pads = pixels(view, panel.pads);
  for (size_t g = 0; g < pads.size(); ++g) {
    const double radius = panel.pad_radius * view.scale;
    if (g < panel.weights.size())
      svg.circle(pads[g], radius, {.fill = kEmphasis, .opacity = std::clamp(panel.weights[g], 0.0, 1.0)});
    svg.circle(pads[g], radius, {.stroke = ink::kText, .width = 0.8, .opacity = 0.55});
    if (g < panel.pad_names.size())
      svg.text(pads[g] + Vector2d(0, radius + 12), panel.pad_names[g],
               {.size = 11, .anchor = Svg::Anchor::middle, .halo = true});
  }
  draw_boundary(svg, pixels(view, panel.boundary));
  const std::vector<std::string> lines = draw_marks(svg, panel, view);
  draw_folds(svg, pixels(view, panel.folds));
  svg.close_window();
  draw_ticks(svg, corner, view, mold, first);
  double y = corner.y() + size.y() + 42;
  for (const std::string& line : lines) {
    svg.text({corner.x(), y}, line, {.size = 13});
    y += 18;
  }
}

/// Entries in a row from `at` on; a new row where one would pass `right`.
void draw_legend(Svg& svg, Vector2d at, double right, const std::vector<DrapePanel>& panels) {
  const double left = at.x();
  const auto any = [&](auto has) { return std::any_of(panels.begin(), panels.end(), has); };
  const auto entry = [&](const std::string& text, const auto& draw_symbol) {
    constexpr double kSymbol = 30, kApart = 14, kLetters = 12;
    const double width = kSymbol + text_width(text, kLetters);
    if (at.x() + width > right) at = {left, at.y() + kLegendRow};
    draw_symbol();
    svg.text(at + Vector2d(kSymbol, 4), text, {.size = kLetters, .colour = ink::kSoft});
    at.x() += width + kApart;
  };
  if (any([](const DrapePanel& p) { return p.boundary.size() > 1; }))
    entry("prescribed boundary", [&] { draw_boundary(svg, {at, at + Vector2d(24, 0)}); });
  entry("ply edge", [&] { svg.line(at, at + Vector2d(24, 0), {.stroke = ink::kText, .width = 1.2}); });
  if (any([](const DrapePanel& p) { return p.folds.empty(); }))
    entry("largest gap", [&] { draw_cross(svg, at + Vector2d(16, 0)); });
  if (any([](const DrapePanel& p) { return !p.folds.empty(); }))
    entry("folds", [&] { draw_folds(svg, {at + Vector2d(14, 0)}); });
  if (any([](const DrapePanel& p) { return p.largest_offset.has_value(); })) {
    entry("largest boundary offset", [&] { draw_measure(svg, at + Vector2d(4, 0), at + Vector2d(22, 0)); });
  }
  if (any([](const DrapePanel& p) { return !p.pads.empty(); })) {
    entry("gripper pad", [&] {
      svg.circle(at + Vector2d(14, 0), 8, {.stroke = ink::kText, .width = 0.8, .opacity = 0.55});
    });
  }
  if (any([](const DrapePanel& p) { return !p.weights.empty(); })) {
    entry("stroke that matters",
          [&] { svg.circle(at + Vector2d(14, 0), 8, {.fill = kEmphasis, .opacity = 0.8}); });
  }
}

}  // namespace

std::string drape_picture(const std::vector<DrapePanel>& panels, const Extent& mold_extent) {
  check(panels);
  const View view = common_view(panels, mold_extent);
  const Bands bands = common_bands(panels);
  const double columns = double(panels.size());
  const Vector2d size = view.size();
  const double bar = kLeft + columns * size.x() + columns * kPanelGap - 8;
  Svg svg(bar + kColourBar, kTop + size.y() + kBottom, "Gap between ply and mold, seen from above");
  for (size_t k = 0; k < panels.size(); ++k) {
    const Vector2d corner(kLeft + double(k) * (size.x() + kPanelGap), kTop);
    draw_panel(svg, panels[k], corner, view, bands, mold_extent, k == 0);
  }
  draw_colour_bar(svg, {bar, kTop}, size.y(), bands, 1000, "gap between ply and mold [mm]");
  draw_legend(svg, {kLeft, kTop + size.y() + kBottom - 42}, bar + kColourBar, panels);
  return svg.finish();
}

}  // namespace drapeplan
