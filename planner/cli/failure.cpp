#include "planner/cli/failure.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

namespace drapeplan {
namespace {

/// The place and the system's reason, without the name of the function that failed.
std::string refusal_text(const std::filesystem::filesystem_error& error) {
  const std::string place = error.path1().string(), reason = error.code().message();
  return place.empty() ? reason : fmt::format("{}: {}", place, reason);
}

}  // namespace

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
