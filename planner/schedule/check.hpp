// Whether a rig can do what a schedule says, as far as that is known before a run.
#pragma once

#include <string>
#include <vector>

#include "fem/rig/rig.hpp"
#include "fem/rig/schedule.hpp"

namespace drapeplan {

/// How a schedule's paths came to be.
enum class PathKind {
  blended,  ///< knots between which velocities are constant, with changes spread over the blend time
  sampled,  ///< the motion itself, at samples (schedule_through): without blends of its own
};

/// What a rig cannot do of a schedule, a sentence each; empty if nothing is known against it. Looked at are
/// the largest velocity; the largest acceleration, of a change of velocity that is spread over the blend
/// time; the force that a pad's mass needs for it; and heights of neighbours that are further apart than
/// their interlink is long. What a ply's stiffness and the mold resist, only the simulation knows: see the
/// lag of a score. Velocities and accelerations of a sampled motion are taken over the blend time of the rig,
/// by central differences, and may exceed their limits by 2 %: a log scatters.
/// @param schedule  of this rig: one path per gripper.
std::vector<std::string> rig_refusals(const Schedule& schedule, const RigOptions& rig,
                                      PathKind kind = PathKind::blended);
/// @throws WrongInput with the first of them.
void require_playable(const Schedule& schedule, const RigOptions& rig);

}  // namespace drapeplan
