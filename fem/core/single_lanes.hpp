// Lanes of floats, twice as many as Lanes, for the shell in single precision: two blocks of elements side by
// side.
#pragma once

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include <bit>

#include "fem/core/lanes.hpp"

namespace drapeplan {

/// Made from a double, as kernels write their constants; otherwise what std::experimental::simd is.
struct SingleLanes {
  using Simd = std::experimental::native_simd<float>;

  SingleLanes() = default;
  DRAPEPLAN_INLINE explicit SingleLanes(double all) : value(float(all)) {}
  DRAPEPLAN_INLINE explicit SingleLanes(const Simd& lanes) : value(lanes) {}

  DRAPEPLAN_INLINE friend SingleLanes operator+(const SingleLanes& a, const SingleLanes& b) {
    return SingleLanes(Simd(a.value + b.value));
  }
  DRAPEPLAN_INLINE friend SingleLanes operator-(const SingleLanes& a, const SingleLanes& b) {
    return SingleLanes(Simd(a.value - b.value));
  }
  DRAPEPLAN_INLINE friend SingleLanes operator*(const SingleLanes& a, const SingleLanes& b) {
    return SingleLanes(Simd(a.value * b.value));
  }
  DRAPEPLAN_INLINE friend SingleLanes operator-(const SingleLanes& a) { return SingleLanes(Simd(-a.value)); }
  DRAPEPLAN_INLINE SingleLanes& operator+=(const SingleLanes& b) { return *this = *this + b; }

  Simd value;
};

inline constexpr int kSingleLanes = int(SingleLanes::Simd::size());
static_assert(kSingleLanes == 2 * kLanes, "two blocks of doubles make one of floats");

/// One block of doubles, rounded: half of SingleLanes. To be made as soon as its doubles are known: they take
/// twice the registers.
struct HalfLanes {
#if defined(__AVX512F__)
  DRAPEPLAN_INLINE explicit HalfLanes(const Lanes& all) : value(_mm512_cvtpd_ps(static_cast<__m512d>(all))) {}
  __m256 value;
#elif defined(__AVX__)
  DRAPEPLAN_INLINE explicit HalfLanes(const Lanes& all) : value(_mm256_cvtpd_ps(static_cast<__m256d>(all))) {}
  __m128 value;
#else
  explicit HalfLanes(const Lanes& all) {
    for (size_t l = 0; l < value.size(); ++l) value[l] = float(all[l]);
  }
  std::array<float, size_t(kLanes)> value;
#endif
  HalfLanes() = default;
};

DRAPEPLAN_INLINE inline SingleLanes joined(const HalfLanes& low, const HalfLanes& high) {
#if defined(__AVX512F__)
  const __m512d first = _mm512_castpd256_pd512(_mm256_castps_pd(low.value));
  return SingleLanes(
      SingleLanes::Simd(_mm512_castpd_ps(_mm512_insertf64x4(first, _mm256_castps_pd(high.value), 1))));
#elif defined(__AVX__)
  return SingleLanes(
      SingleLanes::Simd(_mm256_insertf128_ps(_mm256_castps128_ps256(low.value), high.value, 1)));
#else
  return SingleLanes(SingleLanes::Simd([&](auto l) {
    const size_t at = size_t(l) % size_t(kLanes);
    return size_t(l) < size_t(kLanes) ? low.value[at] : high.value[at];
  }));
#endif
}
/// Two blocks of doubles, rounded.
DRAPEPLAN_INLINE inline SingleLanes joined(const Lanes& low, const Lanes& high) {
  return joined(HalfLanes(low), HalfLanes(high));
}

/// One of these blocks: 0 or 1.
template <size_t kHalf>
DRAPEPLAN_INLINE inline Lanes half(const SingleLanes& both) {
#if defined(__AVX512F__)
  const __m512d all = _mm512_castps_pd(static_cast<__m512>(both.value));
  return Lanes(_mm512_cvtps_pd(_mm256_castpd_ps(_mm512_extractf64x4_pd(all, kHalf))));
#elif defined(__AVX__)
  return Lanes(_mm256_cvtps_pd(_mm256_extractf128_ps(static_cast<__m256>(both.value), kHalf)));
#else
  return Lanes([&](auto l) { return double(both.value[size_t(l) + kHalf * size_t(kLanes)]); });
#endif
}

/// Pairs of floats of a table, each with the bits of a double: one load fetches both.
inline std::vector<double> single_pairs(const std::vector<double>& values) {
  std::vector<double> pairs;
  for (size_t k = 0; k + 1 < values.size(); k += 2)
    pairs.push_back(std::bit_cast<double>(std::array<float, 2>{float(values[k]), float(values[k + 1])}));
  return pairs;
}

/// Pair k of a table for k = place cut to a whole number, not below 0.
DRAPEPLAN_INLINE inline void load_pairs(const double* table, const SingleLanes& place, SingleLanes& even,
                                        SingleLanes& odd) {
#if defined(__AVX2__)
  // Sixteen (or eight) loads of a pair; four of them are unzipped by a shuffle of two registers.
  const auto two = [table](std::uint64_t k) {
    return _mm_loadh_pd(_mm_load_sd(table + std::uint32_t(k)), table + (k >> 32));
  };
  const auto four = [&two](std::uint64_t low, std::uint64_t high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(two(low)), two(high), 1);
  };
  constexpr int kEven = 0x88, kOdd = 0xdd;
#if defined(__AVX512F__)
  const __m512i at = _mm512_cvttps_epi32(static_cast<__m512>(place.value));
  const __m256i first = _mm512_castsi512_si256(at), last = _mm512_extracti64x4_epi64(at, 1);
  const auto four_of = [&four](const __m256i& k, bool later) {
    return later ? four(std::uint64_t(_mm256_extract_epi64(k, 1)), std::uint64_t(_mm256_extract_epi64(k, 3)))
                 : four(std::uint64_t(_mm256_extract_epi64(k, 0)), std::uint64_t(_mm256_extract_epi64(k, 2)));
  };
  const auto eight = [](const __m256d& low, const __m256d& high) {
    return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
  };
  const __m512 a = eight(four_of(first, false), four_of(last, false));
  const __m512 b = eight(four_of(first, true), four_of(last, true));
  even.value = SingleLanes::Simd(_mm512_shuffle_ps(a, b, kEven));
  odd.value = SingleLanes::Simd(_mm512_shuffle_ps(a, b, kOdd));
#else
  const __m256i at = _mm256_cvttps_epi32(static_cast<__m256>(place.value));
  const __m256 a = _mm256_castpd_ps(
      four(std::uint64_t(_mm256_extract_epi64(at, 0)), std::uint64_t(_mm256_extract_epi64(at, 2))));
  const __m256 b = _mm256_castpd_ps(
      four(std::uint64_t(_mm256_extract_epi64(at, 1)), std::uint64_t(_mm256_extract_epi64(at, 3))));
  even.value = SingleLanes::Simd(_mm256_shuffle_ps(a, b, kEven));
  odd.value = SingleLanes::Simd(_mm256_shuffle_ps(a, b, kOdd));
#endif
#else
  const auto entry = [&](auto l, size_t which) {
    return std::bit_cast<std::array<float, 2> >(table[size_t(int(place.value[size_t(l)]))])[which];
  };
  even.value = SingleLanes::Simd([&](auto l) { return entry(l, 0); });
  odd.value = SingleLanes::Simd([&](auto l) { return entry(l, 1); });
#endif
}

/// 1 / sqrt of positive numbers.
DRAPEPLAN_INLINE inline SingleLanes inverse_root(const SingleLanes& square) {
#if defined(__AVX512F__)
  const SingleLanes guess(SingleLanes::Simd(_mm512_rsqrt14_ps(static_cast<__m512>(square.value))));
  const SingleLanes e = SingleLanes(1.0) - square * guess * guess;
  return guess + guess * (SingleLanes(0.5) * e);  // 14 bits make 28, more than a float has
#else
  return SingleLanes(SingleLanes::Simd(1.0F / std::experimental::sqrt(square.value)));
#endif
}

/// |f| - 1 and 1 / |f| for a given |f|^2 - 1: the strain keeps all its bits, however small it is.
DRAPEPLAN_INLINE inline void strain_and_inverse(const SingleLanes& excess, SingleLanes& strain,
                                                SingleLanes& inverse) {
  const SingleLanes one(1.0), square = one + excess;
  inverse = inverse_root(square);
  const SingleLanes sum = one + square * inverse;
#if defined(__AVX512F__)
  const SingleLanes guess(SingleLanes::Simd(_mm512_rcp14_ps(static_cast<__m512>(sum.value))));
  const SingleLanes about = excess * guess;
  strain = about + about * (one - sum * guess);
#else
  strain = SingleLanes(SingleLanes::Simd(excess.value / sum.value));
#endif
}
DRAPEPLAN_INLINE inline SingleLanes inverse_length(const SingleLanes& excess) {
  return inverse_root(SingleLanes(1.0) + excess);
}

}  // namespace drapeplan
