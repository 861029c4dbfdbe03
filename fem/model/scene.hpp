// What is there: a scene says it all before a model is built.
#pragma once

#include <optional>
#include <vector>

#include "fem/core/options.hpp"
#include "fem/core/start.hpp"
#include "fem/law/fabric.hpp"
#include "fem/mesh/mesh.hpp"
#include "fem/rig/rig.hpp"
#include "fem/terms/contact.hpp"
#include "fem/terms/grips.hpp"
#include "fem/terms/loads.hpp"
#include "fem/terms/press.hpp"
#include "mapping/mold.hpp"

namespace drapeplan {

/// Parts that are absent add no term, no memory and no work.
struct Scene {
  Mesh mesh;
  Fabric fabric;
  FemOptions options;
  Eigen::Vector2d position{0, 0};  ///< x-y of the ply frame's origin in the flat start [m]
  double angle = 0;                ///< warp direction from +x in the flat start [rad]
  double start_height = 0;         ///< of the flat ply without a rig; with a rig the schedule says it [m]
  Start start = Start::level;      ///< `on_mold` needs a mold and no rig
  std::optional<double> gravity;   ///< [m/s^2]
  std::optional<double> damping;   ///< mass-proportional rate alpha of the unscaled ply [1/s]
  std::optional<Mold> mold;
  std::optional<double> friction;  ///< needs a mold
  std::optional<Tack> tack;        ///< needs friction
  std::optional<RigOptions> rig;
  std::optional<Loads> loads;
  std::optional<Press> press;         ///< after the schedule, or the given duration
  std::vector<int> clamped;           ///< nodes that never move or turn
  std::vector<int> pinned;            ///< nodes that never move; their directors turn
  std::vector<Grip> grips;            ///< clamps that move; no node belongs to two
  std::optional<RestCriterion> rest;  ///< when a run may end before its time
};

/// All but the mold, which has no list of numbers of its own.
inline auto fields_of(const Scene& of) {
  const auto& [mesh, fabric, options, position, angle, start_height, start, gravity, damping, mold, friction,
               tack, rig, loads, press, clamped, pinned, grips, rest] = of;
  return std::tie(mesh, fabric, options, position, angle, start_height, start, gravity, damping, friction,
                  tack, rig, loads, press, clamped, pinned, grips, rest);
}

/// Refuses parts that need others, and a mold that contact cannot follow: curved more sharply than the mesh,
/// or too steep where the ply starts.
/// @throws WrongInput with the reason.
void check_scene(const Scene& scene);

}  // namespace drapeplan
