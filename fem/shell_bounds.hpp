// How stiff a shell element is at most: rows of its tangent, for the stable step.
#pragma once

#include <array>

#include "fem/shell_kernel.hpp"

namespace drapeplan {

/// Tangent of the section, integrated over the thickness.
template <class V>
struct SectionStiffness {
  V stretch1, stretch2;  ///< fibres [N/m]
  V couple1, couple2;    ///< fibre force by curvature, magnitude [N]
  V bend1, bend2;        ///< fibres [N m]
  V shear;               ///< of the shear angle [N/m]
};

/// Sums of absolute rows of an element's tangent, for corners 0 and 2, and for corners 1 and 3.
template <class V>
struct ElementRows {
  std::array<V, 2> translation, rotation, coupling;  ///< [N/m], [N m], [N]
};

/// The section where every fibre has the modulus `fibre` and the shear curve the slope `shear` [Pa]. A fibre
/// force grows with curvature most where one half of the section carries and the other does not: t / 8.
inline SectionStiffness<double> steepest_section(double thickness, double fibre, double shear) {
  const double stretch = thickness * fibre, couple = stretch * thickness / 8,
               bend = stretch * thickness * thickness / 12;
  return {stretch, stretch, couple, couple, bend, bend, thickness * shear};
}

/// Both fibre families may act fully on the same node, but never in the same pattern: along one wave,
/// sin^2 a cos^2 b + cos^2 a sin^2 b <= 1, whatever the shear angle. So the larger counts.
template <class V>
ElementRows<V> element_rows(const ElementGeometry<V>& g, const KernelMaterial& material,
                            const SectionStiffness<V>& section) {
  using std::abs, std::max, std::min;
  const HourglassStiffness<V> h = hourglass_stiffness(g, material);
  const V transverse(material.transverse), t2(material.thickness * material.thickness / 12);
  const std::array<V, 2> b1{abs(g.b10), abs(g.b11)}, b2{abs(g.b20), abs(g.b21)};
  const V sum1 = V(2.0) * (b1[0] + b1[1]), sum2 = V(2.0) * (b2[0] + b2[1]);
  // Transverse shear per unit of hourglass displacement.
  const V warp = V(0.25) / min(g.half1, g.half2);
  ElementRows<V> rows;
  for (size_t c = 0; c < 2; ++c) {
    const V row1 = b1[c] * sum1, row2 = b2[c] * sum2;
    const V shear = section.shear * (b1[c] + b2[c]) * (sum1 + sum2);
    rows.translation[c] = g.area * (max(section.stretch1 * row1, section.stretch2 * row2) + shear +
                                    transverse * (row1 + row2)) +
                          V(4.0) * (h.membrane + g.area * transverse * V(2.0 / 3) * warp * warp);
    rows.rotation[c] = g.area * (max(section.bend1 * row1, section.bend2 * row2) + t2 * shear +
                                 transverse * V(0.5 + 2.0 / 3)) +
                       V(4.0) * h.director;
    rows.coupling[c] =
        g.area * (max(section.couple1 * row1, section.couple2 * row2) + transverse * (b1[c] + b2[c] + warp));
  }
  return rows;
}

/// The section's tangent in the element's state. `law` gives slopes near the strains of each section point.
template <int N, class V, class Law>
SectionStiffness<V> section_tangent(const ElementGeometry<V>& g, const KernelMaterial& material,
                                    const Law& law, const Corners<V>& x, const Corners<V>& d) {
  using std::abs, std::sqrt;
  const ElementMotion<V> m = element_motion(g, x, d);
  const V zero(0.0), one(1.0);
  SectionStiffness<V> sum{zero, zero, zero, zero, zero, zero, zero};
  for (size_t k = 0; k < size_t(N); ++k) {
    const V s(SectionRule<N>::place[k] * material.thickness),
        w(SectionRule<N>::weight[k] * material.thickness);
    const Vec3<V> f1 = m.a1 + s * m.c1, f2 = m.a2 + s * m.c2;
    const V length1 = sqrt(dot(f1, f1)), length2 = sqrt(dot(f2, f2));
    const V sine = dot(f1, f2) / (length1 * length2);
    const V e1 = w * law.fibre_slope(V(length1 - one), 3 * k),
            e2 = w * law.fibre_slope(V(length2 - one), 3 * k + 1);
    sum.stretch1 += e1;
    sum.stretch2 += e2;
    sum.couple1 += s * e1;
    sum.couple2 += s * e2;
    sum.bend1 += s * s * e1;
    sum.bend2 += s * s * e2;
    // tau / cos g over sin g: slope along the fibres' turning, and what turns the force itself.
    sum.shear +=
        w * (law.shear_slope(sine, 3 * k + 2) * (one - sine * sine) + V(2.0) * abs(material.shear(sine)));
  }
  sum.couple1 = abs(sum.couple1);
  sum.couple2 = abs(sum.couple2);
  return sum;
}

}  // namespace drapeplan
