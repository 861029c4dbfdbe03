// How fast strains change, and the stress that depends on it.
//
// Material rates are per second, steps are microseconds: the change of strain over one step is mostly noise.
// So each strain e has a lagged one that follows it, tau de_l/dt = e - e_l, and the rate is (e - e_l) / tau:
// an exponential average over the filter's time constant tau. A steady rate is met exactly.
//
// Only a strain whose magnitude grows is resisted more the faster it grows; one that shrinks follows the
// slowest curve. (Resisting by |rate| both ways would drive a shrinking strain: a negative viscosity.)
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "fem/core/lanes.hpp"

namespace drapeplan {

/// How many octaves a normal number >= 1 is above 1, linear within each: what its bits say, read as an
/// integer. A logarithm without its series, good for places in a table whose rows are spaced likewise.
DRAPEPLAN_INLINE inline Lanes octaves(const Lanes& x) {
  constexpr double kPerOctave = double(std::int64_t(1) << 52), kBias = 1023;
#if defined(__AVX512DQ__)
  const Lanes bits(_mm512_cvtepi64_pd(_mm512_castpd_si512(static_cast<__m512d>(x))));
#else
  const Lanes bits([&](auto l) { return double(std::bit_cast<std::int64_t>(double(x[size_t(l)]))); });
#endif
  return bits * Lanes(1 / kPerOctave) - Lanes(kBias);
}
/// The number that is so many octaves above 1.
inline double from_octaves(double y) {
  const double whole = std::floor(y);
  return std::ldexp(1 + y - whole, int(whole));
}

/// A curve per rate, resampled on equal intervals of strain and of y = octaves(1 + rate / floor), bilinear
/// between; constant beyond the slowest and the fastest curve, last slope beyond the last strain.
class RateLookup {
 public:
  RateLookup() = default;

  /// @param f  stress over strain [-] and rate [1/s];  @param intervals  of strain, over [lower, upper];
  /// @param floor, fastest  [1/s], above 0.
  RateLookup(const std::function<double(double, double)>& f, double lower, double upper, int intervals,
             double floor, double fastest);

  /// @param growth  rate over `floor`, not below 0.
  DRAPEPLAN_INLINE [[nodiscard]] Lanes operator()(const Lanes& strain, const Lanes& growth) const {
    const Place at = place(strain, growth);
    Lanes slow0, slow1, fast0, fast1;
    gather(at, slow0, slow1, fast0, fast1);
    return slow0 + slow1 * strain + at.share * ((fast0 - slow0) + (fast1 - slow1) * strain);
  }
  /// Steepest slope near a strain (see Lookup) while the lagged strain stays: d/de of the above with
  /// d growth / d strain = `gain`.
  [[nodiscard]] Lanes slope(const Lanes& strain, const Lanes& growth, const Lanes& gain) const {
    const Place at = place(strain, growth);
    Lanes slow0, slow1, fast0, fast1;
    gather(at, slow0, slow1, fast0, fast1);
    const Lanes by_rate = (fast0 - slow0) + (fast1 - slow1) * strain;  // per interval of y
    const Lanes slow = load_entries(steepest_.data(), at.index);
    const Lanes fast = load_entries(steepest_.data() + pieces_, at.index);
    return slow + at.share * (fast - slow) +
           std::experimental::abs(by_rate) * Lanes(per_rate_step_) * octave_slope(Lanes(1.0) + growth) * gain;
  }
  /// Largest of these slopes, over all strains of the table and all rates.
  [[nodiscard]] double largest_slope(double gain) const;

 private:
  friend class SingleRateLookup;  // the same on lanes of floats

  /// Derivative of octaves().
  [[nodiscard]] static Lanes octave_slope(const Lanes& x) {
    const Lanes y = octaves(x);
    return (Lanes(1.0) + y - std::experimental::floor(y)) / x;
  }
  struct Place {
    Lanes share;  ///< between the slower and the faster row
    Lanes index;  ///< of the slower row's piece
  };
  DRAPEPLAN_INLINE [[nodiscard]] Place place(const Lanes& strain, const Lanes& growth) const {
    namespace stdx = std::experimental;
    const Lanes piece = stdx::clamp((strain - Lanes(lower_)) * Lanes(per_step_), Lanes(0.0), Lanes(last_));
    const Lanes y = stdx::min(octaves(Lanes(1.0) + growth) * Lanes(per_rate_step_), Lanes(rows_));
    const Lanes row = stdx::min(stdx::floor(y), Lanes(rows_ - 1));
    return {y - row, row * Lanes(double(pieces_)) + stdx::floor(piece)};
  }
  DRAPEPLAN_INLINE void gather(const Place& at, Lanes& slow0, Lanes& slow1, Lanes& fast0,
                               Lanes& fast1) const {
    load_pairs(line_.data(), at.index, slow0, slow1);
    load_pairs(line_.data() + 2 * pieces_, at.index, fast0, fast1);
  }

  double lower_ = 0, per_step_ = 1, last_ = 0, per_rate_step_ = 1, rows_ = 1;
  size_t pieces_ = 0;
  std::vector<double> line_;      ///< by rate, by piece: intercept and slope
  std::vector<double> steepest_;  ///< by rate, by piece: slope near it
};

/// Both tables of a fabric.
struct RateTables {
  RateLookup fibre, shear;  ///< as in KernelMaterial
  double gain = 0;          ///< 1 / (filter time * floor): growth per unit of strain ahead of its lagged one
};

/// Slopes of a block of elements whose law depends on rates, while lagged strains stay.
class RateSlopes {
 public:
  /// @param lagged  of the block's first element, slots `stride` apart.
  RateSlopes(const RateTables& tables, const double* lagged, size_t stride)
      : tables_(tables), stride_(stride), seen_(lagged) {}

  [[nodiscard]] Lanes fibre_slope(const Lanes& strain, size_t slot) const {
    const Lanes gain(tables_.gain);
    return tables_.fibre.slope(strain, growth(strain, slot, gain), gain);
  }
  [[nodiscard]] Lanes shear_slope(const Lanes& sine, size_t slot) const {
    const Lanes gain = shear_gain(sine);
    return tables_.shear.slope(sine, growth(sine, slot, gain), gain);
  }

 protected:
  /// Rate at which the strain's magnitude grows, over the floor.
  DRAPEPLAN_INLINE [[nodiscard]] Lanes growth(const Lanes& strain, size_t slot, const Lanes& gain) const {
    namespace stdx = std::experimental;
    const Lanes ahead = (strain - load(seen_ + slot * stride_)) * gain;
    Lanes grown = ahead;
    stdx::where(strain < Lanes(0.0), grown) = -ahead;
    return stdx::max(Lanes(0.0), grown);
  }
  /// The rate of the angle is that of its sine over its cosine.
  DRAPEPLAN_INLINE [[nodiscard]] Lanes shear_gain(const Lanes& sine) const {
    namespace stdx = std::experimental;
    constexpr double kLeastCosine2 = 0.04;  // about where the table of the shear stress ends
    Lanes cosine, inverse;
    root_and_inverse(stdx::max(Lanes(1.0) - sine * sine, Lanes(kLeastCosine2)), cosine, inverse);
    return Lanes(tables_.gain) * inverse;
  }

  const RateTables& tables_;
  size_t stride_;

 private:
  const double* seen_;
};

/// Stresses of such a block. Moves each lagged strain on by one step after its use.
class RateLaw : public RateSlopes {
 public:
  /// @param follow  share of the difference by which lagged strains follow in this step.
  RateLaw(const RateTables& tables, double* lagged, size_t stride, double follow)
      : RateSlopes(tables, lagged, stride), lagged_(lagged), follow_(follow) {}

  DRAPEPLAN_INLINE [[nodiscard]] Lanes fibre(const Lanes& strain, size_t slot) {
    const Lanes stress = tables_.fibre(strain, growth(strain, slot, Lanes(tables_.gain)));
    move_on(strain, slot);
    return stress;
  }
  DRAPEPLAN_INLINE [[nodiscard]] Lanes shear(const Lanes& sine, size_t slot) {
    const Lanes stress = tables_.shear(sine, growth(sine, slot, shear_gain(sine)));
    move_on(sine, slot);
    return stress;
  }

 private:
  DRAPEPLAN_INLINE void move_on(const Lanes& strain, size_t slot) {
    double* at = lagged_ + slot * stride_;
    const Lanes old = load(at);
    store(old + Lanes(follow_) * (strain - old), at);
  }

  double* lagged_;
  double follow_;
};

}  // namespace drapeplan
