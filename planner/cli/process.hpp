// The process: its standard streams, in whatever condition it is started with, and its signals.
#pragma once

#include <string>

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

}  // namespace drapeplan
