// The log of all evaluations: history, cache and checkpoint in one file, one JSON line each.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fem/core/run_summary.hpp"
#include "fem/rig/schedule.hpp"
#include "planner/score/score.hpp"

namespace drapeplan {

/// What one evaluation gave.
struct Outcome {
  Score score;                      ///< valid == false: failed, for the reason given there
  std::optional<OtherScore> other;  ///< where the ply was pressed
  RunSummary summary;
  std::vector<float> fields = {};  ///< of ScoreFields; empty where nobody learns from them
  double wall_seconds = 0;         ///< [s]
  double elapsed = 0;              ///< on the log's clock when it ended [s]
  bool cached = false;             ///< served without a run
};

/// What a search minimises: the objective; infinite if the run failed.
double value_of(const Outcome& outcome);

/// One line of the log.
struct Evaluation {
  int number = 0;  ///< running, from 1, in the order of the file
  std::string stage;
  std::string fidelity;
  std::uint64_t schedule_hash = 0;
  Outcome outcome;
  double best_so_far =
      0;  ///< lowest valid objective at this fidelity up to this line; infinite if there is none
};

/// 64-bit FNV-1a over the sizes and the bits of all doubles (-0 counts as 0).
std::uint64_t schedule_hash(const Schedule& schedule);
/// The same for a schedule on a changed rig. @param design  tells changes apart; 0: none.
std::uint64_t candidate_hash(std::uint64_t design, const Schedule& schedule);

/// Append-only file of JSON lines. The first names the format and the case; each other one is an evaluation,
/// flushed when written. Thread-safe. Resume = open the same file again: known (schedule, fidelity) pairs are
/// then served from it. In memory one outcome is kept per evaluation, some kilobytes: its score and its
/// fields, and of its run's summary only what the planner shows (status, steps, times, energies, hash).
class EvaluationLog {
 public:
  /// In memory only.
  EvaluationLog() = default;
  /// Opens or creates `path`. A torn last line (a run that was killed) is cut off.
  /// @throws WrongInput as `read_evaluations`, and leaves the file as it was; NotFinished if it cannot be
  /// written.
  EvaluationLog(const std::string& path, std::uint64_t case_hash);

  /// From now on names of fidelities stand for these settings: what was evaluated under the same name with
  /// others is not known. @param settings  tells them apart; 0: the case says what names stand for.
  void use_settings(std::uint64_t settings);

  /// The outcome of this candidate (the hash of its schedule, or of design and schedule) at this fidelity:
  /// the known one (cached = true), or that of `run`, which is called once even if several threads ask for it
  /// at the same time. What `run` throws passes; nothing is kept then.
  Outcome evaluate_once(std::uint64_t candidate, const std::string& fidelity,
                        const std::function<Outcome()>& run);
  /// Appends a line; gives it its number and best so far. Order is the caller's, see batch_evaluate.hpp.
  void write(std::uint64_t candidate, const std::string& fidelity, const std::string& stage,
             const Outcome& outcome);

  /// The log's clock: how long its plan has been searching, earlier runs included, to the last evaluation
  /// that they logged [s]. It goes on with the first evaluation that is not served from the file.
  [[nodiscard]] double elapsed() const;

  /// How many evaluations it has, those read from the file included.
  [[nodiscard]] int size() const;

 private:
  using Key = std::pair<std::uint64_t, std::string>;  // schedule hash, fidelity
  void remember(const Evaluation& evaluation);

  mutable std::mutex mutex_;
  std::condition_variable finished_;
  std::map<Key, Outcome> known_;
  std::set<Key> running_;
  std::map<std::string, double> best_;  // per fidelity
  int last_number_ = 0, size_ = 0;
  std::optional<std::chrono::steady_clock::time_point> begin_;  ///< when it first ran something
  std::uint64_t settings_ = 0;
  double before_ = 0;  ///< what its clock had shown when the file was opened [s]
  double latest_ = 0;  ///< of all evaluations [s]
  std::string path_;
  std::ofstream file_;
};

/// Reads a log file line by line; a torn last line is left out. The file stays as it is.
/// @param case_hash  if given, the case that the log must belong to.
/// @param visit      called for every evaluation in the order of the file; may be empty.
/// @return length of the file up to the end of its last whole line [bytes].
/// @throws WrongInput if the file cannot be read, belongs to another case, is of another format or has a
/// broken line.
std::uintmax_t read_evaluations(const std::string& path, std::optional<std::uint64_t> case_hash,
                                const std::function<void(Evaluation&&)>& visit);

/// All evaluations of a log file, for pages; errors as above.
std::vector<Evaluation> read_evaluations(const std::string& path,
                                         std::optional<std::uint64_t> case_hash = {});

}  // namespace drapeplan
