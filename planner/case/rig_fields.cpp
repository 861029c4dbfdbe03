// The fields of the gripper grid.
#include "planner/case/section_fields.hpp"
#include "planner/input/kit.hpp"

namespace drapeplan {
namespace {

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
