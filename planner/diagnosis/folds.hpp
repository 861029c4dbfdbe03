// Where a drape does not lie on its mold: its folds, of what kind each is, and since when it stands.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "planner/diagnosis/fibre_lines.hpp"
#include "planner/drape/problem.hpp"

namespace drapeplan {

/// Why the ply is above the mold at a place, in the order in which it is asked.
enum class FoldKind {
  bridging,  ///< a fibre spans a hollow, taut or without slack in the other one: there is too little ply
  edge,      ///< a margin of the ply that no gripper holds down
  held_up,   ///< a pad beside it that stands above the mold itself
  pad_rim,   ///< beside a pad, whose plane piece of ply does not shear with the rest
  stall,     ///< more ply than mold, between places that lay on the mold before the grippers did, and stuck
  slack,     ///< more ply than mold between two grippers, which landed too near to each other
};

/// "slack between grippers"
std::string name_of(FoldKind kind);
/// In result.json: "slack".
const char* key_of(FoldKind kind);

/// One place where the ply is higher than its case allows, higher than all around it.
struct Fold {
  FoldKind kind = FoldKind::slack;
  int node = 0;               ///< its highest node
  Eigen::Vector2d at{0, 0};   ///< where that is in the flat ply (u, v) [m]
  double height = 0;          ///< its gap [m]
  Fibre fibre = Fibre::warp;  ///< along which the figures below are taken: of a chord the shorter one, else
                              ///< the longer one
  double span = 0;            ///< of the mold below the arch [m]
  double slack = 0;           ///< of the ply on this span; below zero it is a chord [m]
  std::vector<int> grippers;  ///< that hold it: those at the ends of its span, or the one above the mold
  double pad_gap = 0;         ///< of the highest of these pads [m]
  bool saturated = false;     ///< an actuator of these gives all the force that it has at the end
  double since = 0;           ///< when it came to within `kSettled` of its final height for good [s]
  double before = 0;          ///< the last instant that was looked at before that; NaN: none was [s]
  double down = 0;        ///< when the last of its grippers was on the mold; NaN: never, or there is none [s]
  double sides_down = 0;  ///< when the ply on both sides of it was; NaN: never [s]
};

/// A fold that is higher or lower than in the end by less than this share, or by less than the allowed gap,
/// stands.
inline constexpr double kSettled = 0.2;
/// Most folds that are told apart.
inline constexpr int kMostFolds = 5;

/// The highest places of a drape that exceed the allowed gap of its case, highest first, half a
/// spacing of the rig apart at least.
/// @param drape  of this problem at this fidelity, with frames, the more the finer are the instants; empty
/// where it failed.
std::vector<Fold> folds_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity);

}  // namespace drapeplan
