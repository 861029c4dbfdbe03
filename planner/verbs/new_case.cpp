#include "planner/verbs/new_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapping/error.hpp"
#include "planner/base/quantity.hpp"
#include "planner/molds/mold_file.hpp"

namespace drapeplan {
namespace {

using nlohmann::ordered_json;

/// The example molds are domes: so many longest sides of the ply is their radius. The ply's edge then lies a
/// twentieth of its length below its middle, and shears by a few degrees.
constexpr double kDomeRadius = 2.5;
/// What the molds cover beyond the ply, as a share of its longest side: plies may shift and turn.
constexpr double kMargin = 0.15;
/// Pads: a share of the ply's shorter side, and the largest that is chosen [m].
constexpr double kPadShare = 0.05, kLargestPad = 0.020;
/// Between joints: what is aimed at, in pad radii, and the least that is let through.
constexpr double kWantedSpacing = 5, kLeastSpacing = 2.2;
/// Grippers that are chosen along one side at most: time grows with their number, and so does what a search
/// must find.
constexpr int kMostChosen = 9;
constexpr double kMillimetre = 1e-3;

std::string millimetres(double metres) {
  return fmt::format("{:g} mm", metres / kMillimetre);
}

ordered_json point(double x, double y) {
  return ordered_json::array({millimetres(x), millimetres(y)});
}

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

/// In whole millimetres, so that pads stay within the ply.
double rounded_down(double value) {
  return std::floor(value / kMillimetre + 1e-9) * kMillimetre;
}

/// A dome about the origin that is a little steeper towards one corner.
ordered_json polynomial_mold(double radius, const ordered_json& extent) {
  const auto term = [](int x, int y, double coefficient) {
    constexpr double kStep = 1e-3;
    return ordered_json{{"x", x}, {"y", y}, {"coefficient", rounded(coefficient, kStep)}};
  };
  const double bow = -0.5 / radius;
  return {{"shape", "polynomial"},
          {"extent", extent},
          {"unit", "1 m"},
          {"terms", {term(2, 0, bow), term(0, 2, bow), term(2, 1, 0.25 * bow / radius)}}};
}

ordered_json sphere_mold(double radius, const ordered_json& extent) {
  return {{"shape", "sphere"},
          {"extent", extent},
          {"centre", {"0 mm", "0 mm", millimetres(-rounded(radius, kMillimetre))}},
          {"radius", millimetres(rounded(radius, kMillimetre))}};
}

/// The middle of what a file covers [m]. @throws WrongInput with all that is wrong with it.
Eigen::Vector2d middle_of(const NewCase& wanted) {
  std::string fault;
  const std::optional<double> unit = parse_quantity(wanted.unit, Dimension::length, fault);
  if (!unit || !(*unit > 0)) throw WrongInput("--unit: " + (unit ? "must be > 0" : fault));
  const MoldReading reading = read_mold_file(wanted.mold_file, wanted.mold_file.string(),
                                             {.heights = wanted.mold == "height_field", .unit = *unit});
  std::string text;
  for (const InputError& error : reading.errors) text += (text.empty() ? "--mold: " : "\n") + error.text();
  if (!text.empty()) throw WrongInput(text);
  const Eigen::Vector2d middle = 0.5 * (reading.surface.extent.lower + reading.surface.extent.upper);
  return {rounded(middle.x(), kMillimetre), rounded(middle.y(), kMillimetre)};
}

/// As many along a side as there are wanted spacings between its outer pads.
int chosen_count(double side, double pad, double spacing) {
  return std::clamp(int(std::lround((side - 2 * pad) / spacing)) + 1, 2, kMostChosen);
}

/// Grid and pads: outer pads lie within the ply.
void place_grippers(const NewCase& wanted, ordered_json& grippers) {
  const double shorter = std::min(wanted.width, wanted.height),
               longer = std::max(wanted.width, wanted.height);
  const double pad = rounded_down(std::min(kPadShare * shorter, kLargestPad));
  const double aim = std::max(kWantedSpacing * pad, (longer - 2 * pad) / (kMostChosen - 1));
  const int columns = wanted.columns > 0 ? wanted.columns : chosen_count(wanted.width, pad, aim);
  const int rows = wanted.rows > 0 ? wanted.rows : chosen_count(wanted.height, pad, aim);
  double spacing = aim;
  if (columns > 1) spacing = (wanted.width - 2 * pad) / (columns - 1);
  if (rows > 1) spacing = std::min(columns > 1 ? spacing : aim, (wanted.height - 2 * pad) / (rows - 1));
  spacing = rounded_down(spacing);
  if (!(pad > 0) || spacing < kLeastSpacing * pad)
    throw WrongInput(
        fmt::format("--grippers: {} x {} pads of {} radius do not fit on a ply of {} x {}: their joints "
                    "would be {} apart",
                    columns, rows, millimetres(pad), millimetres(wanted.width), millimetres(wanted.height),
                    millimetres(spacing)));
  grippers["columns"] = columns;
  grippers["rows"] = rows;
  grippers["spacing"] = millimetres(spacing);
  grippers["pad_radius"] = millimetres(pad);
  grippers["source"] =
      "Assumed, put yours in place: the grid, chosen so that the outer pads lie within the ply; pads; "
      "joints, force and "
      "velocity limits. `interlinks` are bars between neighbouring joints, here as long as the mapped "
      "distance of the "
      "joints; false: none";
}

/// Values without depth, and lists of such, stand on one line; a long list has a line for each of its
/// entries.
bool on_one_line(const ordered_json& value, bool listed) {
  if (value.is_primitive() || value.empty()) return true;
  if (value.is_object() && !listed) return false;
  constexpr size_t kLongList = 2;
  if (value.is_array() && value.size() > kLongList && !value.front().is_primitive()) return false;
  return std::all_of(value.begin(), value.end(),
                     [](const ordered_json& one) { return on_one_line(one, true); });
}

std::string text_of(const ordered_json& value, size_t indent, bool listed) {
  if (value.is_primitive()) return value.dump();
  const bool line = on_one_line(value, listed), object = value.is_object();
  const std::string begin = line ? "" : "\n" + std::string(indent + 2, ' ');
  std::string text;
  for (const auto& [key, one] : value.items()) {
    text += (text.empty() ? "" : line ? ", " : ",") + begin;
    if (object) text += ordered_json(key).dump() + ": ";
    text += text_of(one, indent + 2, !object);
  }
  if (!line) text += "\n" + std::string(indent, ' ');
  return (object ? "{" : "[") + text + (object ? "}" : "]");
}

}  // namespace

ordered_json new_case(const NewCase& wanted, const std::filesystem::path& folder) {
  ordered_json value = ordered_json::parse(kNewCase);
  const double longer = std::max(wanted.width, wanted.height);
  const double x = rounded(0.5 * wanted.width + kMargin * longer, kMillimetre);
  const double y = rounded(0.5 * wanted.height + kMargin * longer, kMillimetre);
  const ordered_json extent = ordered_json::array({point(-x, x), point(-y, y)});
  Eigen::Vector2d middle(0, 0);
  if (wanted.mold == "polynomial") {
    value["mold"] = polynomial_mold(kDomeRadius * longer, extent);
  } else if (wanted.mold == "sphere") {
    value["mold"] = sphere_mold(kDomeRadius * longer, extent);
  } else {
    middle = middle_of(wanted);
    std::error_code error;
    const std::filesystem::path file = std::filesystem::relative(wanted.mold_file, folder, error);
    value["mold"] = {{"shape", wanted.mold},
                     {"file", error || file.empty() ? wanted.mold_file.string() : file.string()},
                     {"unit", wanted.unit}};
  }
  value["ply"] = {{"width", millimetres(wanted.width)},
                  {"height", millimetres(wanted.height)},
                  {"position", point(middle.x(), middle.y())}};
  value["mapping"]["start"] = point(middle.x(), middle.y());
  value["material"] = ordered_json::parse(kNewCaseMaterial);
  place_grippers(wanted, value["grippers"]);
  return value;
}

std::string case_text(const ordered_json& value) {
  return text_of(value, 0, false) + "\n";
}

}  // namespace drapeplan
