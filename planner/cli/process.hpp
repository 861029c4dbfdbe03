// The process: its standard streams, in whatever condition it is started with, its signals, and how it ends: the
// one place where exceptions become messages and exit codes.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "mapping/error.hpp"
#include "planner/input/error.hpp"

namespace drapeplan {

/// Opens stdin, stdout and stderr on /dev/null where they are closed, so that no result file takes their
/// descriptors; and a reader that is gone becomes an error of writing instead of the program's end.
void prepare_streams();

/// Writes to stdout.
/// @param kept  whether the text is in a file, too: then a reader that is gone has missed nothing.
/// @throws NotFinished with the reason if it cannot be written.
void print(const std::string& text, bool kept);

/// While it lives, SIGINT and SIGTERM are remembered instead of ending the program; a second one of the same
/// kind ends it.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether a signal has come.
  [[nodiscard]] static bool interrupted();
};

enum ExitCode : int { kDone = 0, kInputWrong = 2, kNotFinished = 3, kBug = 4 };

/// Faults of input files with their places, all at once.
class InputErrors : public WrongInput {
 public:
  explicit InputErrors(const std::vector<InputError>& errors);
};

/// Why something could not be done.
struct Failure {
  ExitCode code = kBug;
  std::string reason;
  bool has_places = false;  ///< the reason is a list of lines, each with its file
};

/// What an exception means: WrongInput is an error of input; NotFinished, no memory and what the operating
/// system refuses during the work leave it unfinished; everything else is a bug.
Failure failure_of(const std::exception_ptr& thrown);

/// One line on stderr, or one per fault of a file.
/// @param subject  what the work was about: the case file; may be empty.
void print_failure(const Failure& failure, const std::string& subject);

/// The errors one per line, and how many there are.
std::string errors_text(const std::vector<InputError>& errors);

}  // namespace drapeplan
