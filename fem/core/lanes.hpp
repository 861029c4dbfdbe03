// SIMD lanes: the element kernel and the node loops are written once, on these types.
#pragma once

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#include <array>
#include <cmath>
#include <cstdint>
#include <experimental/simd>
#include <memory>
#include <vector>

// Kernels are inlined as a whole, so that lanes stay in registers. Sanitizers need many minutes for that and
// gain nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DRAPEPLAN_FLATTEN
#define DRAPEPLAN_INLINE
#else
#define DRAPEPLAN_FLATTEN [[gnu::flatten]]
#define DRAPEPLAN_INLINE [[gnu::always_inline]]
#endif

namespace drapeplan {

using Lanes = std::experimental::native_simd<double>;
inline constexpr int kLanes = int(Lanes::size());

/// Arrays that lanes run over are padded to whole lanes plus one more, so that block loads never leave them.
inline size_t padded(int count) {
  return size_t((count + kLanes - 1) / kLanes + 1) * size_t(kLanes);
}

DRAPEPLAN_INLINE inline Lanes load(const double* at) {
  return Lanes(at, std::experimental::element_aligned);
}
DRAPEPLAN_INLINE inline void store(const Lanes& value, double* at) {
  value.copy_to(at, std::experimental::element_aligned);
}

/// Values at places of their own.
DRAPEPLAN_INLINE inline Lanes pick(const double* values, const std::array<int, size_t(kLanes)>& at) {
  return Lanes([&](auto l) { return values[size_t(at[size_t(l)])]; });
}

/// Every value one lane further; zero in the first.
DRAPEPLAN_INLINE inline Lanes shifted_up(const Lanes& value) {
#if defined(__AVX512F__)
  return Lanes(_mm512_castsi512_pd(_mm512_alignr_epi64(_mm512_castpd_si512(static_cast<__m512d>(value)),
                                                       _mm512_setzero_si512(), kLanes - 1)));
#else
  return Lanes([&](auto l) { return l == 0 ? 0.0 : value[size_t(l) - (l == 0 ? 0 : 1)]; });
#endif
}

/// Entry k of a table for k = place cut to a whole number, not below 0.
DRAPEPLAN_INLINE inline Lanes load_entries(const double* table, const Lanes& place) {
#if defined(__AVX512F__)
  return Lanes(_mm512_i32gather_pd(_mm512_cvttpd_epi32(static_cast<__m512d>(place)), table, sizeof(double)));
#else
  return Lanes([&](auto l) { return table[size_t(int(place[size_t(l)]))]; });
#endif
}

/// Entries 2k and 2k + 1 of a table for k = place cut to a whole number, not below 0; faster than lane by
/// lane.
DRAPEPLAN_INLINE inline void load_pairs(const double* table, const Lanes& place, Lanes& even, Lanes& odd) {
#if defined(__AVX512F__)
  // Eight loads of a pair, joined and unzipped: half the time of two gathers on processors with slow ones.
  const __m256i at = _mm256_slli_epi32(_mm512_cvttpd_epi32(static_cast<__m512d>(place)), 1);
  const auto pair = [table](std::uint32_t k) { return _mm_loadu_pd(table + k); };
  const auto pairs = [&pair](std::uint64_t low, std::uint64_t high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(pair(std::uint32_t(low))), pair(std::uint32_t(high)),
                                1);
  };
  const auto k01 = std::uint64_t(_mm256_extract_epi64(at, 0)),
             k23 = std::uint64_t(_mm256_extract_epi64(at, 1)),
             k45 = std::uint64_t(_mm256_extract_epi64(at, 2)),
             k67 = std::uint64_t(_mm256_extract_epi64(at, 3));
  const __m512d lower = _mm512_insertf64x4(_mm512_castpd256_pd512(pairs(k01, k23)), pairs(k45, k67), 1);
  const __m512d upper =
      _mm512_insertf64x4(_mm512_castpd256_pd512(pairs(k01 >> 32, k23 >> 32)), pairs(k45 >> 32, k67 >> 32), 1);
  even = Lanes(_mm512_unpacklo_pd(lower, upper));
  odd = Lanes(_mm512_unpackhi_pd(lower, upper));
#else
  alignas(std::experimental::memory_alignment_v<Lanes>) double index[size_t(kLanes)];
  place.copy_to(index, std::experimental::vector_aligned);
  alignas(std::experimental::memory_alignment_v<Lanes>) double first[size_t(kLanes)], second[size_t(kLanes)];
  for (size_t l = 0; l < size_t(kLanes); ++l) {
    const double* at = table + 2 * size_t(int(index[l]));
    first[l] = at[0];
    second[l] = at[1];
  }
  even = Lanes(first, std::experimental::vector_aligned);
  odd = Lanes(second, std::experimental::vector_aligned);
#endif
}

/// Square root of a positive number and its inverse.
inline void root_and_inverse(double square, double& root, double& inverse) {
  root = std::sqrt(square);
  inverse = 1 / root;
}
DRAPEPLAN_INLINE inline void root_and_inverse(const Lanes& square, Lanes& root, Lanes& inverse) {
#if defined(__AVX512F__)
  // From 14 bits by the series of (1 - e)^(-1/2) to e^3, to two ulps: half the time of a square root and a
  // division.
  const Lanes guess(_mm512_rsqrt14_pd(static_cast<__m512d>(square)));
  const Lanes about = square * guess, e = Lanes(1.0) - about * guess;
  const Lanes more = e * (Lanes(0.5) + e * (Lanes(0.375) + e * Lanes(0.3125)));
  inverse = guess + guess * more;
  root = about + about * more;
#else
  root = std::experimental::sqrt(square);
  inverse = Lanes(1.0) / root;
#endif
}

/// A three-vector of lanes, or of plain doubles.
template <class V>
struct Vec3 {
  V x, y, z;
  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(const V& s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend V dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
};

/// One vector per node, as three arrays [padded]: structure of arrays, so that lanes load without gathering.
struct VectorField {
  std::vector<double> x, y, z;

  VectorField() = default;
  explicit VectorField(int count) : x(padded(count), 0.0), y(padded(count), 0.0), z(padded(count), 0.0) {}
  [[nodiscard]] Vec3<Lanes> lanes(size_t at) const { return {load(&x[at]), load(&y[at]), load(&z[at])}; }
  void set_lanes(size_t at, const Vec3<Lanes>& value) {
    store(value.x, &x[at]);
    store(value.y, &y[at]);
    store(value.z, &z[at]);
  }
  void fill(double value) {
    std::fill(x.begin(), x.end(), value);
    std::fill(y.begin(), y.end(), value);
    std::fill(z.begin(), z.end(), value);
  }
};

}  // namespace drapeplan
