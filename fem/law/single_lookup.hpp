// Curves and tables by rate on lanes of floats; what they hold is rounded from those of doubles.
#pragma once

#include "fem/core/single_lanes.hpp"
#include "fem/law/material.hpp"
#include "fem/law/rates.hpp"

namespace drapeplan {

/// See Lookup.
class SingleLookup {
 public:
  explicit SingleLookup(const Lookup& curve)
      : lower_(curve.lower()),
        per_step_(curve.per_step()),
        last_(double(curve.lines().size() / 2 - 1)),
        line_(single_pairs(curve.lines())) {}

  DRAPEPLAN_INLINE [[nodiscard]] SingleLanes operator()(const SingleLanes& at) const {
    namespace stdx = std::experimental;
    const SingleLanes place((at - SingleLanes(lower_)) * SingleLanes(per_step_));
    SingleLanes intercept, slope;
    load_pairs(line_.data(),
               SingleLanes(stdx::clamp(place.value, SingleLanes::Simd(0.0F), SingleLanes(last_).value)),
               intercept, slope);
    return intercept + slope * at;
  }

 private:
  double lower_, per_step_, last_;
  std::vector<double> line_;  ///< see single_pairs
};

/// See octaves().
DRAPEPLAN_INLINE inline SingleLanes octaves(const SingleLanes& x) {
  constexpr int kBitsOfOne = std::bit_cast<int>(1.0F);
  constexpr double kPerOctave = 1 << 23;
#if defined(__AVX512F__)
  const __m512i above =
      _mm512_sub_epi32(_mm512_castps_si512(static_cast<__m512>(x.value)), _mm512_set1_epi32(kBitsOfOne));
  const SingleLanes bits(SingleLanes::Simd(_mm512_cvtepi32_ps(above)));
#else
  const auto above = [&x](auto l) {
    return float(std::bit_cast<int>(float(x.value[size_t(l)])) - kBitsOfOne);
  };
  const SingleLanes bits{SingleLanes::Simd(above)};
#endif
  return bits * SingleLanes(1 / kPerOctave);
}

/// See RateLookup.
class SingleRateLookup {
 public:
  explicit SingleRateLookup(const RateLookup& table)
      : lower_(table.lower_),
        per_step_(table.per_step_),
        last_(table.last_),
        per_rate_step_(table.per_rate_step_),
        rows_(table.rows_),
        pieces_(table.pieces_),
        line_(single_pairs(table.line_)) {}

  DRAPEPLAN_INLINE [[nodiscard]] SingleLanes operator()(const SingleLanes& strain,
                                                        const SingleLanes& growth) const {
    namespace stdx = std::experimental;
    using Simd = SingleLanes::Simd;
    const SingleLanes place = (strain - SingleLanes(lower_)) * SingleLanes(per_step_);
    const Simd piece = stdx::floor(stdx::clamp(place.value, Simd(0.0F), SingleLanes(last_).value));
    const SingleLanes octave = octaves(SingleLanes(1.0) + growth) * SingleLanes(per_rate_step_);
    const Simd y = stdx::min(octave.value, SingleLanes(rows_).value);
    const Simd row = stdx::min(stdx::floor(y), SingleLanes(rows_ - 1).value);
    // Rows times pieces is far below 2^24, up to where floats count.
    const SingleLanes index(Simd(row * SingleLanes(double(pieces_)).value + piece)), share(Simd(y - row));
    SingleLanes slow0, slow1, fast0, fast1;
    load_pairs(line_.data(), index, slow0, slow1);
    load_pairs(line_.data() + pieces_, index, fast0, fast1);
    return slow0 + slow1 * strain + share * ((fast0 - slow0) + (fast1 - slow1) * strain);
  }

 private:
  double lower_, per_step_, last_, per_rate_step_, rows_;
  size_t pieces_;
  std::vector<double> line_;  ///< see single_pairs
};

/// Laws of a pair of blocks, see StaticLaw.
class SingleStaticLaw {
 public:
  explicit SingleStaticLaw(const KernelMaterial& material) : fibre_(material.fibre), shear_(material.shear) {}
  DRAPEPLAN_INLINE [[nodiscard]] SingleLanes fibre(const SingleLanes& strain, size_t /*slot*/) const {
    return fibre_(strain);
  }
  DRAPEPLAN_INLINE [[nodiscard]] SingleLanes shear(const SingleLanes& sine, size_t /*slot*/) const {
    return shear_(sine);
  }

 private:
  SingleLookup fibre_, shear_;
};

/// See RateTables.
struct SingleRateTables {
  explicit SingleRateTables(const RateTables& tables)
      : fibre(tables.fibre), shear(tables.shear), gain(tables.gain) {}
  SingleRateLookup fibre, shear;
  double gain;
};

/// See RateLaw. Lagged strains stay double, and so does what strains are ahead of them: they follow by so
/// small a share of it per step that floats would stand still.
class SingleRateLaw {
 public:
  /// @param lagged  of the first elements of both blocks, slots `stride` apart; a block may be there twice.
  SingleRateLaw(const SingleRateTables& tables, std::array<double*, 2> lagged, size_t stride, double follow)
      : tables_(tables), lagged_(lagged), stride_(stride), follow_(follow) {}

  DRAPEPLAN_INLINE [[nodiscard]] SingleLanes fibre(const SingleLanes& strain, size_t slot) {
    return tables_.fibre(strain, growth(strain, slot, SingleLanes(tables_.gain)));
  }
  DRAPEPLAN_INLINE [[nodiscard]] SingleLanes shear(const SingleLanes& sine, size_t slot) {
    constexpr double kLeastCosine2 = 0.04;  // as in RateSlopes
    const SingleLanes cosine2 = SingleLanes(1.0) - sine * sine;
    const SingleLanes least(kLeastCosine2);
    const SingleLanes inverse = inverse_root(SingleLanes(std::experimental::max(cosine2.value, least.value)));
    return tables_.shear(sine, growth(sine, slot, SingleLanes(tables_.gain) * inverse));
  }

 private:
  /// Rate at which the strain's magnitude grows, over the floor. Moves the lagged strain on by one step.
  DRAPEPLAN_INLINE SingleLanes growth(const SingleLanes& strain, size_t slot, const SingleLanes& gain) {
    namespace stdx = std::experimental;
    double* const low = lagged_[0] + slot * stride_;
    double* const high = lagged_[1] + slot * stride_;
    const Lanes old_low = load(low), old_high = load(high);
    const Lanes ahead_low = half<0>(strain) - old_low, ahead_high = half<1>(strain) - old_high;
    store(old_low + Lanes(follow_) * ahead_low, low);
    store(old_high + Lanes(follow_) * ahead_high, high);
    SingleLanes grown = joined(ahead_low, ahead_high) * gain;
    stdx::where(strain.value < 0.0F, grown.value) = -grown.value;
    return SingleLanes(stdx::max(SingleLanes::Simd(0.0F), grown.value));
  }

  const SingleRateTables& tables_;
  std::array<double*, 2> lagged_;
  size_t stride_;
  double follow_;
};

}  // namespace drapeplan
