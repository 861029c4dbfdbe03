#include "planner/case/section_fields.hpp"

#include <fmt/format.h>

#include "planner/base/quantity.hpp"
#include "planner/input/kit.hpp"

namespace drapeplan {
namespace {

void visit_curve(FieldVisitor& v, CurveFields& fields, Dimension abscissa) {
  v.field({"points",
           Table{&fields.curve, abscissa},
           "Rows [strain, stress]; the first row names the units, the second is [0, 0]; strains increase, "
           "stresses "
           "do not decrease; straight between rows, and beyond the last one with the last slope",
           Dimension::none,
           {},
           false,
           "needed without `file`"});
  v.field(
      {"file", &fields.file,
       "Text table that holds the points instead, relative to the file that names it (with --set: to the "
       "case): "
       "columns of strain and stress with units, as programs write them. Up to 100 rows that never fall are "
       "taken as they are; others are smoothed, and the source says what the curve misses"});
  const bool named = !fields.columns.strain.empty() || !fields.columns.stress.empty();
  v.section(
      {"columns", "What columns of tables are called, where that is not usual", false, {}, true}, named, [&] {
        v.field({"strain", &fields.columns.strain, "Name of the column of strains, or of shear angles"});
        v.field({"stress", &fields.columns.stress, "Name of the column of stresses"});
      });
  v.field({"factor", &fields.factor, "All stresses are multiplied by it", Dimension::none, positive()});
  v.field({"source", &fields.source, "What was measured, by whom, and what is assumed"});
  v.field({"valid_to", &fields.valid_to,
           "How far the curve was measured and holds; a drape that goes beyond it says so", abscissa,
           positive(), false, "not known"});
  v.field({"band", &fields.band, "R.m.s. of what specimens differ from the curve, as a share of its stress",
           Dimension::none, from(0), false, "not known"});
  ObjectList rates = object_list(
      "rates", "Curves by the rate of strain, slowest first; absent: no dependence on the rate", fields.rates,
      [&v, abscissa](RateFields& rate) {
        v.field({"rate", &rate.rate, "Of growing strain; slower and faster than all: constant",
                 Dimension::rate, from(0), true});
        v.field({"factor", &rate.factor, "Stresses of this rate are multiplied by it", Dimension::none,
                 positive()});
        Field points{"points", Table{&rate.curve, abscissa}, "Curve at this rate"};
        points.default_words = "the points of the mode";
        v.field(points);
        v.field({"file", &rate.file, "Text table that holds the points instead, see `file` of the mode"});
      });
  v.list(rates);
}

/// Reads the tables of one mode.
class CurveFiles {
 public:
  CurveFiles(CurveFields& fields, Dimension abscissa, std::string pointer, FieldReader& reader,
             std::vector<std::string>& notes)
      : fields_(fields), abscissa_(abscissa), pointer_(std::move(pointer)), reader_(reader), notes_(notes) {}

  void read() {
    if (!reader_.good(pointer_)) return;
    bool needed = fields_.rates.empty();
    for (size_t k = 0; k < fields_.rates.size(); ++k) {
      RateFields& rate = fields_.rates[k];
      needed = needed || (rate.file.empty() && rate.curve.strain.empty());
      read(rate.file, rate.curve, fmt::format("{}/rates/{}", pointer_, k),
           fmt::format("at {}, ", format_quantity(rate.rate, Dimension::rate)));
    }
    if (needed && fields_.file.empty() && fields_.curve.strain.empty())
      reader_.add_error(pointer_, "\"points\" is missing; a curve has either points or a file");
    read(fields_.file, fields_.curve, pointer_, "");
  }

 private:
  void read(std::string& file, Curve& curve, const std::string& pointer, const std::string& which) {
    if (file.empty()) return;
    if (!curve.strain.empty())
      return reader_.fail(pointer + "/file",
                          "belongs to a curve without points; these would be read from it");
    CurveReading reading = read_curve(reader_.file_at(pointer + "/file", file), abscissa_, fields_.columns);
    if (!reading.errors.empty()) return reader_.add_errors(pointer + "/file", reading.errors);
    curve = std::move(reading.curve);
    const std::string text = fit_text(file, reading.fit);
    fields_.source += fmt::format("{}Points: {}{}", fields_.source.empty() ? "" : ". ", which, text);
    if (reading.fit.knots > 0) notes_.push_back(fmt::format("{}: {}", pointer, text));
    file.clear();
  }

  CurveFields& fields_;
  Dimension abscissa_;
  std::string pointer_;
  FieldReader& reader_;
  std::vector<std::string>& notes_;
};

void visit_interlinks(FieldVisitor& v, InterlinkOptions& links, Case& c) {
  InterlinkLength& length = c.interlink_length;
  v.field(
      {"length",
       WordOrRows{choice(length.source, {"spacing", "mapped"}), &length.same, {&length.warp, &length.weft}},
       "Once they are closed: as the `spacing`; `mapped`: each as long as the distance of its joints with "
       "both pads on their targets; one length; or two lists of rows, of those along the warp (a row of "
       "columns - 1 for each row of grippers) and along the weft (a row of columns for each gap between "
       "rows)",
       Dimension::length, positive(kLargestLength)});
  v.field({"closing", &c.interlink_closing,
           "Shares of the preshape between which they go from the spacing to their length", Dimension::none,
           from(0, 1)});
  v.field({"play", &links.play,
           "[shorter, longer]: stops so far from the length, free between them (telescopic)",
           Dimension::length, from(0, 1)});
  v.field({"stiffness", &links.stiffness, "Of a spring in place of the rigid bar, or of the stops",
           Dimension::line_stiffness, from(0), false, "absent: rigid"});
  v.field({"damping_ratio", &links.damping_ratio, "Of two bare pads on that spring; 1: they do not ring",
           Dimension::none, from(0, 1e3)});
}

}  // namespace

void visit_material(FieldVisitor& v, MaterialFields& m) {
  v.field({"name", &m.name, "What the material is called"});
  v.field({"source", &m.source, "Where the figures come from"});
  v.field({"law", choice(m.law, {"tables", "linear"}),
           "`tables`: measured curves per mode; `linear`: straight ones from moduli"});
  v.field({"thickness", &m.thickness, "Of the ply", Dimension::length, positive(0.05), true});
  v.field(
      {"areal_density", &m.areal_density, "Mass per area", Dimension::areal_density, positive(100), true});
  v.field({"transverse_shear_modulus", &m.transverse_shear_modulus, "G13 = G23", Dimension::stress,
           positive(), true});
  v.alternative("law", "tables", m.law == 0, [&] {
    v.section({"tension", "Nominal fibre stress over nominal strain", true}, true,
              [&] { visit_curve(v, m.tension, Dimension::strain); });
    v.section({"compression", "Fibre in compression, magnitudes", true}, true,
              [&] { visit_curve(v, m.compression, Dimension::strain); });
    v.section({"shear", "Shear stress over shear angle", true}, true, [&] {
      visit_curve(v, m.shear, Dimension::angle);
      v.field({"measure", choice(m.shear_measure, {"conjugate", "force"}),
               "`conjugate`: stress times rate of the angle is power per volume; `force`: shear force per "
               "length over thickness, which is the conjugate stress over the cosine of the angle"});
    });
    v.field({"rate_floor", &m.rate_floor,
             "Between two rates stresses are linear in log(1 + rate / floor): slower rates count linearly, "
             "faster ones in the logarithm",
             Dimension::rate, positive()});
    v.field({"rate_filter", &m.rate_filter, "Time constant over which rates are averaged", Dimension::time,
             positive()});
  });
  v.alternative("law", "linear", m.law == 1, [&] {
    v.field({"modulus", &m.modulus, "Fibre modulus, the same in tension and compression", Dimension::stress,
             positive(), true});
    v.field({"shear_modulus", &m.shear_modulus, "Shear stress over shear angle", Dimension::stress, from(0),
             true});
  });
}

std::vector<std::string> read_curve_files(MaterialFields& material, const std::string& pointer,
                                          FieldReader& reader) {
  std::vector<std::string> notes;
  if (material.law != 0) return notes;
  CurveFiles(material.tension, Dimension::strain, pointer + "/tension", reader, notes).read();
  CurveFiles(material.compression, Dimension::strain, pointer + "/compression", reader, notes).read();
  CurveFiles(material.shear, Dimension::angle, pointer + "/shear", reader, notes).read();
  return notes;
}

void visit_damping(FieldVisitor& v, DampingFields& d) {
  v.field({"by", choice(d.by, {"alpha", "strip"}),
           "`alpha`: the rate itself; `strip`: from the lowest frequency of a clamped strip"});
  v.alternative("by", "alpha", d.by == 0, [&] {
    v.field({"alpha", &d.alpha,
             "Rate, of the unscaled ply: twice the damping ratio times the lowest angular frequency",
             Dimension::rate, from(0, 1e6), true});
  });
  v.alternative("by", "strip", d.by == 1, [&] {
    v.field({"ratio", &d.ratio, "Damping ratio of the strip; 1 is critical", Dimension::none, from(0, 100)});
    v.field(
        {"length", &d.length, "Free length of the strip", Dimension::length, positive(kLargestLength), true});
    Field modulus{"modulus", &d.modulus, "Static bending modulus of the ply", Dimension::stress, positive()};
    modulus.default_words = "material.modulus of a linear law";
    v.field(modulus);
  });
}

void visit_grippers(FieldVisitor& v, RigOptions& g, Case& c) {
  v.field({"columns", &g.columns, "Grippers along the warp", Dimension::none, from(1, 100), true});
  v.field({"rows", &g.rows, "Grippers along the weft", Dimension::none, from(1, 100), true});
  v.field({"spacing", &g.spacing, "Between neighbouring joints; the grid is centred on the ply",
           Dimension::length, positive(kLargestLength), true});
  v.field(
      {"pad_radius", &g.pad_radius, "Rigid disc that is tied to the ply", Dimension::length, positive(1)});
  v.field({"pad_mass", &g.pad_mass, "Moving mass of one gripper", Dimension::mass, positive(1e3)});
  v.field({"joint_offset", &g.joint_offset, "Height of the joint above the ply, along the pad's normal",
           Dimension::length, from(0, 1)});
  v.field({"tilt_limit",
           &g.tilt_limit,
           "Largest angle between the pad's normal and the vertical",
           Dimension::angle,
           {0, kRightAngle, true, true}});
  const Range turn{-kRightAngle, kRightAngle};
  optional_section(
      v,
      {"rotation_limits",
       "Least and largest rotation of a pad about the in-plane axes of the ply in the flat start; both hold "
       "0"},
      g.rotation_limits, RotationLimits(), [&](RotationLimits& limits) {
        v.field({"about_warp", &limits.about_warp,
                 "[least, largest]; > 0: the pad's normal leans towards -v. atan2(-n_v, n_z) of the normal n",
                 Dimension::angle, turn});
        v.field({"about_weft", &limits.about_weft,
                 "[least, largest]; > 0: the pad's normal leans towards +u. atan2(n_u, n_z) of the normal n",
                 Dimension::angle, turn});
      });
  v.field({"driven", choice(g.driven, {"z", "xyz"}),
           "Directions in which actuators drive the joints; `xyz` without interlinks and fixed joint"});
  Section links{"interlinks", "What joins neighbouring joints; `true`: rigid bars as long as the spacing"};
  links.flag = true;
  optional_section(v, links, g.interlinks, InterlinkOptions(),
                   [&](InterlinkOptions& options) { visit_interlinks(v, options, c); });
  v.field(
      {"fixed", &g.fixed, "Gripper [i, j] whose joint is fixed in-plane; i counts along the warp, from 1"});
  v.field({"actuator_stiffness", &g.actuator_stiffness,
           "Between the commanded and the true place of a joint, in each driven direction",
           Dimension::line_stiffness, positive()});
  v.field({"actuator_force_limit", &g.actuator_force_limit,
           "Largest force of an actuator, in each driven direction", Dimension::force, positive()});
  v.field({"max_velocity", &g.max_velocity, "Largest velocity of a joint, vertical or in-plane",
           Dimension::velocity, positive()});
  v.field({"max_acceleration", &g.max_acceleration, "Largest acceleration of a joint, vertical or in-plane",
           Dimension::acceleration, positive(), false, "absent: no limit"});
  v.field({"blend_time", &g.blend_time, "Time over which a change of velocity is spread", Dimension::time,
           from(0)});
  v.field({"release_time", &g.release_time,
           "From the end of the last stroke until the suction of all grippers ends", Dimension::time, from(0),
           false, "absent: the ply is held to the end"});
}

}  // namespace drapeplan
