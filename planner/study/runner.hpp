// Runs the settings of a study side by side; every run is kept at once, so that a study can be resumed.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "planner/study/study.hpp"

namespace drapeplan {

/// One run that a study needs.
struct StudyJob {
  Settings settings;
  Schedule schedule;  ///< empty for a case without grippers
};

struct StudyRunnerOptions {
  std::filesystem::path log;  ///< one line per run; empty: nothing is kept
  bool resume = false;        ///< runs that the log holds are not done again
  int threads = 0;
  int repeats = 3;  ///< of runs shorter than a second: the median time counts
};

class StudyRunner {
 public:
  /// @param progress  called after each run with how many are done, of how many; one call at a time.
  /// A log that is not resumed is kept beside the new one, as *.old.
  /// @throws std::runtime_error if the log cannot be written, std::invalid_argument if a line of it is
  /// broken.
  StudyRunner(const StudySubject& subject, StudyRunnerOptions options,
              std::function<void(const std::string& what, int done, int of)> progress);

  /// Runs in the order of the jobs; the same job twice is run once.
  /// @param what  for the progress, e.g. "sweep".
  std::vector<StudyRun> run(const std::string& what, const std::vector<StudyJob>& jobs);

 private:
  std::string key_of(const StudyJob& job) const;
  StudyRun measured(const StudyJob& job) const;
  void read_log();
  void keep(const std::string& key, const StudyRun& run);

  const StudySubject& subject_;
  StudyRunnerOptions options_;
  std::function<void(const std::string&, int, int)> progress_;
  std::map<std::string, StudyRun> known_;
  std::ofstream file_;
};

}  // namespace drapeplan
