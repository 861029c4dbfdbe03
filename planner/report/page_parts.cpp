#include "planner/report/page_parts.hpp"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <numeric>

#include "planner/base/text.hpp"
#include "planner/page/view_fields.hpp"
#include "planner/report/svg.hpp"

namespace drapeplan {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
/// Classes of shear that draping tools warn of and refuse [deg].
constexpr std::array kShearClasses{15.0, 30.0};
/// Deviations of fibre angles that measurements of draped plies are reported by [deg].
constexpr std::array kAngleClasses{2.0, 3.0, 5.0, 6.0};

/// Bands of the pictures. @param largest  > 0.
ViewScale scale_of(double largest) {
  const Bands bands = bands_up_to(largest);
  ViewScale scale{.step = bands.step, .colours = {}, .decimals = decimals_of(bands.step)};
  for (int band = 0; band < bands.count; ++band) scale.colours.push_back(bands.colour(band));
  return scale;
}

/// "93.1 %"
std::string percent(double share) {
  return fixed(1e2 * share, 1) + "\u202f%";  // a narrow space that does not break
}

}  // namespace

std::string space_view(const std::vector<ViewDrape>& drapes, const MapResult* mapping) {
  return view_markup({.drapes = drapes, .mapping = mapping, .scale = scale_of});
}

ReportTable angles_table(const std::vector<ViewDrape>& drapes, const MapResult* mapping) {
  ReportTable table{
      .title = mapping != nullptr ? "Shear and fibre angles" : "Shear",
      .caption = "Share of the ply's area at the end. Shear: change of the angle between warp and weft.",
      .head = {"sequence"},
      .rows = {}};
  for (const double limit : kShearClasses)
    table.head.push_back(fmt::format("sheared by at most {}\u00b0", limit));
  if (mapping != nullptr) {
    table.caption += " Fibres: the larger angle of warp and weft to those of the mapped net.";
    for (const double limit : kAngleClasses)
      table.head.push_back(fmt::format("fibres within {}\u00b0", limit));
  }
  for (const ViewDrape& drape : drapes) {
    if (drape.frames->empty()) continue;
    const Snapshot& end = drape.frames->back();
    const Mesh& mesh = drape.scene->mesh;
    ReportTable::Row row{.cells = {drape.name}};
    for (const double limit : kShearClasses)
      row.cells.push_back(percent(share_within(mesh, end.shear, limit / kDegrees)));
    if (mapping != nullptr) {
      const std::vector<double> offsets = fibre_angle_offsets(mesh, end.position, mapping->net);
      for (const double limit : kAngleClasses)
        row.cells.push_back(percent(share_within(mesh, offsets, limit / kDegrees)));
    }
    table.rows.push_back(row);
  }
  return table;
}

ReportTable folds_table(const Diagnosis& diagnosis, const RigOptions& rig) {
  ReportTable table{
      .title = {},
      .caption =
          "The highest places, half a spacing of the rig apart at least. Slack is by how much the ply is "
          "longer than the mold below the fold, along the fibre; below zero it is a chord over a hollow.",
      .head = {"fold", "kind", "height [mm]", "at u, v [mm]", "along", "slack [mm]", "grippers",
               "stands since [s]"},
      .rows = {}};
  for (const Fold& fold : diagnosis.folds) {
    std::vector<std::string> names;
    for (const int g : fold.grippers) names.push_back(rig.name(g));
    table.rows.push_back({.cells = {fmt::to_string(table.rows.size() + 1), words_of(fold.kind).name,
                                    fixed(1e3 * fold.height, 2),
                                    fmt::format("{:.0f}, {:.0f}", 1e3 * fold.at.x(), 1e3 * fold.at.y()),
                                    fold.fibre == Fibre::warp ? "warp" : "weft", fixed(1e3 * fold.slack, 2),
                                    fmt::format("{}", fmt::join(names, ", ")), fixed(fold.since, 1)}});
  }
  return table;
}

double ply_area(const Mesh& mesh) {
  const std::vector<double> areas = nodal_areas(mesh);
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<std::string> source_notes(const Case& definition) {
  const MaterialNotes& material = definition.material_notes;
  std::vector<std::string> notes;
  for (const std::string* source :
       {&material.source, &material.tension.source, &material.compression.source, &material.shear.source}) {
    if (!source->empty()) notes.push_back(*source);
  }
  if (!definition.mold_source.empty()) notes.push_back("Mold: " + definition.mold_source);
  if (!definition.grippers_source.empty()) notes.push_back("Grippers: " + definition.grippers_source);
  return notes;
}

}  // namespace drapeplan
