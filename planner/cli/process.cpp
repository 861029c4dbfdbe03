#include "planner/cli/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

volatile std::sig_atomic_t signal_came = 0;

/// Only what POSIX allows in a handler: the next signal finds the default, which ends the program.
void remember(int number) {
  signal_came = 1;
  std::signal(number, SIG_DFL);
}

}  // namespace

void prepare_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free descriptor is taken: this one, as those below are open by now.
    if (open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY) != stream) return;
  }
  std::signal(SIGPIPE, SIG_IGN);
}

void print(const std::string& text, bool kept) {
  for (size_t begin = 0; begin < text.size();) {
    const ssize_t count = write(STDOUT_FILENO, text.data() + begin, text.size() - begin);
    if (count >= 0) {
      begin += size_t(count);
    } else if (errno == EPIPE && kept) {
      return;
    } else if (errno != EINTR) {
      throw NotFinished(fmt::format("stdout: cannot be written: {}", std::generic_category().message(errno)));
    }
  }
}

InterruptGuard::InterruptGuard() {
  signal_came = 0;
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, remember);
}

InterruptGuard::~InterruptGuard() {
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, SIG_DFL);
}

bool InterruptGuard::interrupted() {
  return signal_came != 0;
}

}  // namespace drapeplan
