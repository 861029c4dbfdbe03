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

struct FoldWords {
  const char* key = "";   ///< in result.json: "slack"
  const char* name = "";  ///< "slack between grippers"
};
FoldWords words_of(FoldKind kind);

/// One place where the ply is higher than its case allows, higher than all around it.
struct Fold {
  FoldKind kind = FoldKind::slack;
  int node = 0;               ///< its highest node
  Eigen::Vector2d at{0, 0};   ///< where that is in the flat ply (u, v) [m]
  double height = 0;          ///< its gap [m]
  Fibre fibre =
      Fibre::warp;  ///< along which the figures below are taken: that of the chord, else that with more slack
  double span = 0;  ///< of the mold below the fold [m]
  double slack = 0;           ///< of the ply on this span; below zero it is a chord [m]
  double arch = 0;            ///< height to which that slack raises an arch, see arch_height [m]
  std::vector<int>
      grippers;        ///< that hold it: those on both sides along the fibre, or the one above the mold
  double pad_gap = 0;  ///< of the ply under the highest of these pads [m]
  bool saturated = false;     ///< an actuator of these gives all the force that it has at the end
  // Instants are the first of those that were looked at from which on it holds for good. They are NaN where
  // nobody looked from the start on; the last three also where it never holds.
  double before = 0;      ///< the last instant before `since` [s]
  double since = 0;       ///< when it stood, see kSettled [s]
  double down = 0;        ///< when the last of its grippers was on the mold [s]
  double sides_down = 0;  ///< when the ply on both sides of it was [s]
};

/// A fold that is higher or lower than in the end by less than this share, or by less than the allowed gap,
/// stands.
inline constexpr double kSettled = 0.2;
/// A pad that stands above the mold by this share of a fold beside it holds it up.
inline constexpr double kHeldShare = 0.5;
/// Most folds that are told apart.
inline constexpr int kMostFolds = 5;

/// The highest places of a drape that exceed the allowed gap of its case, highest first, half a
/// spacing of the rig apart at least.
/// @param drape  of this problem at this fidelity, with frames, the more the finer are the instants; empty
/// where it failed.
std::vector<Fold> folds_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity);

}  // namespace drapeplan
