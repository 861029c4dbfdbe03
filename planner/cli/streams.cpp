#include "planner/cli/streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

#include "mapping/error.hpp"

namespace drapeplan {

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

}  // namespace drapeplan
