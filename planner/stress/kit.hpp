// What stress scenes are put together from: fabrics, strips, drapes, cases as JSON, and measures of ends.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fem/mesh/grid.hpp"
#include "planner/stress/exact.hpp"
#include "planner/stress/stress.hpp"

namespace drapeplan {

inline constexpr double kGravity = 9.81;  // [m/s^2]
inline constexpr double kDegree = 0.017453292519943295;

/// Lists of scenes, one function per file.
void add_shear_scenes(std::vector<StressScene>& scenes);
void add_sheet_scenes(std::vector<StressScene>& scenes);
void add_mold_scenes(std::vector<StressScene>& scenes);
void add_rig_scenes(std::vector<StressScene>& scenes);
void add_press_scenes(std::vector<StressScene>& scenes);
void add_tack_scenes(std::vector<StressScene>& scenes);
void add_numeric_scenes(std::vector<StressScene>& scenes);

RunRequest request_of(const StressSetup& setup);

/// Linear law with the fibres' modulus in compression as a share of that in tension.
Fabric linear_fabric(double modulus, double shear, double transverse, double compression_share = 1);
/// Convex tension, soft compression, shear that locks beyond 35 degrees; 0.3 mm, 314 g/m^2.
Fabric woven_fabric();

/// A strip between two hinges, loaded by its weight, damped critically: sags to a known shape.
struct StripSetup {
  double length = 0.3, width = 0.06;                                           ///< [m]
  int along = 16, across = 2;                                                  ///< cells
  double thickness = 1e-4;                                                     ///< [m]
  double density = 1047;                                                       ///< [kg/m^3]
  double modulus = 1e9, shear = 1e7, transverse = 5e8, compression_share = 1;  ///< [Pa]; the last [-]
  double gravity = kGravity;
  double distortion = 0;  ///< of inner nodes, in cells
  FemOptions options = {};
};
HingedSag sag_of(const StripSetup& strip);
StressSetup hinged_strip(const StripSetup& strip);
/// Sag in the middle of a hinged strip [m].
double middle_sag(const StressRun& run);
/// A scene of it that must sag as it should, but for a share.
StressScene strip_scene(std::string group, std::string name, const StripSetup& strip, double share = 0.01);

/// A case file's text with overrides, through the reader, as a user would play it.
/// @throws std::invalid_argument with all errors.
StressSetup from_case(const std::string& text, const std::vector<std::string>& overrides = {});

/// A square woven ply under 2 x 2 grippers over a corner of the article's mold, and a schedule that lays it
/// down.
StressSetup corner_drape(double mesh_size = 0.0125);
/// Joints from one height above the mold to `depth` below their place on it. @param speed  factor on all
/// times.
Schedule lay_down(const Scene& scene, double depth = 0, double speed = 1);

/// Sum of the forces that hold the ply up: contact, friction, actuators; over its weight. 1 at rest.
double support_over_weight(const StressRun& run);
/// At rest contact and actuators bear the ply: what is missing is at most a share of its weight, and of the
/// forces with which actuators strain against each other.
StressCheck weight_carried(const StressRun& run, double share = 0.02);
/// Area within the ply's edge as seen from above [m^2]: what a pressure pushes down on, however the ply lies
/// within its edge.
double covered_area(const Mesh& mesh, const Snapshot& ply);
/// Of a pressed ply: at rest mold and actuators bear the ply and the press, and no gap has grown.
std::vector<StressCheck> pressed_down(const StressRun& run);
/// A scene of corner_drape() with a change, judged by weight_carried().
StressScene drape_scene(std::string group, std::string name, std::function<void(StressSetup&)> change);
/// Of the ply's weight [N].
double weight_of(const Scene& scene);
/// R.m.s. distance of the last positions to those of a run with other options [m]; NaN if that did not end.
double apart_from(const StressRun& run, const FemOptions& options);
/// The same options with a smaller step.
FemOptions safer(const StressRun& run, double step_safety = 0.25);
/// Mean displacement of the nodes from the start to the end [m].
Eigen::Vector3d mean_displacement(const StressRun& run);

}  // namespace drapeplan
