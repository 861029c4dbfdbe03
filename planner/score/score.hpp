// What a draped ply is worth: its parts, and the one table of their names, units and decimals.
#pragma once

#include <array>
#include <string>

namespace drapeplan {

/// Parts of the score (SI). Everything is evaluated at the end of the run, or before pressing, except forces
/// and strains.
struct Score {
  /// Largest gap between ply underside and mold [m].
  double max_gap = 0;
  /// The same, area-weighted root mean square [m].
  double rms_gap = 0;
  /// Area with a gap above the threshold where the ply is not bridging a hollow [m^2].
  double wrinkled_area = 0;
  /// Largest distance between ply edge and prescribed boundary, both ways [m].
  double max_boundary_offset = 0;
  /// Of the ply edge from the prescribed boundary [m].
  double rms_boundary_offset = 0;
  double max_shear_deg = 0;
  /// Largest tension along a fibre at mid-thickness, nominal strain [-].
  double max_fibre_strain = 0;
  /// Largest shortening along a fibre at mid-thickness, magnitude of the nominal strain [-]. It comes from
  /// folds: with a fibre that is soft in compression the neutral axis moves off the middle, and folds finer
  /// than the mesh shorten it.
  double max_fibre_compression = 0;
  /// Over the run [N].
  double max_actuator_force = 0;
  /// Over the run: how far a joint was behind its command while its pad touched nothing [m].
  double max_lag = 0;
  /// How long some actuator was at its limit of force, on the schedule's clock [s].
  double saturated = 0;
  /// Of the schedule [s].
  double duration = 0;
  /// Weighted sum, lower is better.
  double objective = 0;
  /// false: the run failed, `reason` says why, `objective` is the penalty.
  bool valid = false;
  std::string reason;
  /// The rig did what it was told: the largest lag is within the case's tolerance. If not, the schedule is no
  /// candidate.
  bool followed = true;
};

/// Of a ply that is pressed there are two scores: the one that the objective does not take.
struct OtherScore {
  bool before = true;  ///< pressing; false: after it
  Score score;

  /// In results and in the evaluation log.
  [[nodiscard]] const char* key() const { return before ? "score_before_press" : "score_after_press"; }
  [[nodiscard]] const char* label() const { return before ? "before pressing" : "after pressing"; }
};

/// What all that writes, shows or compares a part of the score knows of it.
struct ScorePart {
  /// In results and in the evaluation log.
  const char* key;
  double Score::*value;
  const char* label;
  /// For people; empty if there is none.
  const char* unit;
  /// From the value to that unit.
  double factor;
  int decimals;
  /// Lower is better: the best of several drapes stands out, and tables on the console list it.
  bool compared = false;
  /// Its error's name in a study; null: a study does not look at it.
  const char* study = nullptr;
  /// Counts in the relative error of a study.
  bool leads = false;
};

/// All parts, in the order in which they are shown. A new part is a member of Score, a line here, and its
/// measure in scoring.cpp.
inline constexpr std::array kScoreParts{
    ScorePart{"max_gap", &Score::max_gap, "largest gap", "mm", 1e3, 2, true, "gap", true},
    ScorePart{"rms_gap", &Score::rms_gap, "r.m.s. gap", "mm", 1e3, 2, true, "rms_gap"},
    ScorePart{"wrinkled_area", &Score::wrinkled_area, "wrinkled area", "cm\u00b2", 1e4, 1, true,
              "wrinkled_area"},
    ScorePart{"max_boundary_offset", &Score::max_boundary_offset, "largest boundary offset", "mm", 1e3, 2,
              true, "boundary_offset", true},
    ScorePart{"rms_boundary_offset", &Score::rms_boundary_offset, "r.m.s. boundary offset", "mm", 1e3, 2,
              true, "rms_boundary_offset"},
    ScorePart{"max_shear_deg", &Score::max_shear_deg, "largest shear", "\u00b0", 1, 1, false,
              "max_shear_deg"},
    ScorePart{"max_fibre_strain", &Score::max_fibre_strain, "largest fibre tension", "%", 1e2, 3},
    ScorePart{"max_fibre_compression", &Score::max_fibre_compression, "largest fibre compression", "%", 1e2,
              3},
    ScorePart{"max_actuator_force", &Score::max_actuator_force, "largest actuator force", "N", 1, 1},
    ScorePart{"max_lag", &Score::max_lag, "largest lag", "mm", 1e3, 1, true},
    ScorePart{"saturated", &Score::saturated, "actuators at their limit", "s", 1, 1},
    ScorePart{"duration", &Score::duration, "duration", "s", 1, 1},
    ScorePart{"objective", &Score::objective, "objective", "", 1, 2, true, "objective"},
};

/// "largest gap [mm]".
std::string title_of(const ScorePart& part);
/// "3.15"; an en dash where the value is not finite.
std::string value_text(const ScorePart& part, const Score& score);

/// "largest gap 3.15 mm; r.m.s. gap 1.21 mm; ...": all parts. Of a failed run the reason.
std::string score_text(const Score& score);

/// What the limit of the actuators' force has to do with a drape; empty if no actuator was at it.
/// @param limit  [N];  @param lag_tolerance  of the case [m].
std::string force_text(const Score& score, double limit, double lag_tolerance);

}  // namespace drapeplan
