#include "planner/case/checks.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>

#include "mapping/polyline.hpp"
#include "planner/base/json_text.hpp"
#include "planner/case/design.hpp"

namespace drapeplan {
namespace {

constexpr double kSlack = 1e-9;     // [m] or cells, so that what fits exactly fits
constexpr double kMostCells = 4e6;  // of a net or mesh; far above use, below what fills the memory

bool on_ply(const Ply& ply, const Eigen::Vector2d& place) {
  return contains(corners_of(ply), place, kSlack);
}

std::string place_text(const Eigen::Vector2d& place) {
  return fmt::format("({}, {})", format_quantity(place.x(), Dimension::length),
                     format_quantity(place.y(), Dimension::length));
}

std::string ply_text(const Ply& ply) {
  const Eigen::AlignedBox2d box = bounding_box(corners_of(ply));
  return fmt::format("{} reaches from {} to {}", ply.outline.empty() ? "the ply" : "the ply's outline",
                     place_text(box.min()), place_text(box.max()));
}

/// Without an outline a ply is a rectangle, whose size must be stated.
void check_ply(const CaseFields& fields, FieldReader& reader) {
  const Polygon& outline = fields.definition.ply.outline;
  const bool stated_well = reader.good("/ply");
  for (const auto& [name, size] : {std::pair{"width", fields.width}, {"height", fields.height}}) {
    if (!outline.empty() && size)
      reader.fail(fmt::format("/ply/{}", name),
                  "belongs to a ply without an outline; the outline says the size");
    if (outline.empty() && !size && stated_well)
      reader.fail("/ply",
                  fmt::format("\"{}\" is missing; a ply has either width and height or an outline", name));
  }
  if (outline.empty() || !reader.good("/ply/outline")) return;
  if (const auto edges = crossing_edges(outline)) {
    const auto edge = [](size_t k) { return fmt::format("the edge from point {}", k + 1); };
    const auto [i, j] = *edges;
    reader.fail("/ply/outline",
                i == j ? edge(i) + " has no length"
                       : fmt::format("the outline crosses or touches itself: {} meets {}", edge(i), edge(j)));
  }
}

void check_on_ply(FieldReader& reader, const std::string& pointer, const Ply& ply,
                  const Eigen::Vector2d& place) {
  if (reader.good(pointer) && !on_ply(ply, place))
    reader.fail(pointer, "lies outside the ply; " + ply_text(ply));
}

void check_cells(FieldReader& reader, const std::string& pointer, const Ply& ply, double size) {
  const double cells = std::ceil(ply.width / size - kSlack) * std::ceil(ply.height / size - kSlack);
  if (reader.good(pointer) && !(cells <= kMostCells)) {
    reader.fail(pointer,
                fmt::format("would make {:.0f} cells of this ply; allowed: {:.0f}", cells, kMostCells));
  }
}

/// Lines of steered generators lead through the place where the mapping starts.
void check_lines(const MappingOptions& mapping, FieldReader& reader) {
  if (mapping.generators != Generators::steered) return;
  if (mapping.warp_line.empty() && mapping.weft_line.empty())
    reader.fail("/mapping/generators", "needs a warp_line or a weft_line");
  for (const auto& [name, line] : {std::pair{"warp_line", &mapping.warp_line}, {"weft_line", &mapping.weft_line}}) {
    const std::string pointer = fmt::format("/mapping/{}", name);
    if (line->empty() || !reader.good(pointer)) continue;
    const double beside = (nearest_on_polyline(mapping.start, *line).place - mapping.start).norm();
    if (!(beside <= kOffLine))
      reader.fail(pointer, fmt::format("passes {:.3g} mm beside mapping.start, {}; allowed: {}", 1e3 * beside,
                                       place_text(mapping.start), format_quantity(kOffLine, Dimension::length)));
  }
}

void check_mapping(const CaseFields& fields, FieldReader& reader) {
  const auto& mapping = fields.definition.mapping;
  if (!mapping || !reader.good("/mapping")) return;
  check_cells(reader, reader.good("/mapping/cell_size") ? "/mapping/cell_size" : "/mapping",
              fields.definition.ply, mapping->cell_size);
  const bool start_stated = reader.good("/mapping/ply_start");
  if (!on_ply(fields.definition.ply, mapping->ply_start)) {
    reader.fail(
        start_stated ? "/mapping/ply_start" : "/mapping",
        fmt::format("{} outside the ply; {}", start_stated ? "lies" : "its ply_start, the ply's origin, lies",
                    ply_text(fields.definition.ply)));
  }
  if (!fields.mold || !reader.good("/mold")) return;
  const Extent& extent = fields.mold->extent;
  const bool inside = (mapping->start.array() >= extent.lower.array()).all() &&
                      (mapping->start.array() <= extent.upper.array()).all();
  if (inside) return check_lines(*mapping, reader);
  const bool stated = reader.good("/mapping/start");
  reader.fail(stated ? "/mapping/start" : "/ply",
              fmt::format("{} outside the mold's extent",
                          stated ? "lies" : "its position, where the mapping starts, lies"));
}

void check_rotation_limits(const RigOptions& rig, FieldReader& reader) {
  if (!rig.rotation_limits || !reader.good("/grippers/rotation_limits")) return;
  const auto check = [&reader](const std::string& name, const Eigen::Vector2d& range) {
    const std::string pointer = "/grippers/rotation_limits/" + name;
    if (reader.good(pointer) && !(range[0] <= 0 && range[1] >= 0))
      reader.fail(pointer, "excludes the flat start; allowed: least <= 0 deg <= largest");
  };
  check("about_warp", rig.rotation_limits->about_warp);
  check("about_weft", rig.rotation_limits->about_weft);
}

/// Without a blend every change of velocity is a jump.
void check_acceleration(const RigOptions& rig, FieldReader& reader) {
  const std::string pointer = "/grippers/max_acceleration";
  if (rig.max_acceleration && !(rig.blend_time > 0) && reader.good(pointer))
    reader.fail(pointer, "needs a grippers.blend_time > 0 s");
}

void check_interlinks(const CaseFields& fields, FieldReader& reader) {
  const std::string pointer = "/grippers/interlinks";
  const RigOptions& rig = *fields.definition.grippers;
  if (!rig.interlinks || !reader.good(pointer)) return;
  const Eigen::Vector2d& closing = fields.definition.interlink_closing;
  if (!(closing[0] < closing[1])) reader.fail(pointer + "/closing", "expected the earlier share first");
  const InterlinkLength& length = fields.definition.interlink_length;
  if (length.source != InterlinkLength::Source::given || length.same > 0) return;
  const auto check = [&](const auto& rows, int count, int of_row, const char* k) {
    const bool whole = int(rows.size()) == count &&
                       std::all_of(rows.begin(), rows.end(),
                                   [of_row](const auto& row) { return int(row.size()) == of_row; });
    if (!whole)
      reader.fail(pointer + "/length/" + k, fmt::format("expected {} rows of {} lengths", count, of_row));
  };
  check(length.warp, rig.rows, rig.columns - 1, "0");
  check(length.weft, rig.rows - 1, rig.columns, "1");
}

void check_grippers(const CaseFields& fields, FieldReader& reader) {
  if (!fields.definition.grippers || !reader.good("/grippers")) return;
  const RigOptions& rig = *fields.definition.grippers;
  for (int g = rig.count() - 1; g >= 0 && reader.good("/ply"); --g) {
    if (on_ply(fields.definition.ply, rig.place(g))) continue;
    reader.fail("/grippers/spacing",
                fmt::format("gripper {} is off the ply: its pad's centre lies at {}; {}", rig.name(g),
                            place_text(rig.place(g)), ply_text(fields.definition.ply)));
    break;
  }
  if (rig.count() > 1 && rig.spacing < 2 * rig.pad_radius) {
    reader.fail("/grippers/spacing", "the pads overlap; allowed: at least twice pad_radius, " +
                                         format_quantity(2 * rig.pad_radius, Dimension::length));
  }
  check_rotation_limits(rig, reader);
  check_acceleration(rig, reader);
  check_interlinks(fields, reader);
  if (rig.driven == Driven::xyz) {
    if (rig.interlinks)
      reader.fail("/grippers/driven",
                  "joints that are driven in x and y cannot have interlinks: set "
                  "\"interlinks\": false, or \"driven\": \"z\"");
    if (rig.fixed)
      reader.fail("/grippers/driven",
                  "joints that are driven in x and y cannot be fixed: leave out \"fixed\", "
                  "or set \"driven\": \"z\"");
  }
  if (!rig.fixed) return;
  const auto [i, j] = *rig.fixed;
  if (i < 1 || i > rig.columns || j < 1 || j > rig.rows) {
    reader.fail("/grippers/fixed",
                "there is no such gripper; allowed: [1, 1] to " + rig.name(rig.count() - 1));
  }
}

/// Both ends and the middle of a gripped piece lie on the outline, so all of it does, but for a notch
/// between.
void check_grips(const CaseFields& fields, FieldReader& reader) {
  std::set<std::string> names;
  for (size_t k = 0; k < fields.definition.grips.size(); ++k) {
    const GripOptions& grip = fields.definition.grips[k];
    const std::string pointer = fmt::format("/grips/{}", k);
    if (reader.good(pointer + "/name") && !names.insert(grip.name).second)
      reader.fail(pointer + "/name", "another grip has the same name");
    if (!reader.good("/ply") || !reader.good(pointer + "/from") || !reader.good(pointer + "/to")) continue;
    if ((grip.to - grip.from).norm() <= kOnOutline) reader.fail(pointer, "its ends coincide");
    const Polygon outline = corners_of(fields.definition.ply);
    const auto off = [&outline](const Eigen::Vector2d& place) {
      return (nearest_on_edges(outline, place) - place).norm() > kOnOutline;
    };
    if (off(grip.from)) reader.fail(pointer + "/from", "lies off the ply's outline");
    if (off(grip.to)) reader.fail(pointer + "/to", "lies off the ply's outline");
    if (!off(grip.from) && !off(grip.to) && off(0.5 * (grip.from + grip.to)))
      reader.fail(pointer, "is no straight piece of the ply's outline");
  }
}

void check_press(const CaseFields& fields, FieldReader& reader) {
  const std::optional<PressOptions>& press = fields.definition.press;
  if (!press || !reader.good("/press")) return;
  if (press->load.ramp > press->load.duration) {
    const std::string pointer = reader.good("/press/ramp") ? "/press/ramp" : "/press/duration";
    reader.fail(pointer, "the ramp is longer than the whole press; allowed: at most its duration, " +
                             format_quantity(press->load.duration, Dimension::time));
  }
  if (fields.definition.grippers) return;
  if (press->pads == PressOptions::Pads::released)
    reader.fail("/press/pads", "there are no grippers to let go");
  if (press->objective == PressOptions::Objective::before)
    reader.fail("/press/objective", "without grippers nothing is scored");
}

void check_probes(const CaseFields& fields, FieldReader& reader) {
  std::set<std::string> names;
  for (const GripOptions& grip : fields.definition.grips) names.insert(grip.name);
  for (size_t k = 0; k < fields.definition.probes.size(); ++k) {
    const Probe& probe = fields.definition.probes[k];
    const std::string pointer = fmt::format("/probes/{}", k);
    if (reader.good(pointer + "/name") && !names.insert(probe.name).second) {
      reader.fail(pointer + "/name", "another probe or grip has the same name");
    }
    if (reader.good("/ply")) check_on_ply(reader, pointer + "/place", fields.definition.ply, probe.place);
  }
}

/// Their names become parts of the names of files: profile_NAME.csv, .svg, and profile_NAME_heights.svg.
void check_profiles(const CaseFields& fields, FieldReader& reader) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_';
  };
  std::set<std::string> names;
  for (size_t k = 0; k < fields.definition.profiles.size(); ++k) {
    const Profile& profile = fields.definition.profiles[k];
    const std::string pointer = fmt::format("/profiles/{}", k);
    if (reader.good(pointer + "/name")) {
      constexpr size_t kLongest = 100;  // systems allow 255 bytes for the whole name of a file
      if (profile.name.empty() || profile.name.size() > kLongest ||
          !std::all_of(profile.name.begin(), profile.name.end(), plain))
        reader.fail(pointer + "/name",
                    fmt::format("is part of a file's name; allowed: letters, digits, - and _, up to {}", kLongest));
      else if (!names.insert(profile.name).second || !names.insert(profile.name + "_heights").second)
        reader.fail(pointer + "/name", "another profile has the same name, or its chart of heights has it");
    }
    if (!reader.good(pointer + "/from") || !reader.good(pointer + "/to")) continue;
    if ((profile.to - profile.from).norm() <= kSlack)
      reader.fail(pointer + "/to", "is the point that the line starts from");
    if (profile.frame != Profile::Frame::ply || !reader.good("/ply")) continue;
    check_on_ply(reader, pointer + "/from", fields.definition.ply, profile.from);
    check_on_ply(reader, pointer + "/to", fields.definition.ply, profile.to);
  }
}

void check_instants(const CaseFields& fields, FieldReader& reader) {
  std::set<std::string> names;
  for (size_t k = 0; k < fields.definition.instants.size(); ++k) {
    const std::string pointer = fmt::format("/instants/{}/name", k);
    if (reader.good(pointer) && !names.insert(fields.definition.instants[k].name).second)
      reader.fail(pointer, "another instant has the same name");
  }
}

/// Faster rates are resisted more: what is weaker the faster it goes would feed every vibration.
void check_rates(FieldReader& reader, const std::string& mode, const CurveFields& fields) {
  const std::string pointer = fmt::format("/material/{}/rates", mode);
  if (fields.rates.empty() || !reader.good("/material/" + mode)) return;
  const StressTable table = stress_table(fields);
  for (size_t k = 1; k < fields.rates.size(); ++k) {
    const std::string place = fmt::format("{}/{}", pointer, k);
    if (!(table.rates[k] > table.rates[k - 1])) {
      reader.fail(place + "/rate", "rates must increase");
      continue;
    }
    std::vector<double> strains = table.curves[k].strain;
    strains.insert(strains.end(), table.curves[k - 1].strain.begin(), table.curves[k - 1].strain.end());
    constexpr double kSlackShare = 1e-9;  // round-off of factors
    for (const double strain : strains) {
      const double slow = table.curves[k - 1](strain), fast = table.curves[k](strain);
      if (fast >= slow * (1 - kSlackShare)) continue;
      reader.fail(place, fmt::format("at strain {:f} its stress is below that of the slower rate", strain));
      break;
    }
  }
}

/// A ply that is mapped is measured there, with a warning; one that is only laid down must lie on the mold.
void check_on_mold(const CaseFields& fields, FieldReader& reader) {
  const Case& c = fields.definition;
  if (!fields.mold || !fields.material || c.mapping || !reader.good("/mold")) return;
  const Extent& extent = fields.mold->extent;
  double beyond = 0;
  for (const Eigen::Vector2d& corner : corners_of(c.ply)) {
    const Eigen::Vector2d xy = c.ply.position + Eigen::Rotation2Dd(c.ply.angle) * corner;
    beyond = std::max({beyond, (extent.lower - xy).maxCoeff(), (xy - extent.upper).maxCoeff()});
  }
  if (beyond > kSlack)
    reader.fail("/mold/extent",
                fmt::format("the flat ply reaches {} beyond it: there is no mold under its edge",
                            format_quantity(beyond, Dimension::length)));
}

/// Curves are sampled over all that they reach: what no fibre and no fabric can do is a wrong unit.
void check_reach(FieldReader& reader, const std::string& mode, const CurveFields& fields) {
  const bool angle = mode == "shear";
  const double most = angle ? 0.5 * std::numbers::pi : 1.0;
  const auto check = [&](const std::string& pointer, const Curve& curve) {
    if (!reader.good(pointer) || curve.strain.empty() || curve.strain.back() <= most) return;
    reader.fail(pointer, angle ? "reaches beyond a shear of 90 deg" : "reaches beyond a strain of 100 %");
  };
  const auto place = [&](const std::string& at) {
    return reader.good(at + "/file") ? at + "/file" : at + "/points";
  };
  const std::string pointer = "/material/" + mode;
  check(place(pointer), fields.curve);
  for (size_t k = 0; k < fields.rates.size(); ++k)
    check(place(fmt::format("{}/rates/{}", pointer, k)), fields.rates[k].curve);
}

void check_material(const CaseFields& fields, FieldReader& reader) {
  if (!fields.material) return;
  const MaterialFields& material = *fields.material;
  if (material.law == 0) {
    check_reach(reader, "tension", material.tension);
    check_reach(reader, "compression", material.compression);
    check_reach(reader, "shear", material.shear);
    check_rates(reader, "tension", material.tension);
    check_rates(reader, "compression", material.compression);
    check_rates(reader, "shear", material.shear);
    if (fields.damping && fields.damping->by == 1 && !fields.damping->modulus && reader.good("/damping"))
      reader.fail("/damping",
                  "\"modulus\" is missing (the law is not linear, so it cannot be taken from it)");
  }
}

}  // namespace

void check_case(const CaseFields& fields, FieldReader& reader) {
  const Case& c = fields.definition;
  check_ply(fields, reader);
  check_material(fields, reader);
  check_grippers(fields, reader);
  check_grips(fields, reader);
  check_press(fields, reader);
  check_probes(fields, reader);
  check_profiles(fields, reader);
  check_instants(fields, reader);
  check_design(fields.definition.optimise.design, reader);
  if (reader.good("/optimise") && c.optimise.longest_sequence < c.optimise.shortest_stroke) {
    reader.fail("/optimise", "longest_sequence is shorter than shortest_stroke");
  }
  if (!reader.good("/ply")) return;
  if (c.start == Start::on_mold && reader.good("/ply/start") && (!fields.mold || c.grippers)) {
    reader.fail("/ply/start",
                "needs a mold and no grippers; with grippers the schedule says where the ply starts");
  }
  check_mapping(fields, reader);
  check_on_mold(fields, reader);
  check_on_ply(reader, "/schedule/wave/start", c.ply, c.schedule.wave_start);
  if (reader.good("/fem")) check_cells(reader, "/fem/mesh_size", c.ply, fields.fem.mesh_size);
  for (const auto& [name, options] : c.fidelities) {
    check_cells(reader, fmt::format("/fidelities{}/mesh_size", pointer_token(name)), c.ply,
                options.mesh_size);
  }
}

}  // namespace drapeplan
