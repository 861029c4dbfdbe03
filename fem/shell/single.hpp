// The shell term in single precision: forces of two neighbouring blocks at once, in lanes of floats.
//
// Only what cannot cancel is rounded to float. Derivatives are formed from corners in double, and so are
// a_1.a_1 - 1, a_2.a_2 - 1 and a_1.a_2 before they are rounded: strains and sines have 24 bits of their own
// size, far from the origin and after any rotation. Sums of forces over corners and nodes are double, so they
// vanish as they do there.
#pragma once

#include <type_traits>

#include "fem/law/single_lookup.hpp"
#include "fem/shell/term.hpp"

namespace drapeplan {

DRAPEPLAN_INLINE inline void round_to(const Vec3<Lanes>& from, Vec3<HalfLanes>& to) {
  to.x = HalfLanes(from.x);
  to.y = HalfLanes(from.y);
  to.z = HalfLanes(from.z);
}
DRAPEPLAN_INLINE inline void join(const Vec3<HalfLanes>& low, const Vec3<HalfLanes>& high,
                                  Vec3<SingleLanes>& out) {
  out.x = joined(low.x, high.x);
  out.y = joined(low.y, high.y);
  out.z = joined(low.z, high.z);
}

/// What single lanes need of a block's corners.
struct RoundedBlock {
  template <bool kRectangle>
  DRAPEPLAN_INLINE void look(const ElementGeometry<Lanes>& g, const Corners<Lanes>& x,
                             const Corners<Lanes>& d) {
    Vec3<Lanes> b1, b2, h;
    position_motion<kRectangle>(g, x, b1, b2, h);
    round_to(b1, a1);
    round_to(b2, a2);
    round_to(h, hx);
    excess1 = HalfLanes(dot(b1, b1) - Lanes(1.0));
    excess2 = HalfLanes(dot(b2, b2) - Lanes(1.0));
    a12 = HalfLanes(dot(b1, b2));
    const DirectorPairs<Lanes> pairs(d);
    round_to(pairs.p, p);
    round_to(pairs.q, q);
    round_to(pairs.even, even);
    round_to(pairs.odd, odd);
  }
  Vec3<HalfLanes> a1, a2, hx, p, q, even, odd;
  HalfLanes excess1, excess2, a12;  ///< a_1.a_1 - 1, a_2.a_2 - 1, a_1.a_2
};

template <size_t kHalf>
DRAPEPLAN_INLINE inline Vec3<Lanes> half(const Vec3<SingleLanes>& both) {
  return {half<kHalf>(both.x), half<kHalf>(both.y), half<kHalf>(both.z)};
}

template <int N, int A, bool kRates>
class SingleShellTerm final : public ShellTerm<N, A, kRates> {
  using Base = ShellTerm<N, A, kRates>;

 public:
  SingleShellTerm(const Mesh& mesh, const Fabric& fabric, const FemOptions& options)
      : Base(mesh, fabric, options), curves_(curves_of()) {
    for (size_t b = 0; b < this->blocks_.size(); b += 2)
      add_pair({b, std::min(b + 1, this->blocks_.size() - 1)});
  }

  DRAPEPLAN_FLATTEN void forces(State& state, Forces* entries) const override {
    entries->force.fill(0);
    entries->moment.fill(0);
    const Rows<const double> x(state.position), d(state.director);
    const Rows<double> force(entries->force), moment(entries->moment);
    const double per_step2 = 1 / (state.stable_dt * state.stable_dt);  // see ShellTerm
    const double viscous = 4 * this->viscous_mass_ * per_step2,
                 carried = 4 * this->viscous_fibre_inertia_ * per_step2;
    const double follow = kRates ? -std::expm1(-state.dt * this->lag_rate_) : 0;
    for (const Pair& pair : pairs_) {
      const ElementGeometry<SingleLanes>& g = joint_geometries_[pair.geometry];
      const std::array<const Block*, 2> block{&this->blocks_[pair.block[0]], &this->blocks_[pair.block[1]]};
      auto&& law = law_of(state, pair, follow);
      const SingleLanes added =
          joined(Lanes(block[0]->rectangle ? carried : 0.0), Lanes(block[1]->rectangle ? carried : 0.0));
      FibreViscosity<SingleLanes, A> viscosity{{SingleLanes(viscous) * g.half1 * g.half1 + added,
                                                SingleLanes(viscous) * g.half2 * g.half2 + added},
                                               {}};
      load_strains(state, pair, viscosity);
      if (pair.rectangle) {
        pair_forces<true>(g, block, x, d, law, viscosity, force, moment);
      } else {
        pair_forces<false>(g, block, x, d, law, viscosity, force, moment);
      }
      store_strains(viscosity, pair, state);
    }
  }

 private:
  /// Neighbouring blocks; a last one without a neighbour is there twice.
  struct Pair {
    std::array<size_t, 2> block;
    bool rectangle = false;
    size_t geometry = 0;  ///< among the different ones
  };
  using Curves = std::conditional_t<kRates, SingleRateTables, SingleStaticLaw>;

  Curves curves_of() const {
    if constexpr (kRates) {
      return Curves(this->tables_);
    } else {
      return Curves(this->material_);
    }
  }

  void add_pair(const std::array<size_t, 2>& block) {
    const Block &low = this->blocks_[block[0]], &high = this->blocks_[block[1]];
    const std::array<size_t, 2> parts{low.geometry, high.geometry};
    const auto known = std::find(parts_.begin(), parts_.end(), parts);
    pairs_.push_back({block, low.rectangle && high.rectangle, size_t(known - parts_.begin())});
    if (known != parts_.end()) return;
    parts_.push_back(parts);
    ElementGeometry<Lanes> first = this->geometries_[parts[0]], last = this->geometries_[parts[1]];
    ElementGeometry<SingleLanes> both;
    for (size_t k = 0; k < both.parts().size(); ++k)
      *both.parts()[k] = joined(*first.parts()[k], *last.parts()[k]);
    joint_geometries_.push_back(both);
  }

  template <bool kRectangle, class Law>
  void pair_forces(const ElementGeometry<SingleLanes>& g, const std::array<const Block*, 2>& block,
                   const Rows<const double>& x, const Rows<const double>& d, Law& law,
                   FibreViscosity<SingleLanes, A>& viscosity, const Rows<double>& force,
                   const Rows<double>& moment) const {
    const ElementGeometry<Lanes>&g0 = this->geometries_[block[0]->geometry],
          &g1 = this->geometries_[block[1]->geometry];
    RoundedBlock low, high;
    low.look<kRectangle>(g0, x.corners(*block[0]), d.corners(*block[0]));
    high.look<kRectangle>(g1, x.corners(*block[1]), d.corners(*block[1]));
    ElementMotion<SingleLanes> motion;
    join(low.a1, high.a1, motion.a1);
    join(low.a2, high.a2, motion.a2);
    join(low.hx, high.hx, motion.hx);
    DirectorPairs<SingleLanes> pairs;
    join(low.p, high.p, pairs.p);
    join(low.q, high.q, pairs.q);
    join(low.even, high.even, pairs.even);
    join(low.odd, high.odd, pairs.odd);
    director_motion<kRectangle>(g, pairs, motion.c1, motion.c2, motion.mean, motion.hd);
    MotionProducts<SingleLanes> products = motion_products(motion);
    products.a11 = joined(low.excess1, high.excess1);
    products.a22 = joined(low.excess2, high.excess2);
    products.a12 = joined(low.a12, high.a12);
    using Single3 = Vec3<SingleLanes>;
    const auto give = [&](const Single3& n1, const Single3& n2, const Single3& on_hx, const Single3& m1,
                          const Single3& m2, const Single3& on_hd, const Single3& on_mean) {
      Corners<SingleLanes> turning;
      corner_moments<kRectangle>(g, m1, m2, on_hd, on_mean, turning);
      Corners<Lanes> f, m;
      corner_forces<kRectangle>(g0, half<0>(n1), half<0>(n2), half<0>(on_hx), f);
      for (size_t c = 0; c < 4; ++c) m[c] = half<0>(turning[c]);
      this->add_forces(*block[0], f, m, force, moment);
      if (block[1] == block[0]) return;
      corner_forces<kRectangle>(g1, half<1>(n1), half<1>(n2), half<1>(on_hx), f);
      for (size_t c = 0; c < 4; ++c) m[c] = half<1>(turning[c]);
      this->add_forces(*block[1], f, m, force, moment);
    };
    element_pull<N, A, kRectangle>(g, this->material_, law, viscosity, motion, products, give);
  }

  decltype(auto) law_of([[maybe_unused]] State& state, [[maybe_unused]] const Pair& pair,
                        [[maybe_unused]] double follow) const {
    if constexpr (kRates) {
      double* lagged = &state.history[Base::kStrainSlots * this->slot_stride()];
      return SingleRateLaw(curves_,
                           {lagged + pair.block[0] * size_t(kLanes), lagged + pair.block[1] * size_t(kLanes)},
                           this->slot_stride(), follow);
    } else {
      return (curves_);
    }
  }

  void load_strains(const State& state, const Pair& pair, FibreViscosity<SingleLanes, A>& viscosity) const {
    const double* at = state.history.data();
    for (SingleLanes& strain : viscosity.strain) {
      strain = joined(load(at + pair.block[0] * size_t(kLanes)), load(at + pair.block[1] * size_t(kLanes)));
      at += this->slot_stride();
    }
  }
  void store_strains(const FibreViscosity<SingleLanes, A>& viscosity, const Pair& pair, State& state) const {
    double* at = state.history.data();
    for (const SingleLanes& strain : viscosity.strain) {
      store(half<0>(strain), at + pair.block[0] * size_t(kLanes));
      store(half<1>(strain), at + pair.block[1] * size_t(kLanes));
      at += this->slot_stride();
    }
  }

  Curves curves_;
  std::vector<Pair> pairs_;
  std::vector<std::array<size_t, 2>> parts_;  ///< geometries of blocks that pairs are made of
  std::vector<ElementGeometry<SingleLanes>> joint_geometries_;
};

/// Like make_shell_of.
template <int N>
std::unique_ptr<Shell> make_single_shell_of(const Mesh& mesh, const Fabric& fabric,
                                            const FemOptions& options) {
  const auto with_rates = [&]<int A>(std::integral_constant<int, A>) -> std::unique_ptr<Shell> {
    if (options.rates && fabric.rate_dependent())
      return std::make_unique<SingleShellTerm<N, A, true>>(mesh, fabric, options);
    return std::make_unique<SingleShellTerm<N, A, false>>(mesh, fabric, options);
  };
  return options.fibre_points == 1 ? with_rates(std::integral_constant<int, 1>())
                                   : with_rates(std::integral_constant<int, 2>());
}

extern template std::unique_ptr<Shell> make_single_shell_of<1>(const Mesh&, const Fabric&, const FemOptions&);
extern template std::unique_ptr<Shell> make_single_shell_of<3>(const Mesh&, const Fabric&, const FemOptions&);
extern template std::unique_ptr<Shell> make_single_shell_of<5>(const Mesh&, const Fabric&, const FemOptions&);

}  // namespace drapeplan
