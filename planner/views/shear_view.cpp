#include "planner/views/shear_view.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "planner/base/text.hpp"
#include "planner/report/svg.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDegrees = 180 / std::numbers::pi;

// Layout [px].
constexpr double kPanelSize = 420;  // longer side of what is seen
constexpr double kPanelGap = 24;
constexpr double kMargin = 20;
constexpr double kTop = 52;  // for titles
constexpr double kBottom = 24;
constexpr double kColourBar = 104;

// From where one looks: the x axis points to the right and towards the eye.
constexpr double kAzimuth = -60 / kDegrees, kElevation = 40 / kDegrees;

/// Place in the picture, y downwards, before scaling [m].
Vector2d seen(const Vector3d& p) {
  const double across = -std::sin(kAzimuth) * p.x() + std::cos(kAzimuth) * p.y();
  const double away = -std::cos(kAzimuth) * p.x() - std::sin(kAzimuth) * p.y();
  return {across, -(std::cos(kElevation) * p.z() + std::sin(kElevation) * away)};
}

/// Distance from the eye, but for a constant [m].
double depth(const Vector3d& p) {
  return -(std::cos(kElevation) * (std::cos(kAzimuth) * p.x() + std::sin(kAzimuth) * p.y()) +
           std::sin(kElevation) * p.z());
}

/// Where the picture of a point lies [px].
struct View {
  Eigen::AlignedBox2d box;
  double scale = 1;  ///< [px/m]
  [[nodiscard]] Vector2d pixel(const Vector3d& p) const { return (seen(p) - box.min()) * scale; }
};

/// The part of the mold around the plies, seen from above.
Extent shown_extent(const std::vector<ShearPanel>& panels, const Mold& mold) {
  constexpr double kBeside = 0.15;  // of the plies' size
  Eigen::AlignedBox2d box;
  for (const ShearPanel& panel : panels) {
    for (const Vector3d& p : panel.ply->position) {
      if (p.allFinite()) box.extend(p.head<2>());
    }
  }
  if (box.isEmpty()) return mold.extent();
  const double margin = kBeside * box.sizes().maxCoeff();
  return {mold.extent().lower.cwiseMax((box.min().array() - margin).matrix()),
          mold.extent().upper.cwiseMin((box.max().array() + margin).matrix())};
}

/// Lines of the mold's net, along x and then along y; parts where the mold is not defined are cut out.
std::vector<std::vector<Vector3d>> mold_lines(const Mold& mold, const Extent& part) {
  constexpr int kLines = 16, kPoints = 61;
  const Vector2d lower = part.lower, size = part.upper - lower;
  std::vector<std::vector<Vector3d>> lines;
  for (const Eigen::Index along : {0, 1}) {
    for (int line = 0; line < kLines; ++line) {
      lines.emplace_back();
      for (int k = 0; k < kPoints; ++k) {
        Vector2d share;
        share[along] = double(k) / (kPoints - 1);
        share[1 - along] = double(line) / (kLines - 1);
        const Vector2d at = lower + size.cwiseProduct(share);
        const Vector3d point = mold.point(at.x(), at.y());
        if (point.allFinite())
          lines.back().push_back(point);
        else if (!lines.back().empty())
          lines.emplace_back();
      }
    }
  }
  return lines;
}

View common_view(const std::vector<ShearPanel>& panels, const std::vector<std::vector<Vector3d>>& lines) {
  View view;
  const auto include = [&view](const Vector3d& p) {
    if (p.allFinite()) view.box.extend(seen(p));
  };
  for (const ShearPanel& panel : panels)
    std::for_each(panel.ply->position.begin(), panel.ply->position.end(), include);
  for (const auto& line : lines) std::for_each(line.begin(), line.end(), include);
  if (view.box.isEmpty()) view.box.extend(Vector2d(0, 0));
  const double size = view.box.sizes().maxCoeff();
  view.scale = size > 0 ? kPanelSize / size : 1;
  return view;
}

void draw_ply(Svg& svg, const Mesh& mesh, const Snapshot& ply, const View& view, const Bands& bands) {
  std::vector<size_t> cells;
  std::vector<double> depths(mesh.quads.size(), 0.0);
  for (size_t e = 0; e < mesh.quads.size(); ++e) {
    for (const int node : mesh.quads[e]) depths[e] += depth(ply.position[size_t(node)]);
    if (std::isfinite(depths[e])) cells.push_back(e);
  }
  std::stable_sort(cells.begin(), cells.end(), [&](size_t a, size_t b) { return depths[a] > depths[b]; });
  for (const size_t e : cells) {
    std::string outline;
    for (const int node : mesh.quads[e]) {
      const Vector2d at = view.pixel(ply.position[size_t(node)]);
      outline += fmt::format("{}{} {}", outline.empty() ? "M" : "L", fixed(at.x(), 1), fixed(at.y(), 1));
    }
    const double shear = kDegrees * std::abs(ply.shear[e]);
    const int band = std::isfinite(shear) ? std::min(int(shear / bands.step), bands.count - 1) : 0;
    const std::string colour = bands.colour(band);
    // Its own colour around it, so that no seam is left between cells.
    svg.path(outline + "Z", {.fill = colour, .stroke = colour, .width = 0.6});
  }
}

}  // namespace

std::string shear_picture(const std::vector<ShearPanel>& panels, const Mesh& mesh, const Mold* mold) {
  if (panels.empty()) throw std::invalid_argument("shear_picture: no panels");
  double largest = 0;
  for (const ShearPanel& panel : panels) {
    if (panel.ply->position.size() != mesh.rest.size() || panel.ply->shear.size() != mesh.quads.size())
      throw std::invalid_argument(fmt::format("shear_picture: \"{}\" does not fit the mesh", panel.title));
    for (const double shear : panel.ply->shear) {
      if (std::isfinite(shear)) largest = std::max(largest, kDegrees * std::abs(shear));
    }
  }
  const auto lines =
      mold != nullptr ? mold_lines(*mold, shown_extent(panels, *mold)) : std::vector<std::vector<Vector3d>>{};
  const View view = common_view(panels, lines);
  const Bands bands = largest > 0 ? bands_up_to(largest) : Bands{};
  const Vector2d size = view.box.sizes() * view.scale;
  const double bar = kMargin + double(panels.size()) * (size.x() + kPanelGap);
  const double height = std::max(size.y(), 0.5 * kPanelSize);
  Svg svg(bar + kColourBar, kTop + height + kBottom, "Shear angle of the ply");
  for (size_t k = 0; k < panels.size(); ++k) {
    const Vector2d corner(kMargin + double(k) * (size.x() + kPanelGap), kTop);
    svg.text(corner - Vector2d(0, 24), panels[k].title, {.size = 16, .bold = true});
    svg.open_window(corner - Vector2d(2, 2), size + Vector2d(4, 4));
    svg.rectangle({0, 0}, size + Vector2d(4, 4), {.fill = ink::kSurface});
    for (const auto& line : lines) {
      std::vector<Vector2d> places;
      for (const Vector3d& point : line) places.push_back(view.pixel(point));
      svg.polyline(places, {.stroke = "#aab3bf", .width = 0.7});
    }
    draw_ply(svg, mesh, *panels[k].ply, view, bands);
    svg.close_window();
  }
  draw_colour_bar(svg, {bar, kTop}, height, bands, 1, "shear angle [deg]");
  return svg.finish();
}

}  // namespace drapeplan
