// What one instant of a run looks like to scoring, pictures and files.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace drapeplan {

struct Snapshot {
  double time = 0;                          ///< of the schedule, time scaling undone [s]
  std::vector<Eigen::Vector3d> position;    ///< nodes, on the ply's mid-surface [m]
  std::vector<Eigen::Vector3d> director;    ///< nodes, unit, towards the ply's upper face
  std::vector<double> shear;                ///< elements, shear angle at mid-thickness [rad]
  std::vector<double> warp_strain;          ///< elements, nominal, at mid-thickness [-]
  std::vector<double> weft_strain;          ///< elements
  std::vector<Eigen::Vector3d> grip_force;  ///< of each grip on the ply [N]; empty without grips
  std::vector<Eigen::Vector3d> pad;         ///< pad centres on the mid-surface [m]; empty without a rig
  std::vector<Eigen::Vector3d> joint;       ///< [m]
  std::vector<double> actuator_force;       ///< of the instant, upwards > 0 [N]
};

}  // namespace drapeplan
