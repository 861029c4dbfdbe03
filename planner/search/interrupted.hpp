// The user wants a search to end.
#pragma once

#include "mapping/error.hpp"

namespace drapeplan {

/// Thrown between two evaluations; what was running then has been finished and logged.
struct Interrupted : NotFinished {
  Interrupted() : NotFinished("interrupted; --resume goes on where it was") {}
};

}  // namespace drapeplan
