// What is wrong with an input, and where.
#pragma once

#include <string>

namespace drapeplan {

/// One fault of the input, ready to print: `cases/x.json:41: /ply/thickness: "0.3 mn": unknown unit "mn";
/// ...`
struct InputError {
  std::string file;
  int line = 0;         ///< 0: not known (a --set override, a missing file)
  std::string path;     ///< JSON pointer
  std::string message;  ///< value, what was allowed, nearest right word
  [[nodiscard]] std::string text() const;
};

}  // namespace drapeplan
