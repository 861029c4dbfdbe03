// How stiff a shell element is at most, for the stable step.
#pragma once

#include "fem/shell/kernel.hpp"

namespace drapeplan {

/// A fibre's tangent of the section, integrated over the thickness.
template <class V>
struct FibreStiffness {
  V stretch;  ///< in the element's middle [N/m]
  V across;   ///< of points across the fibre, for strains of opposite sign at both [N/m]
  V uneven;   ///< difference of both points, halved [N/m]
  V couple;   ///< fibre force by curvature, magnitude [N]
  V bend;     ///< [N m]

  /// Bound of the stretch at any place across.
  [[nodiscard]] V steepest() const {
    using std::abs, std::max;
    return max(stretch, across) + abs(uneven);
  }
};

/// Tangent of the section.
template <class V>
struct SectionStiffness {
  FibreStiffness<V> fibre1, fibre2;
  V shear;  ///< of the shear angle [N/m]
  V sine;   ///< magnitude, of the shear angle [-]

  [[nodiscard]] std::array<V*, 12> parts() {
    return {&fibre1.stretch, &fibre1.across, &fibre1.uneven, &fibre1.couple, &fibre1.bend, &shear,
            &fibre2.stretch, &fibre2.across, &fibre2.uneven, &fibre2.couple, &fibre2.bend, &sine};
  }
};

/// The section where every fibre has the modulus `fibre` and the shear curve the slope `shear` [Pa]. A fibre
/// force grows with curvature most where one half of the section carries and the other does not: t / 8.
inline SectionStiffness<double> steepest_section(double thickness, double fibre, double shear) {
  const double stretch = thickness * fibre;
  const FibreStiffness<double> both{stretch, stretch, 0, stretch * thickness / 8,
                                    stretch * thickness * thickness / 12};
  return {both, both, thickness * shear, 1};
}

/// What is left of a fibre when mass on edges carries (1 + kFibreInertiaMargin) times its steepest stretch.
/// The margin carries what couples stretch to curvature, C: with S the stretch carried, the quadratic form of
/// strain e and curvature k, margin S e^2 + 2 C e k + C^2 / (margin S) k^2, is a square.
/// @param off  share of the stretch that is not along the edges.  @param carried  with the margin [N/m].
inline constexpr double kFibreInertiaMargin = 0.1;
template <class V>
FibreStiffness<V> without_fibre_inertia(const FibreStiffness<V>& fibre, const V& off, const V& carried) {
  const V margin = V(kFibreInertiaMargin / (1 + kFibreInertiaMargin)) * carried, stretch = off * carried;
  return {stretch, stretch, V(0.0), V(0.0), fibre.bend + fibre.couple * fibre.couple / margin};
}

/// Squared radius of gyration of directors [m^2]: that of the section, enlarged by a ninth of the element's
/// area as in established explicit codes, so that bending and transverse shear never govern the step.
template <class V>
V gyration_squared(const ElementGeometry<V>& g, double thickness) {
  constexpr double kElementShare = 1.0 / 9;
  return V(thickness * thickness / 12) + V(kElementShare) * g.area;
}

/// How an element's bound is spread over its nodes: a node with slack, one whose mass could carry more
/// stiffness than its elements have, carries a larger part of them, and those with none a smaller one.
template <class V>
struct CornerShares {
  std::array<V, 4> lightness;  ///< 1 / slack, in (0, 1]
  std::array<V, 4> twin;       ///< 1 where a corner and the next one are the same node (triangles), else 0
};

/// Products of the vectors of an element's modes, weighted with the lightness of corners: the gradients b_1
/// and b_2 and the hourglass vector y = h - (h.X) b_1 - (h.Y) b_2.
template <class V>
struct ModeProducts {
  V b11, b22, b12, b1y, b2y, yy;
};

template <class V>
ModeProducts<V> mode_products(const ElementGeometry<V>& g, const CornerShares<V>& shares) {
  const std::array<V, 4> b1{g.b10, g.b11, -g.b10, -g.b11}, b2{g.b20, g.b21, -g.b20, -g.b21};
  std::array<V, 4> y;
  for (size_t c = 0; c < 4; ++c) y[c] = V(c % 2 == 0 ? 1.0 : -1.0) - g.skew1 * b1[c] - g.skew2 * b2[c];
  const auto product = [&shares](const std::array<V, 4>& p, const std::array<V, 4>& q) {
    V sum(0.0);
    for (size_t c = 0; c < 4; ++c) {
      const size_t next = (c + 1) % 4;
      sum += shares.lightness[c] * (p[c] * q[c] + shares.twin[c] * (p[c] * q[next] + p[next] * q[c]));
    }
    return sum;
  };
  return {product(b1, b1), product(b2, b2), product(b1, b2), product(b1, y), product(b2, y), product(y, y)};
}

/// A fibre's stiffness on its two modes, along b and along y across it, and their products.
template <class V>
struct FibreModes {
  V stretch, across, uneven;  ///< stiffness [N m]
  V bb, yy, by;               ///< [1/m^2]

  /// Largest eigenvalue: of a product of two symmetric matrices.
  [[nodiscard]] V largest() const {
    using std::max, std::sqrt;
    const V trace = stretch * bb + V(2.0) * uneven * by + across * yy;
    const V determinant = (stretch * across - uneven * uneven) * (bb * yy - by * by);
    return V(0.5) * (trace + sqrt(max(V(trace * trace - V(4.0) * determinant), V(0.0))));
  }
  /// Largest sum of a row, with what these modes have in common with others: @param b, y  sums of products.
  [[nodiscard]] V largest_row(const V& b, const V& y) const {
    using std::abs, std::max;
    const V on_b = bb + abs(by) + b, on_y = yy + abs(by) + y;
    return max(V(stretch * on_b + abs(uneven) * on_y), V(abs(uneven) * on_b + across * on_y));
  }
};

template <class V>
FibreModes<V> fibre_modes(const ElementGeometry<V>& g, const FibreStiffness<V>& fibre, const V& gyration2,
                          const V& half, const V& bb, const V& yy, const V& by) {
  using std::max, std::sqrt;
  const V place = V(AcrossRule<2>::place[0] * 0.25) / half;
  const V stretch = max(fibre.stretch, V(fibre.bend / gyration2)) + fibre.couple / sqrt(gyration2);
  return {g.area * stretch, g.area * fibre.across, g.area * fibre.uneven, bb, place * place * yy, place * by};
}

/// Bound k of an element's tangent [N/m]: its energy's second variation is at most k times the sum over
/// corners of (|dx|^2 + gyration^2 |dd|^2) / lightness.
///
/// The variation is a sum of squares, one per mode: stiffness times (vector . corner values)^2. Its largest
/// eigenvalue is that of the modes' Gram matrix. Modes whose products vanish do not add: the largest counts.
/// So it is for most in a rectangle of equal corners; what is left comes on top, by the rows of the matrix or
/// by its blocks, whichever is less. Transverse shear and directors are never much: equal corners are
/// assumed.
template <class V>
V element_bound(const ElementGeometry<V>& g, const KernelMaterial& material,
                const SectionStiffness<V>& section, const CornerShares<V>& shares) {
  using std::abs, std::max, std::min, std::sqrt;
  const V gyration2 = gyration_squared(g, material.thickness), per_gyration = V(1.0) / sqrt(gyration2);
  const ModeProducts<V> m = mode_products(g, shares);
  const V p12 = abs(m.b12), p1y = abs(m.b1y), p2y = abs(m.b2y);
  const FibreModes<V> f1 = fibre_modes(g, section.fibre1, gyration2, g.half1, m.b11, m.yy, m.b1y);
  const FibreModes<V> f2 = fibre_modes(g, section.fibre2, gyration2, g.half2, m.b22, m.yy, m.b2y);

  // What the modes of one fibre have in common with those of the other: with the direction, its sine.
  const V place(AcrossRule<2>::place[0] * 0.25);
  const V y1 = place / g.half1, y2 = place / g.half2, both = y1 * y2 * m.yy;
  const V by_rows = max(f1.largest_row(section.sine * (p12 + y2 * p1y), section.sine * (y1 * p2y + both)),
                        f2.largest_row(section.sine * (p12 + y1 * p2y), section.sine * (y2 * p1y + both)));
  const V stiff1 = max(f1.stretch, f1.across) + abs(f1.uneven);
  const V stiff2 = max(f2.stretch, f2.across) + abs(f2.uneven);
  const V common = sqrt(p12 * p12 + y2 * y2 * p1y * p1y + y1 * y1 * p2y * p2y + both * both);
  const V by_blocks = max(f1.largest(), f2.largest()) + section.sine * sqrt(stiff1 * stiff2) * common;
  const V fibres = min(by_rows, by_blocks), stiffer = max(stiff1, stiff2);
  const V shear = g.area * section.shear, sheared = shear * (m.b11 + m.b22 + V(2.0) * p12);
  const V in_plane = max(fibres, sheared) + sqrt(stiffer * shear) * (V(2.0) * p12 + y1 * p2y + y2 * p1y);

  // Hourglass control: along y as well, so with points across it adds.
  const HourglassStiffness<V> h = hourglass_stiffness(g, material);
  const V membrane = h.membrane * m.yy, director = h.director * per_gyration * per_gyration * m.yy;
  const V largest = max(in_plane, max(membrane, director));
  const V mixed = sqrt(max(stiffer, shear) * max(h.membrane, h.director * per_gyration * per_gyration)) *
                  (V(2.0) * (p1y + p2y) + (y1 + y2) * m.yy);
  const V planar = min(in_plane + max(membrane, director), largest + mixed);

  // Mean shear along both fibres, and the linear part along the element's own directions r and s.
  const V b11 = V(2.0) * (g.b10 * g.b10 + g.b11 * g.b11), b22 = V(2.0) * (g.b20 * g.b20 + g.b21 * g.b21);
  const V b12 = V(2.0) * abs(g.b10 * g.b20 + g.b11 * g.b21);
  const V r2 = g.r11 * g.r11 + g.r12 * g.r12, s2 = g.r21 * g.r21 + g.r22 * g.r22;
  const V det = g.r11 * g.r22 - g.r12 * g.r21, det2 = det * det;
  const V mean = max(b11, b22) + b12 + V(0.25) * (V(1.0) + section.sine) / gyration2;
  const V linear = V(1.0 / 12) * ((r2 + s2) / det2 + r2 * s2 / (det2 * gyration2));
  const V bent = V(1.0) + (abs(g.skew1) + abs(g.skew2)) / sqrt(r2 + s2);
  const V twins = shares.twin[0] + shares.twin[1] + shares.twin[2] + shares.twin[3];
  const V transverse = g.area * V(material.transverse) * max(mean, linear) * bent * (V(1.0) + twins);
  return max(planar, transverse);
}

/// The section's tangent in the element's state. `law` gives slopes near the strains of each section point.
template <int N, int A, class V, class Law>
SectionStiffness<V> section_tangent(const ElementGeometry<V>& g, const KernelMaterial& material,
                                    const Law& law, const Corners<V>& x, const Corners<V>& d) {
  using std::abs, std::max, std::sqrt;
  const ElementMotion<V> m = element_motion(g, x, d);
  const V zero(0.0), one(1.0);
  const FibreStiffness<V> none{zero, zero, zero, zero, zero};
  SectionStiffness<V> sum{none, none, zero, zero};
  for (size_t k = 0; k < size_t(N); ++k) {
    const V s(SectionRule<N>::place[k] * material.thickness),
        w(SectionRule<N>::weight[k] * material.thickness);
    const Vec3<V> f1 = m.a1 + s * m.c1, f2 = m.a2 + s * m.c2;
    const V length1 = sqrt(dot(f1, f1)), length2 = sqrt(dot(f2, f2));
    const V sine = dot(f1, f2) / (length1 * length2);
    for (size_t fibre = 0; fibre < 2; ++fibre) {
      FibreStiffness<V>& total = fibre == 0 ? sum.fibre1 : sum.fibre2;
      V e;
      if (2 * k + 1 != size_t(N) || A == 1) {
        e = w * law.fibre_slope(V((fibre == 0 ? length1 : length2) - one), 3 * k + fibre);
      } else {
        std::array<V, 2> at;
        for (size_t a = 0; a < size_t(A); ++a) {
          const V place = V(AcrossRule<A>::place[a] * 0.25) / (fibre == 0 ? g.half1 : g.half2);
          const Vec3<V> along = (fibre == 0 ? m.a1 : m.a2) + place * m.hx;
          at[a] = w * law.fibre_slope(V(sqrt(dot(along, along)) - one), fibre_slot<N>(k, fibre, a));
        }
        e = V(0.5) * (at[0] + at[1]);
        total.across += e;
        total.uneven += V(0.5) * (at[0] - at[1]);
      }
      total.stretch += e;
      total.couple += s * e;
      total.bend += s * s * e;
    }
    sum.sine = max(sum.sine, abs(sine));
    // tau / cos g over sin g: slope along the fibres' turning, and what turns the force itself.
    sum.shear +=
        w * (law.shear_slope(sine, 3 * k + 2) * (one - sine * sine) + V(2.0) * abs(material.shear(sine)));
  }
  sum.fibre1.couple = abs(sum.fibre1.couple);
  sum.fibre2.couple = abs(sum.fibre2.couple);
  return sum;
}

}  // namespace drapeplan
