#include "planner/case/fields.hpp"

#include <cmath>

#include "planner/case/section_fields.hpp"
#include "planner/input/kit.hpp"

namespace drapeplan {
namespace {

constexpr double kLargestTack = 1e8;      // [Pa]; beyond any glue
constexpr double kLargestPressure = 1e7;  // [Pa]; ten times that of an autoclave

void visit_ply(FieldVisitor& v, CaseFields& fields) {
  Ply& ply = fields.definition.ply;
  Start& start = fields.definition.start;
  v.field({"width", &fields.width, "Size along the warp (u); the origin of (u, v) is in the middle",
           Dimension::length, positive(kLargestLength), false, "needed without `outline`"});
  v.field({"height", &fields.height, "Size along the weft (v)", Dimension::length, positive(kLargestLength),
           false, "needed without `outline`"});
  v.field(
      {"outline", PointList{&ply.outline},
       "Corners (u, v) of a ply that is no upright rectangle, in order, either way round; instead of `width` "
       "and `height`",
       Dimension::length, from(-kLargestLength, kLargestLength), false, "absent: a rectangle"});
  v.field(
      {"position", &ply.position, "Place (x, y) of the origin of (u, v) before draping", Dimension::length});
  v.field({"angle", &ply.angle, "Warp direction, from +x towards +y", Dimension::angle});
  v.field({"start", choice(start, {"level", "on_mold"}),
           "Without grippers: `level` at start_height, or laid `on_mold`, flat in its tangent plane at "
           "`position`"});
}

void visit_grip(FieldVisitor& v, GripOptions& grip) {
  v.field({"name", &grip.name, "Name in the results, among those of the probes", Dimension::none, {}, true});
  v.field({"from",
           &grip.from,
           "One end of the piece (u, v), on the outline to 10 um",
           Dimension::length,
           {},
           true});
  v.field({"to", &grip.to, "Its other end, on the same edge", Dimension::length, {}, true});
  v.field(
      {"velocity", &grip.velocity, "Of the clamp (x, y, z), reached after the ramp", Dimension::velocity});
  v.field({"ramp", &grip.ramp, "Time from rest to the velocity, with continuous acceleration",
           Dimension::time, positive(1e5)});
}

void visit_mapping(FieldVisitor& v, MappingOptions& m) {
  v.field(
      {"generators", choice(m.generators, {"perpendicular", "axes", "mid_sides", "minimum_shear", "steered"}),
       "Fibre lines through the start point: geodesics at right angles; along the projected warp and weft; "
       "towards the mid-sides of the mold; at right angles at the start, and on where the cells beside each step are "
       "sheared least; or along lines that are given"});
  v.alternative("generators", "steered", m.generators == Generators::steered, [&] {
    const auto line = [&v](const char* name, const char* doc, std::vector<Eigen::Vector2d>& points) {
      v.field({name, PointList{&points, 2}, doc, Dimension::length, {}, false,
               "absent: a geodesic, at right angles to the other line"});
    };
    line("warp_line",
         "Points (x, y) of the mold under the warp through the start point, in the order of growing u; straight in "
         "plan between them, beyond the ends a geodesic",
         m.warp_line);
    line("weft_line", "The same of the weft, in the order of growing v", m.weft_line);
  });
  Field start{"start", &m.start, "Point (x, y) of the mold where the mapping starts", Dimension::length};
  start.default_words = "ply.position";
  v.field(start);
  v.field({"ply_start", &m.ply_start, "Point (u, v) of the ply that is placed there", Dimension::length});
  v.field({"cell_size", &m.cell_size, "Largest edge of a net cell", Dimension::length, from(1e-4, 1)});
}

void visit_schedule(FieldVisitor& v, ScheduleOptions& s) {
  v.field({"aim", choice(s.aim, {"mapped", "reachable"}),
           "Commanded heights end above the mapped targets, or above the places that the rig can reach"});
  v.field({"preshape_height", &s.preshape_height, "Of all grippers above their targets after the preshape",
           Dimension::length, from(0, kLargestLength)});
  v.field({"preshape_duration", &s.preshape_duration, "Time of the preshape", Dimension::time, positive()});
  v.field({"overtravel", &s.overtravel, "Commanded depth below the target, so that pads are pressed down",
           Dimension::length, from(0, 1)});
  v.field({"settle", &s.settle, "Time at rest at the end", Dimension::time, from(0)});
  v.section({"uniform", "All grippers at once", false, {}, true}, true, [&] {
    v.field({"duration", &s.uniform_duration, "From the preshape to the mold", Dimension::time, positive()});
  });
  v.section({"wave", "Rings of grippers, one after another", false, {}, true}, true, [&] {
    v.field({"duration", &s.wave_duration, "Stroke of one group", Dimension::time, positive()});
    v.field({"delay", &s.wave_delay, "Between one group and the next", Dimension::time, from(0)});
    v.field({"delay_from", choice(s.wave_delay_from, {"start", "end"}),
             "The delay counts from the start or the end of the group before"});
    v.field({"start", &s.wave_start, "Where the wave starts, in the ply (u, v)", Dimension::length});
  });
}

void visit_press(FieldVisitor& v, PressOptions& p) {
  v.field({"pressure", &p.load.pressure,
           "On the ply, normal to it, towards the mold; a vacuum bag: up to 0.1 MPa", Dimension::stress,
           from(0, kLargestPressure), true});
  v.field({"delay", &p.load.delay,
           "From the end of the last stroke, or of a run without grippers, to its begin", Dimension::time,
           from(0, 1e5), false, "absent: once the schedule is over"});
  v.field({"duration", &p.load.duration, "From its begin to the end of the run, which ends under pressure",
           Dimension::time, positive(1e5)});
  v.field({"ramp", &p.load.ramp,
           "From its begin to the full pressure, with a continuous slope; by default as long as "
           "optimise.shortest_stroke",
           Dimension::time, positive(1e5)});
  v.field({"pads", choice(p.pads, {"held", "released"}),
           "Grippers hold the ply; or let go of it once the pressure is full, at the latest"});
  v.field({"objective", choice(p.objective, {"before", "after"}),
           "Which score the objective takes: of the ply before it is pressed, or after"});
}

void visit_score(FieldVisitor& v, ScoreOptions& s) {
  v.field({"wrinkle_threshold", &s.wrinkle_threshold,
           "A gap above it counts as wrinkled where the ply does not "
           "bridge a hollow",
           Dimension::length, positive()});
  v.field({"target_gap", &s.target_gap, "Reference of the gaps", Dimension::length, positive()});
  v.field({"target_boundary_offset", &s.target_boundary_offset, "Reference of the boundary offsets",
           Dimension::length, positive()});
  v.field({"locking_angle",
           &s.locking_angle_deg,
           "Shear above it is penalised",
           Dimension::degrees,
           {0, 90, true, true}});
  v.field(
      {"strain_limit", &s.strain_limit, "Fibre strain above it is penalised", Dimension::none, positive(1)});
  v.field({"kinetic_limit", &s.kinetic_limit,
           "Of the ply's kinetic over its internal energy, at the end of each tenth of a run but the first; "
           "a drape above "
           "it was thrown and has no score",
           Dimension::none, positive(1e9)});
  v.field({"lag_tolerance", &s.lag_tolerance,
           "How far joints may be behind their commands before their pads touch; a schedule that misses its "
           "commands by more is no candidate",
           Dimension::length, positive()});
  v.section({"weights", "Of the parts of the objective; 0 leaves a part out", false, {}, true}, true, [&] {
    v.field({"max_gap", &s.weight_max_gap, "Of the largest gap", Dimension::none, from(0)});
    v.field({"rms_gap", &s.weight_rms_gap, "Of the r.m.s. gap", Dimension::none, from(0)});
    v.field({"wrinkled_area", &s.weight_wrinkled_area, "Of the wrinkled area, per 1 % of the ply",
             Dimension::none, from(0)});
    v.field({"max_boundary_offset", &s.weight_max_boundary_offset, "Of the largest boundary offset",
             Dimension::none, from(0)});
    v.field({"rms_boundary_offset", &s.weight_rms_boundary_offset, "Of the r.m.s. boundary offset",
             Dimension::none, from(0)});
    v.field({"shear", &s.weight_shear, "Per degree above the locking angle", Dimension::none, from(0)});
    v.field({"lag", &s.weight_lag, "Per mm of lag above its tolerance", Dimension::none, from(0)});
    v.field({"duration", &s.weight_duration, "Per second of the schedule", Dimension::none, from(0)});
  });
}

void visit_optimise(FieldVisitor& v, OptimiseOptions& o) {
  v.field({"budget", &o.budget, "Time that a plan may take, with its reports", Dimension::time, positive()});
  v.field({"evaluations", &o.evaluations,
           "Evaluations that a plan may take below the reporting fidelity, instead of a time: the result can "
           "then be had again; its last generation may go over it; 0: `budget` counts",
           Dimension::none, from(0, 1e7)});
  v.field({"finalists", &o.finalists, "Schedules that are evaluated at the reporting fidelity in the end, at least: one more than this",
           Dimension::none, from(1, 1e4)});
  v.field({"choose", choice(o.choose, {"nominal", "mean", "worst"}),
           "Which finalist wins: that with the lowest objective in the case as it is, or with the lowest "
           "mean or worst "
           "one over plants that differ from it in friction, placement, shear, joints and times"});
  v.field({"shortest_stroke", &o.shortest_stroke, "Of a gripper after the preshape", Dimension::time,
           positive()});
  v.field({"longest_sequence", &o.longest_sequence, "After the preshape", Dimension::time, positive()});
  v.field({"seed", &o.seed, "Of all random numbers"});
  v.list(object_list(
      "design", "Fields of the case that the search may change together with the schedule", o.design,
      [&v](DesignVariable& variable) {
        v.field({"path",
                 &variable.path,
                 "Of the field, dots between keys, e.g. grippers.joint_offset",
                 Dimension::none,
                 {},
                 true});
        v.field({"from",
                 &variable.from,
                 "Least value as text, with its unit if it has one",
                 Dimension::none,
                 {},
                 true});
        v.field({"to", &variable.to, "Largest value, in the same unit", Dimension::none, {}, true});
      }));
  v.field({"design_evaluations", &o.design_evaluations, "Budget of the search over design and waves together",
           Dimension::none, from(0, 1e6)});
}

void visit_fem(FieldVisitor& v, FemOptions& f) {
  v.field({"mesh_size", &f.mesh_size, "Largest element edge", Dimension::length, from(1e-4, 1)});
  v.field({"section_points",
           &f.section_points,
           "Through the thickness",
           Dimension::none,
           {1, 5, false, false, true}});
  v.field({"fibre_points", &f.fibre_points,
           "Across each fibre at mid-thickness; with 1 only hourglass control keeps opposite edges alike",
           Dimension::none, from(1, 2)});
  v.field({"precision", choice(f.precision, {"double", "single"}),
           "Of the shell's forces; positions, sums of forces, contact and books are in double"});
  v.field({"mass_scaling", &f.mass_scaling, "Factor on the mass; gravity acts on the unscaled mass",
           Dimension::none, from(1, 1e6)});
  v.field({"fibre_mass_scaling", &f.fibre_mass_scaling,
           "The step may be this many times longer: mass is added to the stretch of fibres alone; 1: none",
           Dimension::none, from(1, 8)});
  v.field({"target_step", &f.target_step, "Mass is added to nodes where the step would be smaller; 0: none",
           Dimension::time, from(0, 1)});
  v.field({"time_scaling", &f.time_scaling, "The schedule is played this many times faster than written",
           Dimension::none, from(0.1, 1e4)});
  v.field(
      {"step_safety", &f.step_safety, "Share of the estimated stable step", Dimension::none, positive(1)});
  v.field({"step_interval", &f.step_interval,
           "Steps between two choices of the step; 0: one step that is safe for all strains of the tables",
           Dimension::none, from(0, 1e4)});
  v.field({"rates", &f.rates, "false: only the slowest curves of the material are used"});
  v.field({"bulk_viscosity", &f.bulk_viscosity,
           "Damping ratio along the fibres at the highest frequency; keeps fibres stable that are stiffer in "
           "tension than in compression",
           Dimension::none, from(0, 1)});
  v.field({"hourglass", &f.hourglass,
           "In-plane hourglass stiffness over that of a bilinear element of fibre in compression",
           Dimension::none, from(0, 100)});
  v.field({"contact_stiffness", &f.contact_stiffness,
           "Contact stiffness of a free node over its membrane stiffness", Dimension::none, positive(100)});
  v.field({"contact_damping", &f.contact_damping,
           "Share of the critical damping of a node on its contact spring", Dimension::none, from(0, 1)});
}

/// What holds a ply without grippers: clamped edges, and grips that may move.
void visit_supports(FieldVisitor& v, Case& c) {
  v.section({"supports", "What holds a ply without grippers", false, {"material"}}, !c.clamped.empty(), [&] {
    ChoiceList edges{{"left", "right", "bottom", "top"}, {}, {}};
    edges.get = [&c] {
      std::vector<int> indices;
      for (const Edge edge : c.clamped) indices.push_back(int(edge));
      return indices;
    };
    edges.set = [&c](const std::vector<int>& indices) {
      c.clamped.clear();
      for (const int index : indices) c.clamped.push_back(Edge(index));
    };
    v.field({"clamped",
             edges,
             "Edges of the ply: smallest u, largest u, smallest v, largest v",
             Dimension::none,
             {},
             true});
  });
  ObjectList grips = object_list("grips", "Rigid clamps on straight pieces of the outline, which may move",
                                 c.grips, [&v](GripOptions& grip) { visit_grip(v, grip); });
  grips.needs = {"material"};
  v.list(grips);
}

/// What is shown beside the results.
void visit_views(FieldVisitor& v, Case& c) {
  ObjectList probes =
      object_list("probes", "Points of the ply whose way is reported", c.probes, [&v](Probe& probe) {
        v.field({"name", &probe.name, "Name in the results", Dimension::none, {}, true});
        v.field({"place", &probe.place, "In the ply (u, v)", Dimension::length, {}, true});
      });
  probes.needs = {"material"};
  v.list(probes);
  ObjectList profiles = object_list(
      "profiles", "Lines along which the ply is shown beside the mold", c.profiles, [&v](Profile& profile) {
        v.field(
            {"name", &profile.name, "Name of its file: letters, digits, - and _", Dimension::none, {}, true});
        v.field({"frame", choice(profile.frame, {"world", "ply"}),
                 "Ends in the world (x, y), where a vertical plane cuts the ply; or in the ply (u, v)"});
        v.field({"from", &profile.from, "One end", Dimension::length, {}, true});
        v.field({"to", &profile.to, "The other end", Dimension::length, {}, true});
      });
  profiles.needs = {"material"};
  v.list(profiles);
  ObjectList instants = object_list(
      "instants", "Times at which profiles and shear are shown, beside the end of the run", c.instants,
      [&v](Instant& instant) {
        v.field(
            {"name", &instant.name, "What it is called in tables and pictures", Dimension::none, {}, true});
        v.field({"time", &instant.time, "On the schedule's clock; later than the end: not shown",
                 Dimension::time, from(0), true});
      });
  instants.needs = {"material"};
  v.list(instants);
  ObjectList references = object_list(
      "references", "Published results that are shown beside the own ones", c.references, [&v](Reference& r) {
        v.field({"name", &r.name, "Name in tables", Dimension::none, {}, true});
        v.field({"max_gap", &r.max_gap, "Largest gap", Dimension::length, from(0), true});
        v.field({"max_boundary_offset", &r.max_boundary_offset, "Largest boundary offset", Dimension::length,
                 from(0), true});
      });
  references.needs = {"grippers"};
  v.list(references);
}

void visit_physics(FieldVisitor& v, CaseFields& fields) {
  Case& c = fields.definition;
  optional_section(
      v, {"friction", "Coulomb friction between ply and mold", false, {"mold", "material"}}, c.friction, 0.0,
      [&v, &c](double& coefficient) {
        v.field({"coefficient", &coefficient, "Coulomb coefficient", Dimension::none, from(0, 100), true});
        v.field(
            {"tack", &c.tack,
             "Stress up to which the ply sticks where it has touched: it resists pull-off, and adds to what "
             "friction holds. For prepreg at room temperature assume 10 to 100 kPa, the order of probe tests "
             "(review: Budelmann, Schmidt, Meiners, Polymer Composites 41, 2020)",
             Dimension::stress, from(0, kLargestTack), false, "absent: no tack"});
      });
  MappingOptions mapping;
  mapping.start = c.ply.position;
  optional_section(v, {"mapping", "Kinematic energy mapping of the ply onto the mold", false, {"mold"}},
                   c.mapping, mapping, [&v](MappingOptions& options) { visit_mapping(v, options); });
  optional_section(v, {"grippers", "The gripper grid", false, {"mold", "mapping", "material"}}, c.grippers,
                   RigOptions(), [&v, &c](RigOptions& rig) {
                     visit_grippers(v, rig, c);
                     v.field({"source", &c.grippers_source, "Where the figures come from"});
                   });
  optional_section(v, {"press", "A pressure on the ply once it has been laid down", false, {"material"}},
                   c.press, PressOptions(), [&v](PressOptions& press) { visit_press(v, press); });
  v.field({"gravity",
           &c.gravity,
           "Downwards",
           Dimension::acceleration,
           from(0, 1e3),
           false,
           "absent: no gravity",
           {"material"}});
  optional_section(v, {"damping", "Mass-proportional damping", false, {"material"}}, fields.damping,
                   DampingFields(), [&v](DampingFields& damping) { visit_damping(v, damping); });
  optional_section(v, {"rest", "When a run may end before its time: once nothing moves", false, {"material"}},
                   c.rest, RestCriterion(), [&v](RestCriterion& rest) {
                     v.field({"speed", &rest.speed, "R.m.s. speed of the ply below which it is at rest",
                              Dimension::velocity, positive()});
                     v.field({"hold", &rest.hold, "For how long it must be so, on the simulation's clock",
                              Dimension::time, from(0)});
                   });
  visit_supports(v, c);
  visit_views(v, c);
  v.field({"start_height",
           &c.start_height,
           "Height of the level ply without grippers",
           Dimension::length,
           from(-kLargestLength, kLargestLength),
           false,
           "",
           {"material"}});
  v.field({"duration",
           &c.duration,
           "Of a run without grippers",
           Dimension::time,
           from(0, 1e5),
           false,
           "",
           {"material"}});
}

}  // namespace

void visit_case(FieldVisitor& v, CaseFields& fields) {
  Case& c = fields.definition;
  int format = 0;
  std::string schema;  // for editors
  v.field({"$schema", &schema, "Where an editor finds the schema of this file; it is not read"});
  v.field({"format", choice(format, {kCaseFormat}), "What this file is", Dimension::none, {}, true});
  v.field(
      {"name", &c.name, "Short name in tables and reports", Dimension::none, {}, false, "the file's name"});
  v.field({"description", &c.description, "What the case is about"});
  v.section({"ply", "The flat ply: a rectangle, or any outline", true}, true, [&] { visit_ply(v, fields); });
  optional_section(v, {"material", "The fabric; an object, or the name of a file that holds it"},
                   fields.material, MaterialFields(),
                   [&v](MaterialFields& material) { visit_material(v, material); });
  optional_section(v, {"mold", "The rigid mold; an object, or the name of a file that holds it"}, fields.mold,
                   MoldFields(), [&v](MoldFields& mold) { visit_mold(v, mold); });
  visit_physics(v, fields);
  v.section({"schedule", "The baseline strategies and what they share", false, {"grippers"}, true}, true,
            [&] { visit_schedule(v, c.schedule); });
  v.section({"score", "What a draped ply is worth", false, {"mapping"}, true}, true,
            [&] { visit_score(v, c.score); });
  v.section({"optimise", "Budgets and limits of the search", false, {"grippers"}, true}, true,
            [&] { visit_optimise(v, c.optimise); });
  v.section({"fem", "Numerical settings of the reported run", false, {"material"}, true}, true,
            [&] { visit_fem(v, fields.fem); });
  NamedObjects fidelities{
      "fidelities",
      "Named numerical settings, each a change of `fem`: `screen` and `search` are used by the "
      "optimiser; `report` is `fem` itself unless it is named here",
      {"material"}};
  for (const auto& [name, options] : c.fidelities) fidelities.names.push_back(name);
  fidelities.visit = [&](const std::string& name) {
    visit_fem(v, c.fidelities.try_emplace(name, fields.fem).first->second);
  };
  v.named(fidelities);
}

}  // namespace drapeplan
