#include "planner/input/error.hpp"

#include <fmt/format.h>

namespace drapeplan {

std::string InputError::text() const {
  std::string place = file;
  if (line > 0) place += fmt::format(":{}", line);
  if (!path.empty()) place += fmt::format(": {}", path);
  return fmt::format("{}: {}", place, message);
}

}  // namespace drapeplan
