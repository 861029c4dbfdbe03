// 64-bit FNV-1a: a hash that does not depend on machine, library or run.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace drapeplan {

class Fnv1a {
 public:
  void add(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3ULL; }
  /// Lowest byte first.
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) add(static_cast<unsigned char>(bits & 0xff));
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::string_view text) {
    for (const char character : text) add(static_cast<unsigned char>(character));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace drapeplan
