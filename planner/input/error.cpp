#include "planner/input/error.hpp"

namespace drapeplan {

std::string InputError::text() const {
  std::string text = file;
  if (line > 0) text += ':' + std::to_string(line);
  if (!path.empty()) text += ": " + path;
  return text + ": " + message;
}

}  // namespace drapeplan
