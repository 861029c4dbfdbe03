// Runs the settings of a study side by side; every run is kept at once, so that a study can be resumed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "planner/study/study.hpp"

namespace drapeplan {

/// The log of a study in its run folder.
inline constexpr const char* kStudyLog = "study.jsonl";

/// One run that a study needs.
struct StudyJob {
  Settings settings;
  Schedule schedule;  ///< empty for a case without grippers
};

struct StudyRunnerOptions {
  std::filesystem::path
      log;  ///< one line per run; runs that it holds are not done again; empty: nothing is kept
  int threads = 0;
  int repeats = 3;  ///< of runs shorter than a second: the median time counts
};

class StudyRunner {
 public:
  /// In memory and in the log one record per run is kept: its figures, and the places and shear that are
  /// compared.
  /// @param progress  called after each run with how many are done, of how many; one call at a time.
  /// @throws WrongInput if the log is of another case or has a broken line, and leaves it as it is;
  /// NotFinished if it cannot be written.
  StudyRunner(const StudySubject& subject, StudyRunnerOptions options,
              std::function<void(const std::string& what, int done, int of)> progress);

  /// Runs in the order of the jobs; the same job twice is run once.
  /// @param what  for the progress, e.g. "sweep".
  std::vector<StudyRun> run(const std::string& what, const std::vector<StudyJob>& jobs);

 private:
  std::string key_of(const StudyJob& job) const;
  StudyRun measured(const StudyJob& job) const;
  std::uintmax_t read_log(const std::string& head);
  void keep(const std::string& key, const StudyRun& run);

  const StudySubject& subject_;
  StudyRunnerOptions options_;
  std::function<void(const std::string&, int, int)> progress_;
  std::map<std::string, StudyRun> known_;
  std::ofstream file_;
};

}  // namespace drapeplan
