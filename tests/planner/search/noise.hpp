// Noise for objectives that are to be noisy and the same every time.
#pragma once

#include <cstdint>

namespace drapeplan::test {

/// Deterministic noise in [-1, 1] from a schedule's hash.
inline double hash_noise(std::uint64_t hash, std::uint64_t salt) {
  std::uint64_t x = (hash ^ salt) * 0x9e3779b97f4a7c15ULL;
  x ^= x >> 29;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 32;
  return 2 * (double(x >> 11) * 0x1p-53) - 1;
}

}  // namespace drapeplan::test
