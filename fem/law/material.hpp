// The fabric as the element kernel needs it.
#pragma once

#include "fem/law/lookup.hpp"

namespace drapeplan {

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

}  // namespace drapeplan
