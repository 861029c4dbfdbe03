#include "planner/schedule/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

#include "planner/base/text.hpp"
#include "planner/input/document.hpp"
#include "planner/input/kit.hpp"
#include "planner/input/reader.hpp"

namespace drapeplan {
namespace {

/// As `exact`, but always a floating-point number to a JSON reader: an integer "-0" would lose its sign.
std::string json_number(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a schedule holds a number that is not finite");
  const std::string text = exact(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// What one entry of `grippers` says.
struct GripperEntry {
  std::optional<std::array<int, 2>> indices;
  std::vector<Knot> knots;
  std::vector<PlaneKnot> plane_knots;
  std::optional<double> release;
};

struct ScheduleFields {
  double blend_time = 0;
  std::vector<GripperEntry> grippers;
};

Field number(std::string name, double& target, std::string doc, Range range = {}) {
  return {std::move(name), &target, std::move(doc), Dimension::none, range, true};
}

template <class Item, class Visit>
ObjectList required_list(std::string name, std::string doc, std::vector<Item>& items, Visit visit) {
  ObjectList list = object_list(std::move(name), std::move(doc), items, visit);
  list.required = true;
  return list;
}

void visit_gripper(FieldVisitor& v, GripperEntry& entry, const RigOptions& rig) {
  v.field({"gripper", &entry.indices, "[i, j], counted from 1", Dimension::none, {}, true});
  v.list(required_list("knots", "where its joint goes", entry.knots, [&v](Knot& knot) {
    v.field(number("time", knot.time, "of the knot [s]"));
    v.field(number("z", knot.z, "height of the joint [m]"));
  }));
  v.alternative("grippers.driven", "xyz", rig.driven == Driven::xyz, [&] {
    v.list(required_list("plane_knots", "where its joint goes in-plane", entry.plane_knots,
                         [&v](PlaneKnot& knot) {
                           v.field(number("time", knot.time, "of the knot [s]"));
                           v.field(number("x", knot.xy.x(), "place of the joint [m]"));
                           v.field(number("y", knot.xy.y(), "place of the joint [m]"));
                         }));
  });
  v.field({"release", &entry.release, "when its suction ends [s]", Dimension::none, from(0)});
}

void visit_schedule(FieldVisitor& v, ScheduleFields& fields, const RigOptions& rig) {
  int format = 0;
  v.field({"format", choice(format, {kScheduleFormat}), "what this file is", Dimension::none, {}, true});
  v.field(number("blend_time", fields.blend_time, "over which velocities change [s]", from(0)));
  v.list(required_list("grippers", "one entry per gripper", fields.grippers,
                       [&](GripperEntry& entry) { visit_gripper(v, entry, rig); }));
}

/// Times increase from 0.
template <class AnyKnot>
void check_times(const std::vector<AnyKnot>& knots, const std::string& pointer, FieldReader& reader) {
  for (size_t k = 0; k < knots.size(); ++k) {
    const std::string place = fmt::format("{}/{}/time", pointer, k);
    if (!reader.good(place)) continue;
    if (k == 0 && knots[k].time != 0) reader.fail(place, "the first knot is at time 0");
    if (k > 0 && !(knots[k].time > knots[k - 1].time)) {
      reader.fail(place, "times must increase; the knot before is at " + exact(knots[k - 1].time));
    }
  }
}

/// Index of the gripper that an entry is about, if the rig has it.
std::optional<size_t> gripper_of(const GripperEntry& entry, const std::string& pointer, const RigOptions& rig,
                                 FieldReader& reader) {
  if (!reader.good(pointer)) return std::nullopt;
  const auto [i, j] = *entry.indices;
  if (i >= 1 && i <= rig.columns && j >= 1 && j <= rig.rows) return size_t(rig.gripper_at({i, j}));
  reader.fail(pointer, fmt::format("expected [i, j] from [1, 1] to [{}, {}]", rig.columns, rig.rows));
  return std::nullopt;
}

/// Puts the entries in the order of the rig, and looks for what no single field shows.
Schedule to_schedule(ScheduleFields fields, const RigOptions& rig, FieldReader& reader) {
  const auto count = size_t(rig.count());
  Schedule schedule;
  schedule.blend_time = fields.blend_time;
  schedule.paths.resize(count);
  if (rig.driven == Driven::xyz) schedule.plane_paths.resize(count);
  std::set<size_t> seen;
  for (size_t k = 0; k < fields.grippers.size(); ++k) {
    GripperEntry& entry = fields.grippers[k];
    const std::string pointer = fmt::format("/grippers/{}", k);
    check_times(entry.knots, pointer + "/knots", reader);
    check_times(entry.plane_knots, pointer + "/plane_knots", reader);
    const std::optional<size_t> gripper = gripper_of(entry, pointer + "/gripper", rig, reader);
    if (!gripper) continue;
    if (!seen.insert(*gripper).second) reader.fail(pointer + "/gripper", "this gripper has a path already");
    schedule.paths[*gripper] = std::move(entry.knots);
    if (rig.driven == Driven::xyz) schedule.plane_paths[*gripper] = std::move(entry.plane_knots);
    if (!entry.release) continue;
    schedule.release.resize(count);
    schedule.release[*gripper] = entry.release;
  }
  std::string missing;
  for (size_t g = 0; g < count; ++g) {
    if (!seen.contains(g)) missing += ' ' + rig.name(int(g));
  }
  if (!missing.empty()) reader.add_error("/grippers", "no path for gripper" + missing);
  return schedule;
}

std::string plane_text(const Schedule& schedule, size_t gripper) {
  if (schedule.plane_paths.empty()) return "";
  std::string text;
  for (const PlaneKnot& knot : schedule.plane_paths[gripper]) {
    text += fmt::format("{}{{\"time\": {}, \"x\": {}, \"y\": {}}}", text.empty() ? "" : ", ",
                        json_number(knot.time), json_number(knot.xy.x()), json_number(knot.xy.y()));
  }
  return fmt::format(", \"plane_knots\": [{}]", text);
}

std::string release_text(const Schedule& schedule, size_t gripper) {
  if (gripper >= schedule.release.size() || !schedule.release[gripper]) return "";
  return ", \"release\": " + json_number(*schedule.release[gripper]);
}

}  // namespace

void require_fit(const Schedule& schedule, const RigOptions& rig) {
  const auto empty = [](const auto& path) { return path.empty(); };
  const auto check = [&](const auto& paths, size_t count, const std::string& kind) {
    const bool empty_path = std::any_of(paths.begin(), paths.end(), empty);
    if (paths.size() == count && !empty_path) return;
    throw std::invalid_argument(fmt::format("a schedule of {}{} paths for a rig of {} grippers{}",
                                            paths.size(), kind, rig.count(),
                                            empty_path ? ", one without knots" : ""));
  };
  check(schedule.paths, size_t(rig.count()), "");
  check(schedule.plane_paths, rig.driven == Driven::xyz ? size_t(rig.count()) : 0, " in-plane");
}

void write_schedule(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig) {
  require_fit(schedule, rig);
  // Written by hand, one gripper per line: a person can read and edit it.
  std::string text = fmt::format("{{\n  \"format\": \"{}\",\n  \"blend_time\": {},\n  \"grippers\": [\n",
                                 kScheduleFormat, json_number(schedule.blend_time));
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    text += fmt::format("    {{\"gripper\": {}, \"knots\": [", rig.name(int(g)));
    for (size_t k = 0; k < schedule.paths[g].size(); ++k) {
      const Knot& knot = schedule.paths[g][k];
      text += fmt::format("{}{{\"time\": {}, \"z\": {}}}", k > 0 ? ", " : "", json_number(knot.time),
                          json_number(knot.z));
    }
    text += "]" + plane_text(schedule, g) + release_text(schedule, g);
    text += g + 1 < schedule.paths.size() ? "},\n" : "}\n";
  }
  write_text(file, text + "  ]\n}\n");
}

ScheduleReading read_schedule(const std::filesystem::path& file, const RigOptions& rig) {
  const InputDocument document(file);
  ScheduleReading reading{{}, document.errors()};
  if (!document.root().is_object()) return reading;
  ScheduleFields fields;
  FieldReader reader(document);
  reader.read([&](FieldVisitor& visitor) { visit_schedule(visitor, fields, rig); });
  reading.value = to_schedule(std::move(fields), rig, reader);
  reading.errors.insert(reading.errors.end(), reader.errors().begin(), reader.errors().end());
  document.sort(reading.errors);
  return reading;
}

}  // namespace drapeplan
