#include "planner/exports/fibres.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "planner/base/text.hpp"
#include "planner/page/view_fields.hpp"
#include "planner/tables/csv_metadata.hpp"

namespace drapeplan {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr const char* kFile = "fibres.csv";

CsvTable table_of(const Snapshot& ply, double thickness, const std::string& case_name,
                  const std::string& case_hash) {
  CsvTable table{
      .file = kFile,
      .case_name = case_name,
      .case_hash = case_hash,
      .description =
          {fmt::format("fibres of the ply as it lies at the end of the run, at {:.9g} s", ply.time),
           "frame: the world of the case, z up, the frame in which the mold is given; places are on "
           "the middle surface of the ply",
           "units: m, degrees",
           fmt::format("thickness: {:.9g} m of the flat ply over the cosine of the shear angle, for "
                       "fibres that keep their length and a fabric that keeps its volume",
                       thickness)},
      .columns = {{"element", "integer", "number among the cells of the ply's VTU files, from 0"},
                  {"u_m", "double",
                   "place of the element's middle in the flat ply along the warp, in metres"},
                  {"v_m", "double", "the same along the weft"}},
      .key = {"element"}};
  for (const char axis : {'x', 'y', 'z'})
    table.columns.push_back({fmt::format("{}_m", axis), "double",
                             fmt::format("place of the element's middle along {}, in metres", axis)});
  for (const char* fibre : {"warp", "weft"}) {
    for (const char axis : {'x', 'y', 'z'})
      table.columns.push_back({fmt::format("{}_{}", fibre, axis), "double",
                               fmt::format("{} component of the unit vector along the {}", axis, fibre)});
  }
  table.columns.push_back(
      {"shear_deg", "double", "change of the angle between warp and weft, > 0 where it closes, in degrees"});
  table.columns.push_back({"thickness_m", "double", "thickness of the sheared ply, in metres"});
  return table;
}

}  // namespace

double sheared_thickness(double flat, double shear) {
  return flat / std::cos(shear);
}

NamedFiles write_fibres(const std::filesystem::path& folder, const Scene& scene, const Snapshot& ply,
                        const std::string& case_name, const std::string& case_hash) {
  const double thickness = scene.fabric.thickness;
  const CsvTable table = table_of(ply, thickness, case_name, case_hash);
  std::string text = head_line(table);
  for (size_t e = 0; e < scene.mesh.quads.size(); ++e) {
    const auto& quad = scene.mesh.quads[e];
    Eigen::Vector2d rest(0, 0);
    Eigen::Vector3d place(0, 0, 0);
    for (const int node : quad) {
      rest += 0.25 * scene.mesh.rest[size_t(node)];
      place += 0.25 * ply.position[size_t(node)];
    }
    const Fibres fibres = element_fibres(scene.mesh, quad, ply.position);
    const Eigen::Vector3d warp = fibres.warp.normalized(), weft = fibres.weft.normalized();
    const double shear = ply.shear.at(e);
    text += fmt::to_string(e);
    for (const double value :
         {rest.x(), rest.y(), place.x(), place.y(), place.z(), warp.x(), warp.y(), warp.z(), weft.x(),
          weft.y(), weft.z(), kDegrees * shear, sheared_thickness(thickness, shear)}) {
      if (!std::isfinite(value))
        throw std::invalid_argument(fmt::format("fibres of element {}: {}", e, value));
      text += fmt::format(",{:.9g}", value + 0.0);  // no "-0"
    }
    text += "\n";
  }
  write_text(folder / kFile, text);
  write_text(folder / metadata_name(kFile), metadata_text(table));
  return {
      {kFile, "fibres and thickness of each element at the end, for the finite-element model of the part"},
      {metadata_name(kFile), "what its columns mean, for programs (CSV on the Web)"}};
}

}  // namespace drapeplan
