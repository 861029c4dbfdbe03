// Normal numbers that are the same with every compiler and library.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

namespace drapeplan {

/// Box-Muller; the sine branch is dropped, so that the stream has no hidden state.
inline double standard_normal(std::mt19937_64& bits) {
  constexpr double kStep = 0x1p-53;
  const double u = (double(bits() >> 11) + 0.5) * kStep;
  const double v = (double(bits() >> 11) + 0.5) * kStep;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

}  // namespace drapeplan
