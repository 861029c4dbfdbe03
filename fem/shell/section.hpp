// What the section of an element does: stresses at its points, gathered to few coefficients.
#pragma once

#include <array>
#include <utility>

#include "fem/shell/element.hpp"

namespace drapeplan {

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

/// |f| - 1 and 1 / |f| for a given |f|^2, or, where lanes are single, for |f|^2 - 1
/// (fem/core/single_lanes.hpp).
template <class V>
void strain_and_inverse(const V& square, V& strain, V& inverse) {
  V length;
  root_and_inverse(square, length, inverse);
  strain = length - V(1.0);
}
template <class V>
V inverse_length(const V& square) {
  V length, inverse;
  root_and_inverse(square, length, inverse);
  return inverse;
}

/// The section of a block of elements at all its points. In stages, each for all places at once: chains of
/// roots and of lookups are long, and side by side they fill the pipes.
template <int N, int A, class V>
class Section {
 public:
  /// @param m  of the element now.
  Section(const ElementGeometry<V>& g, const KernelMaterial& material, const MotionProducts<V>& m)
      : thickness_(material.thickness),
        across_{V(AcrossRule<2>::place[0]) * g.across1, V(AcrossRule<2>::place[0]) * g.across2} {
    stretch(m);
    if constexpr (kAcross) stretch_across(m);
  }

  /// Stresses of all fibres and of the shear, by the law and by bulk viscosity.
  template <class Law>
  void look_up(Law& law, FibreViscosity<V, A>& viscosity) {
    unroll<kPoints>([&](auto k) {
      shear_[k] = law.shear(sine_[k], 3 * k + 2);
      if constexpr (!kAcross || k != kMiddle) {
        unroll<2>([&](auto fibre) {
          const size_t at = place_of(k, fibre);
          stress_[at] = law.fibre(strain_[at], 3 * k + fibre);
        });
      }
    });
    unroll<2>([&](auto fibre) {
      unroll<size_t(A)>([&](auto a) {
        const size_t at = middle_place(fibre, a);
        const V& e = strain_[at];
        V& before = viscosity.strain[2 * a + fibre];
        if constexpr (kAcross) stress_[at] = law.fibre(e, fibre_slot<N>(kMiddle, fibre, a));
        stress_[at] += viscosity.modulus[fibre] * (e - before);
        before = e;
      });
    });
  }

  [[nodiscard]] SectionForces<V> forces() const {
    const V zero(0.0);
    SectionForces<V> sum{{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}, zero, zero, zero};
    unroll<kPoints>([&](auto k) {
      const V w(SectionRule<N>::weight[k] * thickness_);
      const V &inverse1 = inverse_[2 * k], &inverse2 = inverse_[2 * k + 1];
      const V turning = w * shear_[k], turned = turning * sine_[k];
      V on1 = -(turned * inverse1 * inverse1), on2 = -(turned * inverse2 * inverse2);
      if constexpr (kAcross && k == kMiddle) {
        on1 += across(0, w, sum.uneven1, sum.across);
        on2 += across(1, w, sum.uneven2, sum.across);
      } else {
        on1 += w * stress_[place_of(k, 0)] * inverse1;
        on2 += w * stress_[place_of(k, 1)] * inverse2;
      }
      add(k, on1, sum.fibre1);
      add(k, on2, sum.fibre2);
      add(k, V(turning * inverse1 * inverse2), sum.both);
    });
    return sum;
  }

 private:
  static constexpr size_t kPoints = size_t(N), kMiddle = kPoints / 2;
  static constexpr bool kAcross = A == 2;
  /// Places where fibres are looked at: per section point one per fibre; at mid-thickness A across each,
  /// which come last if these are two.
  static constexpr size_t kPlaces = 2 * (kPoints - 1 + size_t(A));
  static constexpr size_t place_of(size_t k, size_t fibre) {
    return 2 * (kAcross && k > kMiddle ? k - 1 : k) + fibre;
  }
  static constexpr size_t middle_place(size_t fibre, size_t a) {
    return kAcross ? 2 * (kPoints - 1) + 2 * fibre + a : place_of(kMiddle, fibre);
  }

  /// At heights s: |a + s c|^2 (less 1 in single lanes) and the sine between both fibres.
  void stretch(const MotionProducts<V>& m) {
    std::array<V, 2 * kPoints> square;
    unroll<kPoints>([&](auto k) {
      const V s(SectionRule<N>::place[k] * thickness_);
      square[2 * k] = m.a11;
      square[2 * k + 1] = m.a22;
      sine_[k] = m.a12;
      if constexpr (k != kMiddle) {
        square[2 * k] += s * (V(2.0) * m.b11 + s * m.c11);
        square[2 * k + 1] += s * (V(2.0) * m.b22 + s * m.c22);
        sine_[k] += s * (m.b12 + m.b21 + s * m.c12);
      }
    });
    unroll<2 * kPoints>([&](auto k) {
      if constexpr (!kAcross || k / 2 != kMiddle) {
        strain_and_inverse(square[k], strain_[place_of(k / 2, k % 2)], inverse_[k]);
      } else {
        inverse_[k] = inverse_length(square[k]);
      }
    });
    unroll<kPoints>([&](auto k) { sine_[k] = sine_[k] * inverse_[2 * k] * inverse_[2 * k + 1]; });
  }

  /// At mid-thickness, at both places across: |a +- y hx|^2.
  void stretch_across(const MotionProducts<V>& m) {
    unroll<2>([&](auto fibre) {
      const V side = V(2.0) * across_[fibre] * (fibre == 0 ? m.a1h : m.a2h);
      const V middle = (fibre == 0 ? m.a11 : m.a22) + across_[fibre] * across_[fibre] * m.hh;
      strain_and_inverse(V(middle + side), strain_[middle_place(fibre, 0)], unit_[2 * fibre]);
      strain_and_inverse(V(middle - side), strain_[middle_place(fibre, 1)], unit_[2 * fibre + 1]);
    });
  }

  /// Force over length of both places across a fibre.
  V across(size_t fibre, const V& weight, V& uneven, V& on_hh) const {
    const V half = V(0.5) * weight;
    const V p = half * stress_[middle_place(fibre, 0)] * unit_[2 * fibre];
    const V q = half * stress_[middle_place(fibre, 1)] * unit_[2 * fibre + 1];
    const V total = p + q;
    uneven = across_[fibre] * (p - q);
    on_hh += across_[fibre] * across_[fibre] * total;
    return total;
  }

  template <class K>
  void add(K k, const V& value, std::array<V, 3>& powers) const {
    powers[0] += value;
    if constexpr (K::value != kMiddle) {
      const V s(SectionRule<N>::place[k] * thickness_), once = s * value;
      powers[1] += once;
      powers[2] += s * once;
    }
  }

  double thickness_;
  std::array<V, 2> across_;             ///< y of the places across, over h.x [1/m]
  std::array<V, 2 * kPoints> inverse_;  ///< 1 / length of fibre vectors, by section point and fibre
  std::array<V, kPoints> sine_, shear_;
  std::array<V, kPlaces> strain_, stress_;
  std::array<V, 4> unit_;  ///< 1 / length at the places across
};

}  // namespace drapeplan
