#include "planner/drape/schedule_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

using Json = nlohmann::ordered_json;

/// Samples closer than this are one: far below any controller's cycle, far above round-off.
constexpr double kSameTime = 1e-9;  // [s]

void check_fits(const Schedule& schedule, const RigOptions& rig) {
  const auto empty = [](const auto& path) { return path.empty(); };
  const auto check = [&](const auto& paths, size_t count, const std::string& kind) {
    const bool empty_path = std::any_of(paths.begin(), paths.end(), empty);
    if (paths.size() == count && !empty_path) return;
    throw std::invalid_argument("a schedule of " + std::to_string(paths.size()) + kind +
                                " paths for a rig of " + std::to_string(rig.count()) + " grippers" +
                                (empty_path ? ", one without knots" : ""));
  };
  check(schedule.paths, size_t(rig.count()), "");
  check(schedule.plane_paths, rig.driven == Driven::xyz ? size_t(rig.count()) : 0, " in-plane");
}

/// As `exact`, but always a floating-point number to a JSON reader: an integer "-0" would lose its sign.
std::string json_number(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument("a schedule holds a number that is not finite");
  const std::string text = exact(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// Reads one file and keeps its errors.
class Reader {
 public:
  Reader(const std::filesystem::path& file, const RigOptions& rig) : file_(file.string()), rig_(rig) {}

  ScheduleReading read() {
    const Json root = parse();
    if (reading_.errors.empty()) read_root(root);
    return std::move(reading_);
  }

 private:
  void error(const std::string& path, const std::string& message, int line = 0) {
    reading_.errors.push_back({file_, line, path, message});
  }

  Json parse() {
    std::ifstream stream(file_, std::ios::binary);
    if (!stream) {
      error("", "cannot be opened");
      return {};
    }
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    try {
      return Json::parse(text);
    } catch (const Json::parse_error& fault) {
      const size_t end = std::min(fault.byte > 0 ? fault.byte - 1 : 0, text.size());
      const auto newlines = std::count(text.begin(), text.begin() + std::ptrdiff_t(end), '\n');
      error("", "not valid JSON", int(newlines) + 1);
    } catch (const Json::exception& fault) {  // a number out of range
      error("", std::string("not valid JSON: ") + fault.what());
    }
    return {};
  }

  /// True if `value` is an object; keys that are not allowed become errors.
  bool check_object(const Json& value, const std::string& path, const std::set<std::string>& allowed) {
    if (!value.is_object()) {
      error(path, "expected an object, got " + std::string(value.type_name()));
      return false;
    }
    std::string names;
    for (const auto& name : allowed) names += (names.empty() ? "" : ", ") + name;
    for (const auto& [key, ignored] : value.items()) {
      if (!allowed.contains(key)) error(path + "/" + key, "unknown key; expected one of: " + names);
    }
    return true;
  }

  /// A finite number at `key` of an object.
  double number(const Json& value, const std::string& path, const char* key) {
    const std::string at = path + "/" + key;
    if (!value.contains(key)) {
      error(at, "missing");
    } else if (!value.at(key).is_number()) {
      error(at, value.at(key).dump() + ": expected a number");
    } else if (const double number = value.at(key).get<double>(); !std::isfinite(number)) {
      error(at, "not finite");
    } else {
      return number;
    }
    return 0;
  }

  void read_root(const Json& root) {
    if (!check_object(root, "", {"format", "blend_time", "grippers"})) return;
    if (!root.contains("format") || root.at("format") != kScheduleFormat) {
      error("/format", (root.contains("format") ? root.at("format").dump() : "missing") + "; expected \"" +
                           kScheduleFormat + "\"");
      return;
    }
    reading_.value.blend_time = number(root, "", "blend_time");
    if (reading_.value.blend_time < 0)
      error("/blend_time", exact(reading_.value.blend_time) + ": must not be < 0");
    if (!root.contains("grippers") || !root.at("grippers").is_array()) {
      error("/grippers", "expected a list with one entry per gripper");
      return;
    }
    reading_.value.paths.resize(size_t(rig_.count()));
    if (rig_.driven == Driven::xyz) reading_.value.plane_paths.resize(size_t(rig_.count()));
    size_t entry = 0;
    for (const Json& gripper : root.at("grippers"))
      read_gripper(gripper, "/grippers/" + std::to_string(entry++));
    report_missing();
  }

  void report_missing() {
    std::string missing;
    for (size_t g = 0; g < reading_.value.paths.size(); ++g) {
      if (!seen_.contains(int(g))) missing += ' ' + rig_.name(int(g));
    }
    if (!missing.empty()) error("/grippers", "no path for gripper" + missing);
  }

  void read_gripper(const Json& value, const std::string& path) {
    if (!check_object(value, path, {"gripper", "knots", "plane_knots", "release"})) return;
    const int gripper = read_name(value, path + "/gripper");
    std::vector<Knot> knots;
    std::vector<PlaneKnot> plane_knots;
    read_list(value, path, "knots",
              [&](const Json& knot, const std::string& at) { read_knot(knot, at, knots); });
    if (rig_.driven == Driven::xyz) {
      read_list(value, path, "plane_knots",
                [&](const Json& knot, const std::string& at) { read_knot(knot, at, plane_knots); });
    } else if (value.contains("plane_knots")) {
      error(path + "/plane_knots", "the rig drives its joints in z only (grippers.driven)");
    }
    if (gripper < 0) return;
    reading_.value.paths[size_t(gripper)] = std::move(knots);
    if (rig_.driven == Driven::xyz) reading_.value.plane_paths[size_t(gripper)] = std::move(plane_knots);
    if (value.contains("release")) read_release(value, path, size_t(gripper));
  }

  void read_release(const Json& value, const std::string& path, size_t gripper) {
    const double time = number(value, path, "release");
    if (time < 0) error(path + "/release", exact(time) + ": must not be < 0");
    reading_.value.release.resize(size_t(rig_.count()));
    reading_.value.release[gripper] = time;
  }

  /// A list of at least one knot, each handed to `read` with its path.
  template <class Read>
  void read_list(const Json& value, const std::string& path, const char* key, Read read) {
    const std::string at = path + "/" + key;
    if (!value.contains(key) || !value.at(key).is_array() || value.at(key).empty()) {
      return error(at, "expected a list with at least one knot");
    }
    size_t index = 0;
    for (const Json& knot : value.at(key)) read(knot, at + "/" + std::to_string(index++));
  }

  /// Index of the gripper, or -1.
  int read_name(const Json& value, const std::string& path) {
    const std::string allowed = "; expected [i, j] from [1, 1] to [" + std::to_string(rig_.columns) + ", " +
                                std::to_string(rig_.rows) + "]";
    const Json name = value.contains("gripper") ? value.at("gripper") : Json();
    const bool pair =
        name.is_array() && name.size() == 2 && name[0].is_number_integer() && name[1].is_number_integer();
    const auto within = [](const Json& number, int count) {
      return number.get<double>() >= 1 && number.get<double>() <= count;  // as double: no overflow of int
    };
    if (!pair || !within(name[0], rig_.columns) || !within(name[1], rig_.rows)) {
      error(path, name.dump() + allowed);
      return -1;
    }
    const int gripper = rig_.gripper_at({name[0].get<int>(), name[1].get<int>()});
    if (!seen_.insert(gripper).second) error(path, name.dump() + ": this gripper has a path already");
    return gripper;
  }

  void read_knot(const Json& value, const std::string& path, std::vector<Knot>& knots) {
    if (!check_object(value, path, {"time", "z"})) {
      knots.push_back({});
      return;
    }
    const Knot knot{number(value, path, "time"), number(value, path, "z")};
    add_knot(knot, path, knots);
  }

  void read_knot(const Json& value, const std::string& path, std::vector<PlaneKnot>& knots) {
    if (!check_object(value, path, {"time", "x", "y"})) {
      knots.push_back({});
      return;
    }
    const double time = number(value, path, "time"), x = number(value, path, "x"),
                 y = number(value, path, "y");
    add_knot(PlaneKnot{time, {x, y}}, path, knots);
  }

  /// Times increase from 0.
  template <class AnyKnot>
  void add_knot(const AnyKnot& knot, const std::string& path, std::vector<AnyKnot>& knots) {
    if (knots.empty() && knot.time != 0)
      error(path + "/time", exact(knot.time) + ": the first knot is at time 0");
    if (!knots.empty() && !(knot.time > knots.back().time)) {
      error(path + "/time",
            exact(knot.time) + ": times must increase; the knot before is at " + exact(knots.back().time));
    }
    knots.push_back(knot);
  }

  std::string file_;
  const RigOptions& rig_;
  std::set<int> seen_;
  ScheduleReading reading_;
};

/// Knots, ends of their blends and a regular raster: increasing, from 0 to the schedule's end.
std::vector<double> sample_times(const Schedule& schedule, size_t gripper, double rate) {
  const double end = schedule.duration();
  std::vector<double> times{0.0, end};
  const auto add_corners = [&](const auto& path) {
    for (const auto& knot : path) {
      times.push_back(knot.time);
      times.push_back(knot.time + schedule.blend_time);
    }
  };
  add_corners(schedule.paths[gripper]);
  if (!schedule.plane_paths.empty()) add_corners(schedule.plane_paths[gripper]);
  if (gripper < schedule.release.size() && schedule.release[gripper])
    times.push_back(*schedule.release[gripper]);
  for (int k = 1; k / rate < end; ++k) times.push_back(k / rate);
  std::sort(times.begin(), times.end());
  std::vector<double> distinct;
  for (const double time : times) {
    if (time > end + kSameTime) break;
    if (distinct.empty() || time - distinct.back() > kSameTime) distinct.push_back(time);
  }
  return distinct;
}

std::string plane_text(const Schedule& schedule, size_t gripper) {
  if (schedule.plane_paths.empty()) return "";
  std::string text;
  for (const PlaneKnot& knot : schedule.plane_paths[gripper]) {
    text += std::string(text.empty() ? "" : ", ") + "{\"time\": " + json_number(knot.time) +
            ", \"x\": " + json_number(knot.xy.x()) + ", \"y\": " + json_number(knot.xy.y()) + "}";
  }
  return ", \"plane_knots\": [" + text + "]";
}

std::string release_text(const Schedule& schedule, size_t gripper) {
  if (gripper >= schedule.release.size() || !schedule.release[gripper]) return "";
  return ", \"release\": " + json_number(*schedule.release[gripper]);
}

bool ever_released(const Schedule& schedule) {
  return std::any_of(schedule.release.begin(), schedule.release.end(),
                     [](const auto& time) { return time.has_value(); });
}

}  // namespace

void write_schedule(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig) {
  check_fits(schedule, rig);
  // Written by hand, one gripper per line: a person can read and edit it.
  std::string text = "{\n  \"format\": \"" + std::string(kScheduleFormat) +
                     "\",\n  \"blend_time\": " + json_number(schedule.blend_time) + ",\n  \"grippers\": [\n";
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    text += "    {\"gripper\": " + rig.name(int(g)) + ", \"knots\": [";
    for (size_t k = 0; k < schedule.paths[g].size(); ++k) {
      const Knot& knot = schedule.paths[g][k];
      text += std::string(k > 0 ? ", " : "") + "{\"time\": " + json_number(knot.time) +
              ", \"z\": " + json_number(knot.z) + "}";
    }
    text += "]" + plane_text(schedule, g) + release_text(schedule, g);
    text += g + 1 < schedule.paths.size() ? "},\n" : "}\n";
  }
  write_text(file, text + "  ]\n}\n");
}

ScheduleReading read_schedule(const std::filesystem::path& file, const RigOptions& rig) {
  return Reader(file, rig).read();
}

void write_schedule_csv(const std::filesystem::path& file, const Schedule& schedule, const RigOptions& rig,
                        double rate) {
  check_fits(schedule, rig);
  if (!(rate > 0))
    throw std::invalid_argument("write_schedule_csv: the rate must be > 0, it is " + exact(rate));
  const bool plane = !schedule.plane_paths.empty(), suction = ever_released(schedule);
  std::string text = std::string("gripper_i,gripper_j,time_s,z_m,vz_m_per_s") +
                     (plane ? ",x_m,y_m,vx_m_per_s,vy_m_per_s" : "") + (suction ? ",suction" : "") + "\n";
  for (size_t g = 0; g < schedule.paths.size(); ++g) {
    const auto [i, j] = rig.indices(int(g));
    const std::string name = std::to_string(i) + "," + std::to_string(j) + ",";
    for (const double time : sample_times(schedule, g, rate)) {
      const Command command = schedule.command(int(g), time);
      std::vector<double> values{time, command.z, command.vz};
      if (plane)
        values.insert(values.end(),
                      {command.xy.x(), command.xy.y(), command.v_plane.x(), command.v_plane.y()});
      if (suction) values.push_back(schedule.released(int(g), time) ? 0 : 1);
      text += name;
      for (size_t k = 0; k < values.size(); ++k) text += (k > 0 ? "," : "") + exact(values[k]);
      text += "\n";
    }
  }
  write_text(file, text);
}

}  // namespace drapeplan
