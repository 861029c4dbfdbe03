// SIMD lanes: the element kernel and the node loops are written once, on these types.
#pragma once

#include <cstring>
#include <experimental/simd>
#include <memory>
#include <vector>

namespace drapeplan {

using Lanes = std::experimental::native_simd<double>;
inline constexpr int kLanes = int(Lanes::size());

/// Arrays that lanes run over are padded to whole lanes plus one more, so that block loads never leave them.
inline size_t padded(int count) {
  return size_t((count + kLanes - 1) / kLanes + 1) * size_t(kLanes);
}

inline Lanes load(const double* at) {
  return Lanes(at, std::experimental::element_aligned);
}
inline void store(const Lanes& value, double* at) {
  value.copy_to(at, std::experimental::element_aligned);
}

/// A three-vector of lanes, or of plain doubles.
template <class V>
struct Vec3 {
  V x, y, z;
  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
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
