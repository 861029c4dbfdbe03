// One-point director shell with fabric law: forces of one lane-block of elements.
//
// Source: [Krogh], "Transient Nonlinear FE Model" (reduced integration, first-order shear deformation,
// nominal stress over nominal strain along the fibres, decoupled modes, bending through section points).
// Differs: total-Lagrangian with unit directors d instead of rotations, so rigid motion is exact.
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

#include "fem/shell/section.hpp"

namespace drapeplan {

/// What pulls at an element, per rest area: on its derivatives a_k (n) and c_k (m); on hx, hd and the mean
/// director.
/// @param law  stresses at section points, like StaticLaw.
/// @param give  gets these seven. They are passed one by one: copies of what holds them all would not stay in
///     registers.
template <int N, int A, bool kRectangle, class V, class Law, class Give>
void element_pull(const ElementGeometry<V>& g, const KernelMaterial& material, Law& law,
                  FibreViscosity<V, A>& viscosity, const ElementMotion<V>& m,
                  const MotionProducts<V>& products, const Give& give) {
  Section<N, A, V> section(g, material, products);
  section.look_up(law, viscosity);
  const SectionForces<V> f = section.forces();

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
  give(n1, n2, on_hx, m1, m2, on_hd, on_mean);
}

/// Forces of these on corners of an element that is no rectangle.
template <class V>
void corners_of(const ElementGeometry<V>& g, const Vec3<V>& on1, const Vec3<V>& on2, const Vec3<V>& on_h,
                Corners<V>& out) {
  const Vec3<V> r1 = g.area * on1 - g.skew1 * on_h, r2 = g.area * on2 - g.skew2 * on_h;
  const Vec3<V> p = g.b10 * r1 + g.b20 * r2, r = g.b11 * r1 + g.b21 * r2;
  out = {-p - on_h, on_h - r, p - on_h, r + on_h};
}

/// Forces on the corners [N]: minus the energy's derivative. In a rectangle b = (-b11, b11, b11, -b11) and
/// (b21, b21, -b21, -b21).
template <bool kRectangle, class V>
void corner_forces(const ElementGeometry<V>& g, const Vec3<V>& n1, const Vec3<V>& n2, const Vec3<V>& on_hx,
                   Corners<V>& force) {
  if constexpr (kRectangle) {
    const Vec3<V> u = (g.area * g.b11) * n1, v = (g.area * g.b21) * n2, sum = u + v, difference = u - v;
    force = {difference - on_hx, on_hx - sum, -difference - on_hx, sum + on_hx};
  } else {
    corners_of(g, n1, n2, on_hx, force);
  }
}

/// Likewise on the directors of corners [N m].
template <bool kRectangle, class V>
void corner_moments(const ElementGeometry<V>& g, const Vec3<V>& m1, const Vec3<V>& m2, const Vec3<V>& on_hd,
                    const Vec3<V>& on_mean, Corners<V>& moment) {
  if constexpr (kRectangle) {
    const Vec3<V> mu = (g.area * g.b11) * m1, mv = (g.area * g.b21) * m2;
    const Vec3<V> msum = mu + mv, mdifference = mu - mv, even = on_mean + on_hd, odd = on_mean - on_hd;
    moment = {mdifference - even, -msum - odd, -mdifference - even, msum - odd};
  } else {
    corners_of(g, m1, m2, on_hd, moment);
    for (Vec3<V>& at : moment) at = at - on_mean;
  }
}

/// Forces that the element exerts on its corners.
template <int N, int A, bool kRectangle, class V, class Law>
void shell_forces(const ElementGeometry<V>& g, const KernelMaterial& material, Law& law,
                  FibreViscosity<V, A>& viscosity, const Corners<V>& x, const Corners<V>& d,
                  Corners<V>& force, Corners<V>& moment) {
  const ElementMotion<V> m = element_motion<kRectangle>(g, x, d);
  const MotionProducts<V> products = motion_products(m);
  const auto give = [&](const Vec3<V>& n1, const Vec3<V>& n2, const Vec3<V>& on_hx, const Vec3<V>& m1,
                        const Vec3<V>& m2, const Vec3<V>& on_hd, const Vec3<V>& on_mean) {
    corner_forces<kRectangle>(g, n1, n2, on_hx, force);
    corner_moments<kRectangle>(g, m1, m2, on_hd, on_mean, moment);
  };
  element_pull<N, A, kRectangle>(g, material, law, viscosity, m, products, give);
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
