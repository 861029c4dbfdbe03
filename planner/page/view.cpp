#include "planner/page/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "planner/base/base64.hpp"
#include "planner/base/json_text.hpp"
#include "planner/page/assets.hpp"
#include "planner/page/view_fields.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using nlohmann::json;

constexpr double kMostBytes = 6e6;  // of the data as text: the whole page stays below 10 MB
constexpr size_t kFields = 3;
constexpr double kMillimetres = 1e3, kDegrees = 180 / std::numbers::pi;

/// Values of a field at all nodes and instants, in the unit that is shown.
using FieldFrames = std::vector<std::vector<double>>;

/// What the ply can be coloured by. `of`: values at the nodes of one instant; empty where they are not known.
struct Field {
  const char *name, *unit;
  std::vector<double> (*of)(const Scene& scene, const Snapshot& ply, const MapResult* mapping);
  std::vector<std::pair<double, const char*>> classes;  ///< limits that users know, and their names
};

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value = factor * std::abs(value);
  return values;
}

std::vector<double> gap_of(const Scene& scene, const Snapshot& ply, const MapResult* /*mapping*/) {
  if (!scene.mold) return {};
  return scaled(nodal_gaps(ply, *scene.mold, scene.fabric.thickness), kMillimetres);
}

std::vector<double> shear_of(const Scene& scene, const Snapshot& ply, const MapResult* /*mapping*/) {
  return nodal_means(scene.mesh, scaled(ply.shear, kDegrees));
}

std::vector<double> offset_of(const Scene& scene, const Snapshot& ply, const MapResult* mapping) {
  if (mapping == nullptr) return {};
  return nodal_means(scene.mesh,
                     scaled(fibre_angle_offsets(scene.mesh, ply.position, mapping->net), kDegrees));
}

const std::array<Field, kFields>& fields() {
  static const std::array<Field, kFields> all{
      {{"gap to the mold", "mm", gap_of, {}},
       {"shear angle", "\u00b0", shear_of, {{15, "15\u00b0 warn"}, {30, "30\u00b0 limit"}}},
       {"fibre angle off the mapped net", "\u00b0", offset_of, {}}}};
  return all;
}

/// Numbers in 16 bits each, `width` of them side by side with limits of their own; see view.js.
json packed(const std::vector<double>& numbers, size_t width) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kLargest = 65534;  // one more stands for what is not finite
  std::vector<double> lower(width, kInfinity), upper(width, -kInfinity);
  for (size_t k = 0; k < numbers.size(); ++k) {
    if (!std::isfinite(numbers[k])) continue;
    lower[k % width] = std::min(lower[k % width], numbers[k]);
    upper[k % width] = std::max(upper[k % width], numbers[k]);
  }
  for (size_t c = 0; c < width; ++c)
    if (!(lower[c] <= upper[c])) lower[c] = upper[c] = 0;
  std::vector<unsigned char> bytes;
  bytes.reserve(2 * numbers.size());
  for (size_t k = 0; k < numbers.size(); ++k) {
    const double low = lower[k % width], size = upper[k % width] - low;
    const double share = size > 0 ? (numbers[k] - low) / size : 0.0;
    const auto number = std::uint16_t(std::isfinite(numbers[k]) ? std::lround(kLargest * share) : 65535);
    bytes.push_back(static_cast<unsigned char>(number & 255u));
    bytes.push_back(static_cast<unsigned char>(number >> 8));
  }
  return {{"lower", lower}, {"upper", upper}, {"data", base64(bytes)}};
}

/// Vectors as numbers, one after the other.
template <class Vectors>
void append(const Vectors& vectors, std::vector<double>& numbers) {
  for (const auto& vector : vectors)
    numbers.insert(numbers.end(), vector.data(), vector.data() + vector.size());
}

template <class Vectors>
json packed_vectors(const Vectors& vectors) {
  std::vector<double> numbers;
  append(vectors, numbers);
  return packed(numbers, vectors.empty() ? 1 : size_t(vectors.front().size()));
}

/// The frames that are kept: every so many, so that all drapes fit, and the last one in any case.
std::vector<const Snapshot*> kept_frames(const View& view, const ViewDrape& drape) {
  constexpr double kPerNode = 2.0 * 4 / 3 * (3 + kFields);  // bytes of text
  double bytes = 0;
  for (const ViewDrape& one : view.drapes)
    bytes += kPerNode * double(one.frames->size()) * one.scene->mesh.node_count();
  const auto every = size_t(std::max(1.0, std::ceil(bytes / kMostBytes)));
  std::vector<const Snapshot*> kept;
  for (size_t back = 0; back < drape.frames->size(); back += every)
    kept.push_back(&(*drape.frames)[drape.frames->size() - 1 - back]);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

json drape_json(const ViewDrape& drape, const std::vector<const Snapshot*>& frames,
                const std::vector<FieldFrames>& values) {
  const Mesh& mesh = drape.scene->mesh;
  std::vector<double> times, positions, pads, joints;
  for (const Snapshot* frame : frames) {
    times.push_back(frame->time);
    append(frame->position, positions);
    append(frame->pad, pads);
    append(frame->joint, joints);
  }
  json quads = json::array();
  for (const auto& quad : mesh.quads)
    for (const int node : quad) quads.push_back(node);
  json result = {{"name", drape.name},
                 {"times", times},
                 {"quads", std::move(quads)},
                 {"outline", mesh.outline},
                 {"rest", packed_vectors(mesh.rest)},
                 {"position", packed(positions, 3)},
                 {"fields", json::array()}};
  for (const FieldFrames& field : values) {
    std::vector<double> all;
    for (const std::vector<double>& frame : field) all.insert(all.end(), frame.begin(), frame.end());
    result["fields"].push_back(all.empty() ? json() : packed(all, 1));
  }
  if (!pads.empty() && pads.size() == joints.size()) {
    result["pads"] = packed(pads, 3);
    result["joints"] = packed(joints, 3);
  }
  return result;
}

/// The mold's extent as a grid of points; undefined ones are not finite.
json mold_json(const Mold& mold) {
  constexpr int kPoints = 81;  // along either side
  const Vector2d lower = mold.extent().lower, size = mold.extent().upper - lower;
  std::vector<Vector3d> points;
  for (int j = 0; j < kPoints; ++j)
    for (int i = 0; i < kPoints; ++i)
      points.push_back(
          mold.point(lower.x() + size.x() * i / (kPoints - 1), lower.y() + size.y() * j / (kPoints - 1)));
  return {{"columns", kPoints}, {"rows", kPoints}, {"place", packed_vectors(points)}};
}

json field_json(const Field& field, double largest, const View& view) {
  constexpr double kLeast =
      0.1;  // mm or degrees: what is smaller is round-off, or not worth a scale of its own
  const ViewScale scale = view.scale(std::max(largest, kLeast));
  json classes = json::array();
  for (const auto& [value, name] : field.classes) classes.push_back({{"value", value}, {"name", name}});
  return {{"name", field.name},       {"unit", field.unit},         {"step", scale.step},
          {"colours", scale.colours}, {"decimals", scale.decimals}, {"classes", classes}};
}

/// All that the script needs. The scales of the fields end with the largest value at the end of a drape.
json view_json(const View& view, const Eigen::AlignedBox3d& box) {
  const Scene& scene = *view.drapes.back().scene;
  std::array<double, kFields> largest{};
  json result = {{"drapes", json::array()}, {"fields", json::array()}};
  for (const ViewDrape& drape : view.drapes) {
    const std::vector<const Snapshot*> frames = kept_frames(view, drape);
    std::vector<FieldFrames> values(fields().size());
    for (size_t f = 0; f < values.size(); ++f) {
      for (const Snapshot* frame : frames)
        values[f].push_back(fields()[f].of(*drape.scene, *frame, view.mapping));
      for (const double value : values[f].back())
        if (std::isfinite(value)) largest[f] = std::max(largest[f], value);
    }
    result["drapes"].push_back(drape_json(drape, frames, values));
  }
  for (size_t f = 0; f < largest.size(); ++f)
    result["fields"].push_back(field_json(fields()[f], largest[f], view));
  Eigen::AlignedBox2d ply;
  for (const Vector2d& node : scene.mesh.rest) ply.extend(node);
  result["spacing"] = view.scale(ply.sizes().maxCoeff()).step;
  result["box"] = {{"lower", {box.min().x(), box.min().y(), box.min().z()}},
                   {"upper", {box.max().x(), box.max().y(), box.max().z()}}};
  result["links"] = json::array();
  if (scene.rig) {
    result["pad_radius"] = scene.rig->pad_radius;
    if (scene.rig->interlinks)
      for (const auto& link : interlinks(*scene.rig)) result["links"].push_back(link);
  }
  if (scene.mold) result["mold"] = mold_json(*scene.mold);
  if (view.mapping != nullptr && !view.mapping->boundary.empty())
    result["boundary"] = packed_vectors(view.mapping->boundary);
  return result;
}

/// JSON that may stand in a script: "</script" and "<!--" would end or change it.
std::string json_in_markup(const json& value) {
  std::string text;
  for (const char c : dump_json(value)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

}  // namespace

std::string view_markup(const View& asked) {
  View view = asked;
  std::erase_if(view.drapes, [](const ViewDrape& drape) { return drape.frames->empty(); });
  Eigen::AlignedBox3d box;  // of all plies at their ends
  for (const ViewDrape& drape : view.drapes) {
    for (const Vector3d& node : drape.frames->back().position)
      if (node.allFinite()) box.extend(node);
  }
  if (box.isEmpty()) return "";
  return std::string(kViewSection) + "<script type=\"application/json\" id=\"view-data\">" +
         json_in_markup(view_json(view, box)) + "</script>\n<script>" + kViewScript + "</script>\n";
}

}  // namespace drapeplan
