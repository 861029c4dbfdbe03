// What an element is and how it moves, whatever the fabric: rest geometry, derivatives, their products,
// transverse shear and hourglass modes. See kernel.hpp for the formulas.
#pragma once

#include <array>
#include <type_traits>

#include "fem/law/material.hpp"

namespace drapeplan {

/// Rest geometry of one element, or of a block of them.
template <class V>
struct ElementGeometry {
  V b10, b11, b20, b21;  ///< gradient of the middle: d/du = b10, b11, -b10, -b11; d/dv likewise [1/m]
  V area;                ///< [m^2]
  V half1, half2;        ///< half the element's length along each fibre [m]
  V skew1, skew2;        ///< h.X and h.Y: zero for a parallelogram [m]
  /// Half the element along its own directions: X,r = (r11, r12), X,s = (r21, r22) [m].
  V r11, r12, r21, r22;
  V across1, across2;  ///< gradients of h.x/4 across each fibre, 1 / (4 half) [1/m]
  V shape;             ///< of the bilinear element: area (1/half1^2 + 1/half2^2) / 96 [-]
  V inverse;           ///< of r11 r22 - r12 r21 [1/m^2]
  /// Weights of linear transverse shear: (r21^2 + r22^2) inverse^2 / 3, and of r1 [1/m^2].
  V linear_r, linear_s;

  [[nodiscard]] std::array<V*, 19> parts() {
    return {&b10, &b11, &b20, &b21,     &area,    &half1, &half2,   &skew1,    &skew2,   &r11,
            &r12, &r21, &r22, &across1, &across2, &shape, &inverse, &linear_r, &linear_s};
  }
  /// True if all elements are rectangles along the fibres, to the bit.
  [[nodiscard]] bool rectangle() const {
    const auto all = [](auto condition) {
      if constexpr (std::is_same_v<decltype(condition), bool>)
        return condition;
      else
        return std::experimental::all_of(condition);
    };
    const V zero(0.0);
    return all(b10 == -b11) && all(b20 == b21) && all(skew1 == zero) && all(skew2 == zero) &&
           all(r12 == zero) && all(r21 == zero);
  }
};

/// Corner values of one element, or of a block: positions or directors.
template <class V>
using Corners = std::array<Vec3<V>, 4>;

/// Derivatives of a block: what the kernel computes from corners before it needs the law.
template <class V>
struct ElementMotion {
  Vec3<V> a1, a2, c1, c2, mean, hx, hd;
};

/// Of positions. @tparam kRectangle  see ElementGeometry::rectangle: the same, less what is zero.
template <bool kRectangle, class V>
void position_motion(const ElementGeometry<V>& g, const Corners<V>& x, Vec3<V>& a1, Vec3<V>& a2,
                     Vec3<V>& hx) {
  const Vec3<V> p = x[0] - x[2], q = x[1] - x[3];
  if constexpr (kRectangle) {
    a1 = g.b11 * (q - p);
    a2 = g.b21 * (q + p);
    hx = (x[0] + x[2]) - (x[1] + x[3]);
  } else {
    a1 = g.b10 * p + g.b11 * q;
    a2 = g.b20 * p + g.b21 * q;
    hx = (x[0] + x[2]) - (x[1] + x[3]) - g.skew1 * a1 - g.skew2 * a2;
  }
}

/// Differences and sums of directors along both diagonals.
template <class V>
struct DirectorPairs {
  explicit DirectorPairs(const Corners<V>& d)
      : p(d[0] - d[2]), q(d[1] - d[3]), even(d[0] + d[2]), odd(d[1] + d[3]) {}
  DirectorPairs() = default;
  Vec3<V> p, q, even, odd;
};

template <bool kRectangle, class V>
void director_motion(const ElementGeometry<V>& g, const DirectorPairs<V>& d, Vec3<V>& c1, Vec3<V>& c2,
                     Vec3<V>& mean, Vec3<V>& hd) {
  mean = V(0.25) * (d.even + d.odd);
  if constexpr (kRectangle) {
    c1 = g.b11 * (d.q - d.p);
    c2 = g.b21 * (d.q + d.p);
    hd = d.even - d.odd;
  } else {
    c1 = g.b10 * d.p + g.b11 * d.q;
    c2 = g.b20 * d.p + g.b21 * d.q;
    hd = d.even - d.odd - g.skew1 * c1 - g.skew2 * c2;
  }
}

template <bool kRectangle = false, class V>
ElementMotion<V> element_motion(const ElementGeometry<V>& g, const Corners<V>& x, const Corners<V>& d) {
  ElementMotion<V> m;
  position_motion<kRectangle>(g, x, m.a1, m.a2, m.hx);
  director_motion<kRectangle>(g, DirectorPairs<V>(d), m.c1, m.c2, m.mean, m.hd);
  return m;
}

/// In-plane and director hourglass stiffness [N/m], [N m] of an element: E t A / (12 h^2) with the mean of
/// both fibres.
template <class V>
struct HourglassStiffness {
  V membrane, director;
};
template <class V>
HourglassStiffness<V> hourglass_stiffness(const ElementGeometry<V>& g, const KernelMaterial& material) {
  const double t = material.thickness;
  return {V(material.hourglass_modulus * t) * g.shape,
          V(material.director_modulus * t * t * t / 12) * g.shape};
}

/// Transverse shear of an element: its energy per rest area, and the derivatives of that by its arguments.
///
/// With r and s along the element, x,r = r11 a_1 + r12 a_2 and so on, and y = (h.x)/4, the shear along r at
/// the middles of the edges s = -1 and s = 1 is (x,r -+ y).(dm -+ d,s): a mean x,r.dm + y.d,s and a linear
/// part x,r.d,s + y.dm; likewise along s. In y.d,s and y.d,r only the flat part of y counts (skew); the rest
/// is of second order in the warp of an element.
template <class V>
struct TransverseShear {
  V on_s1, on_s2, on_warp;           ///< by a_k.dm and hx.dm
  V on_b11, on_b12, on_b21, on_b22;  ///< by a_i.c_j
  V energy;
};

/// Products of an element's derivatives: all that strains, at any height and place across, depend on.
template <class V>
struct MotionProducts {
  V a11, a22, a12;       ///< a_i.a_j; in single lanes a11 and a22 less 1: see single.hpp
  V b11, b12, b21, b22;  ///< a_i.c_j
  V c11, c22, c12;       ///< c_i.c_j
  V a1h, a2h, hh;        ///< with hx
  V s1, s2, warp;        ///< a_k.mean, hx.mean
};

template <class V>
MotionProducts<V> motion_products(const ElementMotion<V>& m) {
  return {dot(m.a1, m.a1), dot(m.a2, m.a2),   dot(m.a1, m.a2),   dot(m.a1, m.c1),
          dot(m.a1, m.c2), dot(m.a2, m.c1),   dot(m.a2, m.c2),   dot(m.c1, m.c1),
          dot(m.c2, m.c2), dot(m.c1, m.c2),   dot(m.a1, m.hx),   dot(m.a2, m.hx),
          dot(m.hx, m.hx), dot(m.a1, m.mean), dot(m.a2, m.mean), dot(m.hx, m.mean)};
}

template <bool kRectangle = false, class V>
TransverseShear<V> transverse_shear(const ElementGeometry<V>& g, const MotionProducts<V>& m, const V& q) {
  const V quarter(0.25), inverse = g.inverse;
  const V &s1 = m.s1, &s2 = m.s2, &b11 = m.b11, &b12 = m.b12, &b21 = m.b21, &b22 = m.b22;
  TransverseShear<V> out;
  if constexpr (kRectangle) {
    const V y = quarter * m.warp, lr = g.r11 * b12 * g.r22 + y, ls = g.r22 * b21 * g.r11 + y;
    out.on_s1 = q * s1;
    out.on_s2 = q * s2;
    const V qr = q * g.linear_r * lr, qs = q * g.linear_s * ls;
    out.on_warp = quarter * (qr + qs);
    out.on_b12 = g.r22 * g.r11 * qr;
    out.on_b21 = g.r11 * g.r22 * qs;
    out.on_b11 = out.on_b22 = V(0.0);
    out.energy = V(0.5) * (out.on_s1 * s1 + out.on_s2 * s2 + qr * lr + qs * ls);
    return out;
  }
  const V b1r = g.r11 * b11 + g.r12 * b12, b2r = g.r11 * b21 + g.r12 * b22;  // a_k.d,r
  const V b1s = g.r21 * b11 + g.r22 * b12, b2s = g.r21 * b21 + g.r22 * b22;  // a_k.d,s
  const V k1 = quarter * g.skew1, k2 = quarter * g.skew2;
  const V yr = inverse * (k1 * b1r + k2 * b2r), ys = inverse * (k1 * b1s + k2 * b2s);
  const V shear1 = s1 + g.r22 * ys - g.r12 * yr, shear2 = s2 + g.r11 * yr - g.r21 * ys;
  const V y = quarter * m.warp + k1 * s1 + k2 * s2;
  const V lr = g.r11 * b1s + g.r12 * b2s + y, ls = g.r21 * b1r + g.r22 * b2r + y;
  const V q1 = q * shear1, q2 = q * shear2;
  const V qr = q * g.linear_r * lr, qs = q * g.linear_s * ls;

  const V on_ys = inverse * (q1 * g.r22 - q2 * g.r21), on_yr = inverse * (q2 * g.r11 - q1 * g.r12),
          on_y = qr + qs;
  const V on_b1s = g.r11 * qr + k1 * on_ys, on_b2s = g.r12 * qr + k2 * on_ys;
  const V on_b1r = g.r21 * qs + k1 * on_yr, on_b2r = g.r22 * qs + k2 * on_yr;
  out.on_s1 = q1 + k1 * on_y;
  out.on_s2 = q2 + k2 * on_y;
  out.on_warp = quarter * on_y;
  out.on_b11 = g.r21 * on_b1s + g.r11 * on_b1r;
  out.on_b12 = g.r22 * on_b1s + g.r12 * on_b1r;
  out.on_b21 = g.r21 * on_b2s + g.r11 * on_b2r;
  out.on_b22 = g.r22 * on_b2s + g.r12 * on_b2r;
  out.energy = V(0.5) * (q1 * shear1 + q2 * shear2 + qr * lr + qs * ls);
  return out;
}

}  // namespace drapeplan
