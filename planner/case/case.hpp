// A case: everything that one JSON file says, with defaults filled in. SI units and radians inside.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fem/core/options.hpp"
#include "fem/core/start.hpp"
#include "fem/law/fabric.hpp"
#include "fem/rig/rig.hpp"
#include "fem/terms/press.hpp"
#include "mapping/mold.hpp"
#include "mapping/net.hpp"
#include "planner/case/score_options.hpp"

namespace drapeplan {

/// Where the commanded heights of a schedule end.
enum class Aim {
  mapped,     ///< joints above the mapped targets ([Krogh])
  reachable,  ///< joints above the places that the rig can reach (see planner/reach/reach.hpp)
};

/// From when the delay of a wave counts.
enum class DelayFrom {
  start,  ///< from the start of the group before (5.1 s for the article's wave)
  end,    ///< from the end of the group before (12.1 s for the article's wave)
};

/// The two baseline strategies and what they share.
struct ScheduleOptions {
  Aim aim = Aim::mapped;
  double preshape_height = 0.030;  ///< height of all grippers above their targets after the preshape [m]
  double preshape_duration = 5;    ///< [s]
  double overtravel = 0.002;    ///< commanded depth below the target, so that actuators press pads down [m]
  double settle = 1;            ///< time at rest at the end [s]
  double uniform_duration = 5;  ///< [s]
  double wave_duration = 3.5;   ///< stroke of one group [s]
  double wave_delay = 0.8;      ///< [s]
  DelayFrom wave_delay_from = DelayFrom::start;
  Eigen::Vector2d wave_start{0, 0};  ///< in the ply frame (u, v) [m]
};

/// A field of the case that the search may change, with the schedule.
struct DesignVariable {
  std::string path;      ///< as in the case file, dots between keys
  std::string from, to;  ///< quantities with one unit, or bare numbers
};

/// Which of the schedules that were seen at the reporting fidelity wins.
enum class Choose {
  nominal,  ///< that with the lowest objective in the case as it is
  mean,     ///< with the lowest mean over plants that differ from it (planner/trust/spread.hpp), the case
            ///< included
  worst,    ///< with the lowest of the largest objectives over these
};

struct OptimiseOptions {
  double budget = 600;           ///< of a plan, with its reports [s]
  int evaluations = 0;           ///< budget below the reporting fidelity; 0: `budget`
  Choose choose = Choose::nominal;
  int finalists = 4;             ///< one more is evaluated at the reporting fidelity in the end, at least
  double shortest_stroke = 1.0;  ///< of a gripper after the preshape [s]
  double longest_sequence = 15;  ///< after the preshape [s]
  unsigned seed = 1;
  std::vector<DesignVariable> design;
  int design_evaluations = 120;  ///< budget of the search over design and waves together
};

/// How long interlinks are once they are closed.
struct InterlinkLength {
  enum class Source {
    spacing,  ///< as in the flat start
    mapped,   ///< as the distance of their joints with both pads on their targets
    given,    ///< `same` for all, or each its own
  };
  Source source = Source::spacing;
  double same = 0;                              ///< [m]; 0: the lists
  std::vector<std::vector<double>> warp, weft;  ///< [row][column] of the interlinks in each direction [m]
};

/// Edge of the ply that is clamped (strips, test specimens).
enum class Edge { left, right, bottom, top };  ///< smallest u, largest u, smallest v, largest v

/// A clamp on a straight piece of the ply's outline.
struct GripOptions {
  std::string name;
  Eigen::Vector2d from{0, 0}, to{0, 0};  ///< ends of the piece (u, v) [m]
  Eigen::Vector3d velocity{0, 0, 0};     ///< world frame [m/s]
  double ramp = 0.1;                     ///< from rest to the velocity [s]
};

/// By how much a grip's ends, which are rounded in files, may miss the outline [m].
inline constexpr double kOnOutline = 1e-5;

/// A named point of the ply whose displacement is reported.
struct Probe {
  std::string name;
  Eigen::Vector2d place{0, 0};  ///< (u, v) [m]
};

/// A line along which the ply is shown beside the mold.
struct Profile {
  enum class Frame {
    world,  ///< ends (x, y) of the world: where a vertical plane through them cuts the ply
    ply,    ///< ends (u, v) of the ply: a line that was drawn on it while it was flat
  };
  std::string name;
  Frame frame = Frame::world;
  Eigen::Vector2d from{0, 0}, to{0, 0};  ///< [m]
};

/// A time of a run at which the ply is shown, beside its end.
struct Instant {
  std::string name;
  double time = 0;  ///< schedule's clock [s]
};

/// What presses the ply down once it has been laid.
struct PressOptions {
  enum class Pads {
    held,      ///< hold the ply to the end, or as long as `grippers.release_time` says
    released,  ///< let go of it once the pressure is full, at the latest
  };
  enum class Objective { before, after };
  Press load;
  Pads pads = Pads::held;
  Objective objective = Objective::after;  ///< which score it takes
};

/// A published result, shown beside the own ones.
struct Reference {
  std::string name;
  double max_gap = 0;              ///< [m]
  double max_boundary_offset = 0;  ///< [m]
};

/// What is known of a curve of the material beside its points; nothing of it changes a run.
struct CurveNotes {
  std::string source;              ///< what was measured, by whom, and what is assumed; may be empty
  std::optional<double> valid_to;  ///< strain or shear angle up to which it was measured and holds [-], [rad]
  std::optional<double> band;      ///< r.m.s. of what specimens differ from it, of its stress [-]
};

/// What is known of the material; texts may be empty.
struct MaterialNotes {
  std::string name, source;
  CurveNotes tension, compression, shear;
};

/// Sections that are absent in the file are absent here, and so is their physics.
struct Case {
  std::string name;
  std::string description;
  Ply ply;
  Fabric material;  ///< thickness 0: no `material` section, nothing can be simulated
  MaterialNotes material_notes;
  Start start = Start::level;  ///< of a ply without grippers
  double start_height = 0;     ///< height of the level ply without grippers [m]
  std::optional<Mold> mold;
  std::string mold_source;         ///< what a mold from a file was fitted to, and how well; may be empty
  std::optional<double> friction;  ///< Coulomb coefficient between ply and mold
  std::optional<double> tack;      ///< of the ply on the mold, with friction [Pa]
  std::optional<MappingOptions> mapping;
  std::optional<RigOptions> grippers;
  InterlinkLength interlink_length;  ///< a mapped one becomes `grippers.interlinks.lengths` with the mapping
  Eigen::Vector2d interlink_closing{0, 1};  ///< from when to when they change, shares of the preshape
  std::string grippers_source;              ///< where their figures come from, in words
  std::optional<PressOptions> press;
  std::optional<double> gravity;  ///< [m/s^2]
  std::optional<double> damping;  ///< mass-proportional rate alpha of the unscaled ply [1/s]
  std::optional<RestCriterion> rest;
  std::vector<Edge> clamped;
  std::vector<GripOptions> grips;
  std::vector<Probe> probes;
  std::vector<Profile> profiles;
  std::vector<Instant> instants;
  std::vector<Reference> references;
  double duration = 0;  ///< of a run without grippers [s]
  ScheduleOptions schedule;
  ScoreOptions score;
  OptimiseOptions optimise;
  std::map<std::string, FemOptions>
      fidelities;  ///< at least "report"; every one starts from the `fem` section
  /// The file of a drape has neither `fem` nor `fidelities`: they follow from the sizes of rig, mold and
  /// schedule, and a plan measures what they are worth (planner/trust/choice.hpp).
  bool chooses_fidelities = false;
};

}  // namespace drapeplan
