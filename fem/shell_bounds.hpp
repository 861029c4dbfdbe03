// How stiff a shell element is at most, for the stable step.
#pragma once

#include "fem/shell_kernel.hpp"

namespace drapeplan {

/// Tangent of the section, integrated over the thickness.
template <class V>
struct SectionStiffness {
  V stretch1, stretch2;  ///< fibres [N/m]
  V couple1, couple2;    ///< fibre force by curvature, magnitude [N]
  V bend1, bend2;        ///< fibres [N m]
  V shear;               ///< of the shear angle [N/m]
  V sine;                ///< magnitude, of the shear angle [-]
};

/// The section where every fibre has the modulus `fibre` and the shear curve the slope `shear` [Pa]. A fibre
/// force grows with curvature most where one half of the section carries and the other does not: t / 8.
inline SectionStiffness<double> steepest_section(double thickness, double fibre, double shear) {
  const double stretch = thickness * fibre, couple = stretch * thickness / 8,
               bend = stretch * thickness * thickness / 12;
  return {stretch, stretch, couple, couple, bend, bend, thickness * shear, 1};
}

/// Squared radius of gyration of directors [m^2]: that of the section, enlarged by a ninth of the element's
/// area as in established explicit codes, so that bending and transverse shear never govern the step.
template <class V>
V gyration_squared(const ElementGeometry<V>& g, double thickness) {
  constexpr double kElementShare = 1.0 / 9;
  return V(thickness * thickness / 12) + V(kElementShare) * g.area;
}

/// Bound k of an element's tangent [N/m]: its energy's second variation is at most k times the sum over
/// corners of |dx|^2 + gyration^2 |dd|^2.
///
/// The variation is a sum of squares, one per mode: stiffness times (vector . corner values)^2. Modes whose
/// vectors are orthogonal do not add: the largest counts. In a rectangle all are (the gradients b_1, b_2 and
/// h are, and so are the directions along a fibre, across it and off the surface); what distortion adds comes
/// on top as products.
template <class V>
V element_bound(const ElementGeometry<V>& g, const KernelMaterial& material,
                const SectionStiffness<V>& section) {
  using std::abs, std::max, std::sqrt;
  const V gyration2 = gyration_squared(g, material.thickness), per_gyration = V(1.0) / sqrt(gyration2);
  const V b11 = V(2.0) * (g.b10 * g.b10 + g.b11 * g.b11), b22 = V(2.0) * (g.b20 * g.b20 + g.b21 * g.b21);
  const V b12 = V(2.0) * abs(g.b10 * g.b20 + g.b11 * g.b21);
  const auto with_bending = [&](const V& stretch, const V& couple, const V& bend) {
    return max(stretch, bend * per_gyration * per_gyration) + couple * per_gyration;
  };
  const V fibre1 = with_bending(section.stretch1, section.couple1, section.bend1);
  const V fibre2 = with_bending(section.stretch2, section.couple2, section.bend2);
  const V oblique = sqrt(fibre1 * fibre2) + V(2.0) * sqrt(max(fibre1, fibre2) * section.shear);
  const V in_plane =
      g.area * (max(max(fibre1 * b11, fibre2 * b22), section.shear * (b11 + b22)) + b12 * oblique);

  const HourglassStiffness<V> h = hourglass_stiffness(g, material);
  const V skewed = g.skew1 * g.skew1 * b11 + g.skew2 * g.skew2 * b22;
  const V hourglass = V(4.0) * max(h.membrane, h.director / gyration2);
  const V mixed = sqrt(skewed * h.membrane * in_plane);

  // Mean shear along both fibres, and the linear part along the element's own directions r and s.
  const V r2 = g.r11 * g.r11 + g.r12 * g.r12, s2 = g.r21 * g.r21 + g.r22 * g.r22;
  const V det = g.r11 * g.r22 - g.r12 * g.r21, det2 = det * det;
  const V mean = max(b11, b22) + b12 + V(0.25) * (V(1.0) + section.sine) / gyration2;
  const V linear = V(1.0 / 12) * ((r2 + s2) / det2 + r2 * s2 / (det2 * gyration2));
  const V bent = V(1.0) + (abs(g.skew1) + abs(g.skew2)) / sqrt(r2 + s2);
  const V transverse = g.area * V(material.transverse) * max(mean, linear) * bent;
  return max(max(in_plane, hourglass), transverse) + mixed;
}

/// The section's tangent in the element's state. `law` gives slopes near the strains of each section point.
template <int N, int A, class V, class Law>
SectionStiffness<V> section_tangent(const ElementGeometry<V>& g, const KernelMaterial& material,
                                    const Law& law, const Corners<V>& x, const Corners<V>& d) {
  using std::abs, std::max, std::sqrt;
  const ElementMotion<V> m = element_motion(g, x, d);
  const V zero(0.0), one(1.0);
  SectionStiffness<V> sum{zero, zero, zero, zero, zero, zero, zero, zero};
  for (size_t k = 0; k < size_t(N); ++k) {
    const V s(SectionRule<N>::place[k] * material.thickness),
        w(SectionRule<N>::weight[k] * material.thickness);
    const Vec3<V> f1 = m.a1 + s * m.c1, f2 = m.a2 + s * m.c2;
    const V length1 = sqrt(dot(f1, f1)), length2 = sqrt(dot(f2, f2));
    const V sine = dot(f1, f2) / (length1 * length2);
    V e1(0.0), e2(0.0);
    if (2 * k + 1 != size_t(N) || A == 1) {
      e1 = w * law.fibre_slope(V(length1 - one), 3 * k);
      e2 = w * law.fibre_slope(V(length2 - one), 3 * k + 1);
    } else {
      for (size_t a = 0; a < size_t(A); ++a) {
        const V place(AcrossRule<A>::place[a] * 0.25);
        const Vec3<V> g1 = m.a1 + (place / g.half1) * m.hx, g2 = m.a2 + (place / g.half2) * m.hx;
        e1 = max(e1, w * law.fibre_slope(V(sqrt(dot(g1, g1)) - one), fibre_slot<N>(k, 0, a)));
        e2 = max(e2, w * law.fibre_slope(V(sqrt(dot(g2, g2)) - one), fibre_slot<N>(k, 1, a)));
      }
    }
    sum.stretch1 += e1;
    sum.stretch2 += e2;
    sum.couple1 += s * e1;
    sum.couple2 += s * e2;
    sum.bend1 += s * s * e1;
    sum.bend2 += s * s * e2;
    sum.sine = max(sum.sine, abs(sine));
    // tau / cos g over sin g: slope along the fibres' turning, and what turns the force itself.
    sum.shear +=
        w * (law.shear_slope(sine, 3 * k + 2) * (one - sine * sine) + V(2.0) * abs(material.shear(sine)));
  }
  sum.couple1 = abs(sum.couple1);
  sum.couple2 = abs(sum.couple2);
  return sum;
}

}  // namespace drapeplan
