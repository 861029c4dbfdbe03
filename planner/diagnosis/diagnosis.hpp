// Why a drape is as it is, for an engineer: its folds, its edge, and the strokes that matter.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planner/diagnosis/edge_miss.hpp"
#include "planner/diagnosis/effects.hpp"
#include "planner/diagnosis/folds.hpp"

namespace drapeplan {

struct Diagnosis {
  std::vector<Fold> folds;            ///< highest first
  std::optional<EdgeMiss> edge;       ///< where the edge is farther off than allowed
  std::optional<StrokeEffects> effects;  ///< where they were simulated
  bool pressed = false;               ///< it is the ply after pressing

  /// Nothing exceeds what the case allows, or nothing was simulated to its end.
  [[nodiscard]] bool good() const { return folds.empty() && !edge; }
  /// The fold that stood first; null without any whose time is known.
  [[nodiscard]] const Fold* first() const;
};

/// What is wrong with a drape. @param drape  of this problem at this fidelity, with frames.
Diagnosis diagnosis_of(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity,
                       std::optional<StrokeEffects> effects = {});

/// One paragraph: the highest fold and what holds it, the first fold, the edge, the strokes that matter.
/// Empty of a drape that keeps what its case allows.
std::string diagnosis_text(const Diagnosis& diagnosis, const RigOptions& rig);

/// What would change it, a sentence for each kind of fold and one for the edge; empty if there is none.
std::string remedy_text(const Diagnosis& diagnosis, const RigOptions& rig);

/// Both for the console, a line each; empty if there is nothing to say.
std::string reasons_text(const Diagnosis& diagnosis, const RigOptions& rig);

nlohmann::json diagnosis_json(const Diagnosis& diagnosis, const RigOptions& rig);
/// The effects in what `diagnosis_json` wrote; nothing where none were simulated.
/// @throws std::exception if they are no effects of this rig.
std::optional<StrokeEffects> effects_from(const nlohmann::json& value, const RigOptions& rig);

}  // namespace drapeplan
