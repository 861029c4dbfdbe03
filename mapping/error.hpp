// The two ways in which a call may fail that are no bug: the input is wrong, or the work could not be
// finished. Both are thrown by all layers; the program turns them into its exit codes 2 and 3 in one place.
#pragma once

#include <stdexcept>

namespace drapeplan {

/// What was asked for cannot be done as it was stated: the message says what is wrong and what is allowed.
class WrongInput : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The input is right, but nature, numerics or the machine did not let the work end: the message says why.
class NotFinished : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace drapeplan
