#include "planner/cli/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

namespace drapeplan {
namespace {

volatile std::sig_atomic_t signal_came = 0;

/// Only what POSIX allows in a handler: the next signal finds the default, which ends the program.
void remember(int number) {
  signal_came = 1;
  std::signal(number, SIG_DFL);
}

/// The place and the system's reason, without the name of the function that failed.
std::string refusal_text(const std::filesystem::filesystem_error& error) {
  const std::string place = error.path1().string(), reason = error.code().message();
  return place.empty() ? reason : fmt::format("{}: {}", place, reason);
}

}  // namespace

void prepare_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // The lowest free descriptor is taken: this one, as those below are open by now.
    if (open("/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY) != stream) return;
  }
  for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);  // writing fails with a reason instead
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

std::string errors_text(const std::vector<InputError>& errors) {
  std::string text;
  for (const InputError& error : errors) text += (text.empty() ? "" : "\n") + error.text();
  if (errors.size() > 1) text += fmt::format("\n{} errors", errors.size());
  return text;
}

InputErrors::InputErrors(const std::vector<InputError>& errors) : WrongInput(errors_text(errors)) {}

Failure failure_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputErrors& error) {
    return {kInputWrong, error.what(), true};
  } catch (const WrongInput& error) {
    return {kInputWrong, error.what()};
  } catch (const NotFinished& error) {
    return {kNotFinished, fmt::format("not finished: {}", error.what())};
  } catch (const std::bad_alloc&) {
    return {kNotFinished, "not finished: not enough memory"};
  } catch (const std::filesystem::filesystem_error& error) {
    return {kNotFinished, fmt::format("not finished: {}", refusal_text(error))};
  } catch (const std::system_error& error) {
    return {kNotFinished, fmt::format("not finished: {}", error.what())};
  } catch (const std::exception& error) {
    return {kBug, fmt::format("a bug: {}", error.what())};
  } catch (...) {
    return {kBug, "a bug: something was thrown that is no exception"};
  }
}

void print_failure(const Failure& failure, const std::string& subject) {
  if (failure.has_places) {
    std::cerr << failure.reason << '\n';
    return;
  }
  const bool named = subject.empty() || failure.reason.starts_with(subject);
  std::cerr << fmt::format("drapeplan: {}{}\n", named ? "" : subject + ": ", failure.reason);
}

}  // namespace drapeplan
