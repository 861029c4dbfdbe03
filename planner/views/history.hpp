// What is seen of a run while it goes on: the way of named points of the ply, the way and the force of its
// grips, and the ply as it is at the instants that the case names.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fem/core/snapshot.hpp"
#include "fem/mesh/foot.hpp"
#include "fem/model/model.hpp"
#include "fem/rig/schedule.hpp"
#include "planner/case/case.hpp"

namespace drapeplan {

/// Instants of a history, equally spaced over the run, its start and its end included.
inline constexpr int kHistoryInstants = 201;

/// Of a named point, one entry per instant.
struct ProbeTrack {
  std::string name;
  Eigen::Vector3d start{0, 0, 0};      ///< in the flat ply at the start of the run [m]
  std::vector<Eigen::Vector3d> place;  ///< on the mid-surface [m]
  std::vector<double> gap;  ///< of the underside to the mold, negative inside [m]; empty without a mold
};

/// Of a grip, one entry per instant.
struct GripTrack {
  std::string name;
  Eigen::Vector3d velocity{0, 0, 0};          ///< that it is moved with [m/s]
  std::vector<Eigen::Vector3d> displacement;  ///< since the start of the run [m]
  std::vector<Eigen::Vector3d> force;         ///< on the ply [N]
};

struct History {
  double time_scaling = 1;   ///< the run takes so many times less than the schedule's clock says
  std::vector<double> time;  ///< schedule's clock [s]
  std::vector<ProbeTrack> probes;
  std::vector<GripTrack> grips;
};

/// The ply at an instant that the case names.
struct NamedSnapshot {
  std::string name;
  Snapshot ply;
};

/// Looks at a run and keeps what its case asks for. After a restart it sees the rest of the run only;
/// displacements still count from the flat ply.
class Recorder {
 public:
  /// @param schedule  that the rig plays; null without a rig. All must outlive the object but the case.
  Recorder(const Case& definition, const Model& model, const Schedule* schedule);

  /// To be called with increasing times; an instant that was seen already is left out.
  void see(const Snapshot& now);

  [[nodiscard]] const History& history() const { return history_; }
  /// The snapshots that were nearest to the named instants, in their order in time; those that the run did
  /// not reach are absent.
  [[nodiscard]] std::vector<NamedSnapshot> instants() const;

 private:
  const Model& model_;
  double thickness_;
  std::vector<Foot> feet_;  ///< of the probes
  std::vector<Eigen::Vector3d> grip_start_;
  History history_;
  std::vector<Instant> wanted_;                   ///< by their times
  std::vector<std::optional<Snapshot>> nearest_;  ///< to each of them so far
};

/// What a history ended with: displacement of each probe; displacement and force of each grip [m, N].
nlohmann::json probes_json(const History& history);
/// The same for people.
std::string probes_text(const History& history);

}  // namespace drapeplan
