// One-point director shell with fabric law: forces of one lane-block of elements.
//
// Source: seed, "Transient Nonlinear FE Model" (reduced integration, first-order shear deformation, nominal
// stress over nominal strain along the fibres, decoupled modes, bending through section points). Differs:
// total-Lagrangian with unit directors d instead of rotations, so rigid motion is exact.
//
// At the element's middle, with X the flat rest place and h = (1, -1, 1, -1) over the corners:
//   a_k = x,k    c_k = d,k    dm = mean d    fibre vectors at height s of the section: f_k = a_k + s c_k
//   nominal strain e_k = |f_k| - 1,  shear angle: sin g = f_1.f_2 / (|f_1||f_2|),  transverse shear a_k . dm
// Energy per rest area = sum over section points of w t [ U(e_1) + U(e_2) + V(g) ] + K G t (s_1^2 + s_2^2)
// / 2. With S = tau / cos g (tabulated over sin g) the force conjugate to f_1 is  T_1 n_1 + S (n_2 - sin g
// n_1) / |f_1|.
//
// Hourglass: hx = h.x - (h.X) a_1 - (h.Y) a_2 vanishes for every linear field; likewise hd. Their stiffness
// is the physical one of the bilinear element for a fibre in compression (in-plane part and directors).
//
// Transverse shear is that of the MITC4 element (Dvorkin and Bathe 1984): along the element's own directions
// it is taken at the middles of its edges, where a field of constant curvature has none, whatever the shape.
#pragma once

#include <array>

#include "fem/lanes.hpp"
#include "fem/lookup.hpp"

namespace drapeplan {

/// Rest geometry of one element, or of a block of them.
template <class V>
struct ElementGeometry {
  V b10, b11, b20, b21;  ///< gradient of the middle: d/du = b10, b11, -b10, -b11; d/dv likewise [1/m]
  V area;                ///< [m^2]
  V half1, half2;        ///< half the element's length along each fibre [m]
  V skew1, skew2;        ///< h.X and h.Y: zero for a parallelogram [m]
  V r11, r12, r21,
      r22;  ///< half the element along its own directions: X,r = (r11, r12), X,s = (r21, r22) [m]
};

/// Corner values of one element, or of a block: positions or directors.
template <class V>
using Corners = std::array<Vec3<V>, 4>;

/// Gauss points and weights over the thickness, in units of the thickness.
template <int N>
struct SectionRule;
template <>
struct SectionRule<1> {
  static constexpr std::array<double, 1> place{0.0}, weight{1.0};
};
template <>
struct SectionRule<3> {
  static constexpr std::array<double, 3> place{-0.38729833462074170, 0.0, 0.38729833462074170};
  static constexpr std::array<double, 3> weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
};
template <>
struct SectionRule<5> {
  static constexpr std::array<double, 5> place{-0.45308992296933199, -0.26923465505284155, 0.0,
                                               0.26923465505284155, 0.45308992296933199};
  static constexpr std::array<double, 5> weight{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                                0.23931433524968324, 0.11846344252809454};
};

/// The fabric as the kernel needs it; of the slowest curves where it depends on rates.
struct KernelMaterial {
  Lookup fibre;  ///< nominal stress over nominal strain, tension and compression [Pa]
  Lookup shear;  ///< tau / cos g over sin g [Pa]
  double thickness = 0;
  double transverse = 0;         ///< K G t [N/m]
  double hourglass_modulus = 0;  ///< in-plane [Pa]
  double director_modulus = 0;   ///< of directors [Pa]
};

/// The law of a fabric that does not depend on rates.
class StaticLaw {
 public:
  explicit StaticLaw(const KernelMaterial& material) : material_(material) {}
  /// @param slot  of the strain in the element: 3 per section point (fibre 1, fibre 2, shear).
  template <class V>
  [[nodiscard]] V fibre(const V& strain, size_t /*slot*/) const {
    return material_.fibre(strain);
  }
  template <class V>
  [[nodiscard]] V shear(const V& sine, size_t /*slot*/) const {
    return material_.shear(sine);
  }
  [[nodiscard]] Lanes fibre_slope(const Lanes& strain, size_t /*slot*/) const {
    return material_.fibre.steepest_near(strain);
  }
  [[nodiscard]] Lanes shear_slope(const Lanes& sine, size_t /*slot*/) const {
    return material_.shear.steepest_near(sine);
  }

 private:
  const KernelMaterial& material_;
};

/// Derivatives of a block: what the kernel computes from corners before it needs the law.
template <class V>
struct ElementMotion {
  Vec3<V> a1, a2, c1, c2, mean, hx, hd;
};

template <class V>
ElementMotion<V> element_motion(const ElementGeometry<V>& g, const Corners<V>& x, const Corners<V>& d) {
  const Vec3<V> p = x[0] - x[2], q = x[1] - x[3], dp = d[0] - d[2], dq = d[1] - d[3];
  ElementMotion<V> m;
  m.a1 = g.b10 * p + g.b11 * q;
  m.a2 = g.b20 * p + g.b21 * q;
  m.c1 = g.b10 * dp + g.b11 * dq;
  m.c2 = g.b20 * dp + g.b21 * dq;
  m.mean = V(0.25) * ((d[0] + d[2]) + (d[1] + d[3]));
  m.hx = (x[0] + x[2]) - (x[1] + x[3]) - g.skew1 * m.a1 - g.skew2 * m.a2;
  m.hd = (d[0] + d[2]) - (d[1] + d[3]) - g.skew1 * m.c1 - g.skew2 * m.c2;
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
  const V shape = g.area * (V(1.0) / (g.half1 * g.half1) + V(1.0) / (g.half2 * g.half2)) * V(1.0 / 96);
  const double t = material.thickness;
  return {V(material.hourglass_modulus * t) * shape, V(material.director_modulus * t * t * t / 12) * shape};
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

template <class V>
TransverseShear<V> transverse_shear(const ElementGeometry<V>& g, const ElementMotion<V>& m, const V& q) {
  const V quarter(0.25), det = g.r11 * g.r22 - g.r12 * g.r21, inverse = V(1.0) / det;
  const V s1 = dot(m.a1, m.mean), s2 = dot(m.a2, m.mean);
  const V b11 = dot(m.a1, m.c1), b12 = dot(m.a1, m.c2), b21 = dot(m.a2, m.c1), b22 = dot(m.a2, m.c2);
  const V b1r = g.r11 * b11 + g.r12 * b12, b2r = g.r11 * b21 + g.r12 * b22;  // a_k.d,r
  const V b1s = g.r21 * b11 + g.r22 * b12, b2s = g.r21 * b21 + g.r22 * b22;  // a_k.d,s
  const V k1 = quarter * g.skew1, k2 = quarter * g.skew2;
  const V yr = inverse * (k1 * b1r + k2 * b2r), ys = inverse * (k1 * b1s + k2 * b2s);
  const V shear1 = s1 + g.r22 * ys - g.r12 * yr, shear2 = s2 + g.r11 * yr - g.r21 * ys;
  const V y = quarter * dot(m.hx, m.mean) + k1 * s1 + k2 * s2;
  const V lr = g.r11 * b1s + g.r12 * b2s + y, ls = g.r21 * b1r + g.r22 * b2r + y;
  const V third = q * V(1.0 / 3) * inverse * inverse;
  const V q1 = q * shear1, q2 = q * shear2;
  const V qr = third * (g.r22 * g.r22 + g.r21 * g.r21) * lr,
          qs = third * (g.r11 * g.r11 + g.r12 * g.r12) * ls;

  const V on_ys = inverse * (q1 * g.r22 - q2 * g.r21), on_yr = inverse * (q2 * g.r11 - q1 * g.r12),
          on_y = qr + qs;
  const V on_b1s = g.r11 * qr + k1 * on_ys, on_b2s = g.r12 * qr + k2 * on_ys;
  const V on_b1r = g.r21 * qs + k1 * on_yr, on_b2r = g.r22 * qs + k2 * on_yr;
  TransverseShear<V> out;
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

/// Linear bulk viscosity along both fibres at mid-thickness: stress = modulus times change over the last
/// step.
template <class V, int A>
struct FibreViscosity {
  std::array<V, 2> modulus;     ///< [Pa], over the weight of the middle section point; by fibre
  std::array<V, 2 * A> strain;  ///< in: of the step before; out: of this one; by fibre, then by point across
};

/// Where a fibre is looked at across its direction at mid-thickness, in halves of the element: in the middle,
/// or at two Gauss points. One point leaves the mode free in which opposite edges stretch and shorten.
template <int A>
struct AcrossRule;
template <>
struct AcrossRule<1> {
  static constexpr std::array<double, 1> place{0.0};
};
template <>
struct AcrossRule<2> {
  static constexpr std::array<double, 2> place{0.57735026918962576, -0.57735026918962576};
};

/// Slot of a fibre's strain in the law: 3 per section point, and behind them those of further points across.
template <int N>
constexpr size_t fibre_slot(size_t section_point, size_t fibre, size_t across) {
  return across == 0 ? 3 * section_point + fibre : 3 * size_t(N) + fibre;
}

/// Forces that the element exerts on its corners: on positions [N] and on directors [N m].
/// @param law  stresses at section points, like StaticLaw.
template <int N, int A, class V, class Law>
void shell_forces(const ElementGeometry<V>& g, const KernelMaterial& material, Law& law,
                  FibreViscosity<V, A>& viscosity, const Corners<V>& x, const Corners<V>& d,
                  Corners<V>& force, Corners<V>& moment) {
  using std::sqrt;
  const ElementMotion<V> m = element_motion(g, x, d);
  const V zero(0.0), one(1.0);
  Vec3<V> n1{zero, zero, zero}, n2 = n1, m1 = n1, m2 = n1, across = n1;

  for (size_t k = 0; k < size_t(N); ++k) {
    const V s(SectionRule<N>::place[k] * material.thickness),
        w(SectionRule<N>::weight[k] * material.thickness);
    const Vec3<V> f1 = m.a1 + s * m.c1, f2 = m.a2 + s * m.c2;
    const V length1 = sqrt(dot(f1, f1)), length2 = sqrt(dot(f2, f2));
    const V inverse1 = one / length1, inverse2 = one / length2;
    const V sine = dot(f1, f2) * inverse1 * inverse2;
    const V shear = law.shear(sine, 3 * k + 2);
    const V both = w * shear * inverse1 * inverse2;
    const bool middle = 2 * k + 1 == size_t(N);
    V t1 = zero, t2 = zero;
    if (!middle || A == 1) {
      const V e1 = length1 - one, e2 = length2 - one;
      t1 = law.fibre(e1, 3 * k);
      t2 = law.fibre(e2, 3 * k + 1);
      if (middle) {
        t1 += viscosity.modulus[0] * (e1 - viscosity.strain[0]);
        t2 += viscosity.modulus[1] * (e2 - viscosity.strain[1]);
        viscosity.strain[0] = e1;
        viscosity.strain[1] = e2;
      }
    }
    const Vec3<V> p1 = (w * (t1 - shear * sine * inverse1) * inverse1) * f1 + both * f2;
    const Vec3<V> p2 = (w * (t2 - shear * sine * inverse2) * inverse2) * f2 + both * f1;
    n1 = n1 + p1;
    n2 = n2 + p2;
    m1 = m1 + s * p1;
    m2 = m2 + s * p2;
    if (middle && A == 2) {
      for (size_t fibre = 0; fibre < 2; ++fibre) {
        const Vec3<V>& along = fibre == 0 ? m.a1 : m.a2;
        const V quarter = V(0.25) / (fibre == 0 ? g.half1 : g.half2);
        for (size_t a = 0; a < size_t(A); ++a) {
          const V place = V(AcrossRule<A>::place[a]) * quarter;
          const Vec3<V> f = along + place * m.hx;
          const V length = sqrt(dot(f, f)), e = length - one;
          V& before = viscosity.strain[2 * a + fibre];
          const V stress = law.fibre(e, fibre_slot<N>(k, fibre, a)) + viscosity.modulus[fibre] * (e - before);
          before = e;
          const Vec3<V> p = (V(1.0 / A) * w * stress / length) * f;
          (fibre == 0 ? n1 : n2) = (fibre == 0 ? n1 : n2) + p;
          across = across + place * p;
        }
      }
    }
  }

  const TransverseShear<V> q = transverse_shear(g, m, V(material.transverse));
  n1 = n1 + q.on_s1 * m.mean + q.on_b11 * m.c1 + q.on_b12 * m.c2;
  n2 = n2 + q.on_s2 * m.mean + q.on_b21 * m.c1 + q.on_b22 * m.c2;
  m1 = m1 + q.on_b11 * m.a1 + q.on_b21 * m.a2;
  m2 = m2 + q.on_b12 * m.a1 + q.on_b22 * m.a2;
  const V warp = dot(m.hx, m.mean);
  const HourglassStiffness<V> h = hourglass_stiffness(g, material);
  const Vec3<V> on_mean =
      g.area * (q.on_s1 * m.a1 + q.on_s2 * m.a2 + q.on_warp * m.hx) - (h.membrane * warp) * m.hx;
  const Vec3<V> on_hx =
      g.area * across + (g.area * q.on_warp - h.membrane * warp) * m.mean + h.membrane * m.hx;
  const Vec3<V> on_hd = h.director * m.hd;

  // From derivatives back to corners; a force is minus the energy's derivative.
  const auto spread = [&g](const Vec3<V>& on1, const Vec3<V>& on2, const Vec3<V>& on_h, const Vec3<V>& on_all,
                           Corners<V>& out) {
    const Vec3<V> r1 = g.area * on1 - g.skew1 * on_h, r2 = g.area * on2 - g.skew2 * on_h;
    const Vec3<V> p = g.b10 * r1 + g.b20 * r2, r = g.b11 * r1 + g.b21 * r2;
    out[0] = V(-1.0) * (on_all + p + on_h);
    out[1] = V(-1.0) * (on_all + r - on_h);
    out[2] = p - on_all - on_h;
    out[3] = r - on_all + on_h;
  };
  spread(n1, n2, on_hx, {zero, zero, zero}, force);
  spread(m1, m2, on_hd, V(0.25) * on_mean, moment);
}

/// Stored energy of one element [J].
struct ElementEnergy {
  double fabric = 0, hourglass = 0;
};

template <int N, int A>
ElementEnergy shell_energy(const ElementGeometry<double>& g, const KernelMaterial& material,
                           const Corners<double>& x, const Corners<double>& d) {
  const ElementMotion<double> m = element_motion(g, x, d);
  double density = 0;
  for (size_t k = 0; k < size_t(N); ++k) {
    const double s = SectionRule<N>::place[k] * material.thickness,
                 w = SectionRule<N>::weight[k] * material.thickness;
    const Vec3<double> f1 = m.a1 + s * m.c1, f2 = m.a2 + s * m.c2;
    const double length1 = std::sqrt(dot(f1, f1)), length2 = std::sqrt(dot(f2, f2));
    const double sine = dot(f1, f2) / (length1 * length2);
    density += w * material.shear.integral(sine);
    if (2 * k + 1 != size_t(N) || A == 1) {
      density += w * (material.fibre.integral(length1 - 1) + material.fibre.integral(length2 - 1));
      continue;
    }
    for (const double place : AcrossRule<A>::place) {
      const Vec3<double> g1 = m.a1 + (place * 0.25 / g.half1) * m.hx,
                         g2 = m.a2 + (place * 0.25 / g.half2) * m.hx;
      density += w / A *
                 (material.fibre.integral(std::sqrt(dot(g1, g1)) - 1) +
                  material.fibre.integral(std::sqrt(dot(g2, g2)) - 1));
    }
  }
  const double warp = dot(m.hx, m.mean);
  const HourglassStiffness<double> h = hourglass_stiffness(g, material);
  ElementEnergy energy;
  energy.fabric = g.area * (density + transverse_shear(g, m, material.transverse).energy);
  energy.hourglass = 0.5 * h.membrane * (dot(m.hx, m.hx) - warp * warp) + 0.5 * h.director * dot(m.hd, m.hd);
  return energy;
}

}  // namespace drapeplan
