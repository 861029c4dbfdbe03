// map: kinematic energy mapping only.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "planner/drape/map_result.hpp"
#include "planner/exports/mapped_files.hpp"
#include "planner/exports/pattern.hpp"
#include "planner/verbs/verbs.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

struct MapOptions {
  CommonOptions common;
  std::string file;
};

json point_json(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

json points_json(const std::vector<Eigen::Vector3d>& points) {
  json list = json::array();
  for (const Eigen::Vector3d& p : points) list.push_back(point_json(p));
  return list;
}

json result_json(const Case& definition, const MapResult& map) {
  json targets = json::array();
  for (size_t k = 0; k < map.targets.size(); ++k) {
    const int columns = definition.grippers->columns;
    const json gripper = {1 + int(k) % columns, 1 + int(k) / columns};
    targets.push_back({{"gripper", gripper}, {"position", point_json(map.targets[k])}});
  }
  return {{"targets", std::move(targets)},
          {"boundary", points_json(map.boundary)},
          {"corners", points_json(map.corners)},
          {"max_shear_deg", map.max_shear_deg},
          {"mean_shear_deg", map.mean_shear_deg}};
}

std::string millimetres(const std::string& label, const Eigen::Vector3d& p) {
  return fmt::format("  {:<12} {:9.2f} {:9.2f} {:9.2f}\n", label, 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}

std::string result_text(const Case& definition, const MapResult& map) {
  std::string text = fmt::format(
      "{}: shear angle largest {:.2f} deg, mean {:.2f} deg; net of {} x {} cells\n\n", definition.name,
      map.max_shear_deg, map.mean_shear_deg, map.net.u.size() - 1, map.net.v.size() - 1);
  text += "  place             x [mm]    y [mm]    z [mm]\n";
  const char* corners[] = {"corner (-,-)", "corner (+,-)", "corner (+,+)", "corner (-,+)"};
  for (size_t k = 0; k < map.corners.size(); ++k) text += millimetres(corners[k], map.corners[k]);
  for (size_t k = 0; k < map.targets.size(); ++k) {
    const int columns = definition.grippers->columns;
    text +=
        millimetres(fmt::format("gripper {},{}", 1 + int(k) % columns, 1 + int(k) / columns), map.targets[k]);
  }
  return text;
}

int map(const MapOptions& options) {
  const Case definition = load_case(options.file, options.common, {"mapping"});
  OutputFolder out = take_folder(options.common, "map");
  const MapResult result = map_case(definition);
  print_warnings(map_warnings(definition, result), options.common);
  begin_output(out, options.common);
  if (!options.common.out.empty()) {
    write_mapping(out.path(), result, definition.grippers);
    write_pattern(out.path(), definition);
  }
  deliver(result_json(definition, result), result_text(definition, result), options.common, &definition);
  return kDone;
}

}  // namespace

void add_map(CLI::App& program, Action& action) {
  add_verb<MapOptions>(
      program, action, "map", "maps the ply onto the mold: targets, boundary, shear",
      [](CLI::App& verb, MapOptions& options) {
        verb.add_option("CASE", options.file, "case file")->required();
      },
      map);
}

}  // namespace drapeplan
