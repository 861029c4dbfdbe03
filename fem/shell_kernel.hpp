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
#include <type_traits>
#include <utility>

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
      r22;             ///< half the element along its own directions: X,r = (r11, r12), X,s = (r21, r22) [m]
  V across1, across2;  ///< gradients of h.x/4 across each fibre, 1 / (4 half) [1/m]
  V shape;             ///< of the bilinear element: area (1/half1^2 + 1/half2^2) / 96 [-]
  V inverse;           ///< of r11 r22 - r12 r21 [1/m^2]
  V linear_r,
      linear_s;  ///< weights of linear transverse shear: (r21^2 + r22^2) inverse^2 / 3, and of r1 [1/m^2]

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

/// @tparam kRectangle  see ElementGeometry::rectangle: the same, less what is zero.
template <bool kRectangle = false, class V>
ElementMotion<V> element_motion(const ElementGeometry<V>& g, const Corners<V>& x, const Corners<V>& d) {
  const Vec3<V> p = x[0] - x[2], q = x[1] - x[3], dp = d[0] - d[2], dq = d[1] - d[3];
  const Vec3<V> even = d[0] + d[2], odd = d[1] + d[3];
  ElementMotion<V> m;
  m.mean = V(0.25) * (even + odd);
  if constexpr (kRectangle) {
    m.a1 = g.b11 * (q - p);
    m.a2 = g.b21 * (q + p);
    m.c1 = g.b11 * (dq - dp);
    m.c2 = g.b21 * (dq + dp);
    m.hx = (x[0] + x[2]) - (x[1] + x[3]);
    m.hd = even - odd;
    return m;
  }
  m.a1 = g.b10 * p + g.b11 * q;
  m.a2 = g.b20 * p + g.b21 * q;
  m.c1 = g.b10 * dp + g.b11 * dq;
  m.c2 = g.b20 * dp + g.b21 * dq;
  m.hx = (x[0] + x[2]) - (x[1] + x[3]) - g.skew1 * m.a1 - g.skew2 * m.a2;
  m.hd = even - odd - g.skew1 * m.c1 - g.skew2 * m.c2;
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
  V a11, a22, a12;       ///< a_i.a_j
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

/// Calls f with the constants 0 to K - 1.
template <size_t K, class F>
constexpr void unroll(const F& f) {
  [&f]<size_t... I>(std::index_sequence<I...>) {
    (f(std::integral_constant<size_t, I>()), ...);
  }
  (std::make_index_sequence<K>());
}

/// Slot of a fibre's strain in the law: 3 per section point, and behind them those of further points across.
template <int N>
constexpr size_t fibre_slot(size_t section_point, size_t fibre, size_t across) {
  return across == 0 ? 3 * section_point + fibre : 3 * size_t(N) + fibre;
}

/// What the section does: the energy's derivatives by the products, so that forces are sums of few vectors.
/// Of a fibre, by powers of the height s: n_k = sum over points of (a_k + s c_k) * stress; likewise m_k = sum
/// of s (a_k + s c_k) * stress, and what both fibres' turning against each other adds.
template <class V>
struct SectionForces {
  std::array<V, 3> fibre1, fibre2, both;  ///< by power of s
  V uneven1, uneven2;                     ///< of points across: on hx.a_k
  V across;                               ///< of points across: on hx.hx
};

/// Places where fibres are looked at: per section point one per fibre, and at mid-thickness A across each.
template <int N, int A>
inline constexpr size_t kFibrePlaces = 2 * (size_t(N) - 1 + size_t(A));

/// Adds what all section points do. In stages, each for all places: their chains of roots and of lookups are
/// long, and side by side they fill the pipes.
template <int N, int A, class V, class Law>
void add_section(const ElementGeometry<V>& g, const KernelMaterial& material, const MotionProducts<V>& m,
                 Law& law, FibreViscosity<V, A>& viscosity, SectionForces<V>& sum) {
  constexpr size_t kPoints = size_t(N), kMiddle = kPoints / 2, kPlaces = kFibrePlaces<N, A>;
  constexpr bool kAcross = A == 2;
  const V one(1.0);
  const std::array<V, 2> across{V(AcrossRule<2>::place[0]) * g.across1,
                                V(AcrossRule<2>::place[0]) * g.across2};
  // Stretches squared: by section point and fibre, the middle one's points across at the end.
  std::array<V, 2 * kPoints> square, length, inverse;
  std::array<V, kPoints> sine, shear;
  std::array<V, kPlaces> stress, stretch, unit;
  unroll<kPoints>([&](auto k) {
    const V s(SectionRule<N>::place[k] * material.thickness);
    square[2 * k] = m.a11;
    square[2 * k + 1] = m.a22;
    sine[k] = m.a12;
    if constexpr (k != kMiddle) {
      square[2 * k] += s * (V(2.0) * m.b11 + s * m.c11);
      square[2 * k + 1] += s * (V(2.0) * m.b22 + s * m.c22);
      sine[k] += s * (m.b12 + m.b21 + s * m.c12);
    }
  });
  unroll<2 * kPoints>([&](auto k) { root_and_inverse(square[k], length[k], inverse[k]); });
  const auto place_of = [](size_t k, size_t fibre) {
    return 2 * (k > kMiddle && kAcross ? k - 1 : k) + fibre;
  };
  const auto across_place = [](size_t fibre, size_t a) { return 2 * (kPoints - 1) + 2 * fibre + a; };
  unroll<2 * kPoints>([&](auto k) {
    if constexpr (!kAcross || k / 2 != kMiddle) {
      stretch[place_of(k / 2, k % 2)] = length[k];
      unit[place_of(k / 2, k % 2)] = inverse[k];
    }
  });
  if constexpr (kAcross) {
    unroll<2>([&](auto fibre) {
      const V& aa = fibre == 0 ? m.a11 : m.a22;
      const V side = V(2.0) * across[fibre] * (fibre == 0 ? m.a1h : m.a2h);
      const V bent = aa + across[fibre] * across[fibre] * m.hh;
      const size_t first = across_place(fibre, 0), second = across_place(fibre, 1);
      root_and_inverse(V(bent + side), stretch[first], unit[first]);
      root_and_inverse(V(bent - side), stretch[second], unit[second]);
    });
  }

  unroll<kPoints>([&](auto k) {
    sine[k] = sine[k] * inverse[2 * k] * inverse[2 * k + 1];
    shear[k] = law.shear(sine[k], 3 * k + 2);
    if constexpr (!kAcross || k != kMiddle) {
      unroll<2>([&](auto fibre) {
        const size_t at = place_of(k, fibre);
        stress[at] = law.fibre(V(stretch[at] - one), 3 * k + fibre);
      });
    }
  });
  unroll<2>([&](auto fibre) {
    unroll<size_t(A)>([&](auto a) {
      const size_t at = kAcross ? across_place(fibre, a) : place_of(kMiddle, fibre);
      const V e = stretch[at] - one;
      V& before = viscosity.strain[2 * a + fibre];
      if constexpr (kAcross) stress[at] = law.fibre(e, fibre_slot<N>(kMiddle, fibre, a));
      stress[at] += viscosity.modulus[fibre] * (e - before);
      before = e;
    });
  });

  unroll<kPoints>([&](auto k) {
    const V s(SectionRule<N>::place[k] * material.thickness),
        w(SectionRule<N>::weight[k] * material.thickness);
    const V &inverse1 = inverse[2 * k], &inverse2 = inverse[2 * k + 1];
    const V turning = w * shear[k], turned = turning * sine[k];
    V on1 = -(turned * inverse1 * inverse1), on2 = -(turned * inverse2 * inverse2);
    const V both = turning * inverse1 * inverse2;
    if constexpr (kAcross && k == kMiddle) {
      const V half = V(0.5) * w;
      unroll<2>([&](auto fibre) {
        const size_t first = across_place(fibre, 0), second = across_place(fibre, 1);
        const V p = half * stress[first] * unit[first], q = half * stress[second] * unit[second];
        const V total = p + q;
        (fibre == 0 ? on1 : on2) += total;
        (fibre == 0 ? sum.uneven1 : sum.uneven2) = across[fibre] * (p - q);
        sum.across += across[fibre] * across[fibre] * total;
      });
    } else {
      on1 += w * stress[place_of(k, 0)] * inverse1;
      on2 += w * stress[place_of(k, 1)] * inverse2;
    }
    const auto add = [&](const V& value, std::array<V, 3>& powers) {
      powers[0] += value;
      if constexpr (k != kMiddle) {
        const V once = s * value;
        powers[1] += once;
        powers[2] += s * once;
      }
    };
    add(on1, sum.fibre1);
    add(on2, sum.fibre2);
    add(both, sum.both);
  });
}

/// Forces that the element exerts on its corners: on positions [N] and on directors [N m].
/// @param law  stresses at section points, like StaticLaw.
template <int N, int A, bool kRectangle, class V, class Law>
void shell_forces(const ElementGeometry<V>& g, const KernelMaterial& material, Law& law,
                  FibreViscosity<V, A>& viscosity, const Corners<V>& x, const Corners<V>& d,
                  Corners<V>& force, Corners<V>& moment) {
  const ElementMotion<V> m = element_motion<kRectangle>(g, x, d);
  const MotionProducts<V> products = motion_products(m);
  const V zero(0.0);
  SectionForces<V> f{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}, zero, zero, zero};
  add_section<N, A>(g, material, products, law, viscosity, f);

  const TransverseShear<V> q = transverse_shear<kRectangle>(g, products, V(material.transverse));
  V on11 = f.fibre1[1], on22 = f.fibre2[1];
  if constexpr (!kRectangle) {
    on11 += q.on_b11;
    on22 += q.on_b22;
  }
  const V on12 = f.both[1] + q.on_b12, on21 = f.both[1] + q.on_b21;
  const Vec3<V> n1 =
      f.fibre1[0] * m.a1 + f.both[0] * m.a2 + on11 * m.c1 + on12 * m.c2 + q.on_s1 * m.mean + f.uneven1 * m.hx;
  const Vec3<V> n2 =
      f.both[0] * m.a1 + f.fibre2[0] * m.a2 + on21 * m.c1 + on22 * m.c2 + q.on_s2 * m.mean + f.uneven2 * m.hx;
  const Vec3<V> m1 = on11 * m.a1 + on21 * m.a2 + f.fibre1[2] * m.c1 + f.both[2] * m.c2;
  const Vec3<V> m2 = on12 * m.a1 + on22 * m.a2 + f.both[2] * m.c1 + f.fibre2[2] * m.c2;
  const HourglassStiffness<V> h = hourglass_stiffness(g, material);
  const V on_warp = g.area * q.on_warp - h.membrane * products.warp;
  const V quarter = V(0.25) * g.area;
  const Vec3<V> on_mean =
      (quarter * q.on_s1) * m.a1 + (quarter * q.on_s2) * m.a2 + (V(0.25) * on_warp) * m.hx;
  const Vec3<V> on_hx = (g.area * f.uneven1) * m.a1 + (g.area * f.uneven2) * m.a2 +
                        (g.area * f.across + h.membrane) * m.hx + on_warp * m.mean;
  const Vec3<V> on_hd = h.director * m.hd;

  // A force is minus the energy's derivative. In a rectangle b = (-b11, b11, b11, -b11) and
  // (b21, b21, -b21, -b21).
  if constexpr (kRectangle) {
    const Vec3<V> u = (g.area * g.b11) * n1, v = (g.area * g.b21) * n2, sum = u + v, difference = u - v;
    force = {difference - on_hx, on_hx - sum, -difference - on_hx, sum + on_hx};
    const Vec3<V> mu = (g.area * g.b11) * m1, mv = (g.area * g.b21) * m2;
    const Vec3<V> msum = mu + mv, mdifference = mu - mv, even = on_mean + on_hd, odd = on_mean - on_hd;
    moment = {mdifference - even, -msum - odd, -mdifference - even, msum - odd};
  } else {
    const auto corners = [&g](const Vec3<V>& on1, const Vec3<V>& on2, const Vec3<V>& on_h, Corners<V>& out) {
      const Vec3<V> r1 = g.area * on1 - g.skew1 * on_h, r2 = g.area * on2 - g.skew2 * on_h;
      const Vec3<V> p = g.b10 * r1 + g.b20 * r2, r = g.b11 * r1 + g.b21 * r2;
      out = {-p - on_h, on_h - r, p - on_h, r + on_h};
    };
    corners(n1, n2, on_hx, force);
    corners(m1, m2, on_hd, moment);
    for (Vec3<V>& at : moment) at = at - on_mean;
  }
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
  energy.fabric = g.area * (density + transverse_shear(g, motion_products(m), material.transverse).energy);
  energy.hourglass = 0.5 * h.membrane * (dot(m.hx, m.hx) - warp * warp) + 0.5 * h.director * dot(m.hd, m.hd);
  return energy;
}

}  // namespace drapeplan
