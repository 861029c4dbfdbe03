#include "fem/contact.hpp"

#include <cmath>

namespace drapeplan {
namespace {

namespace stdx = std::experimental;

/// Square of the steepest slope that can be touched (84 degrees): at a vertical wall a height field has no
/// distance.
constexpr double kSteepest2 = 100;

/// Masked minimum of one, where the divisor may be zero.
Lanes share_held(const Lanes& limit, const Lanes& pull) {
  Lanes share(1.0);
  stdx::where(pull > limit, share) = limit / pull;
  return share;
}

template <bool kFriction>
class ContactTerm final : public Term {
 public:
  ContactTerm(const Mold& mold, double friction, std::vector<double> stiffness, double surface)
      : mold_(mold),
        friction_(friction),
        stiffness_(std::move(stiffness)),
        surface_(surface),
        count_(int(stiffness_.size())) {
    stiffness_.resize(padded(count_), 1.0);
  }

  [[nodiscard]] std::string_view name() const override {
    return kFriction ? "contact with friction" : "contact";
  }

  [[nodiscard]] std::vector<Forces> entries() const override {
    std::vector<Forces> list{{Book::contact, VectorField(count_), {}}};
    if constexpr (kFriction) list.push_back({Book::friction, VectorField(count_), {}});
    return list;
  }

  void add_stiffness(NodalStiffness& stiffness) const override {
    for (size_t n = 0; n < size_t(count_); ++n) stiffness.translation[n] += stiffness_[n];
  }

  void forces(State& state, Forces* entries) const override {
    constexpr int kChunk = 8 * kLanes;  // heights of a chunk stay in the innermost cache
    double z[kChunk], zx[kChunk], zy[kChunk];
    for (int first = 0; first < count_; first += kChunk) {
      const int chunk = std::min(kChunk, int(padded(count_)) - first);
      mold_.heights(chunk, &state.x.x[size_t(first)], &state.x.y[size_t(first)], z, zx, zy);
      for (int k = 0; k < chunk && first + k < count_; k += kLanes) {
        lanes(state, entries, size_t(first + k), load(z + k), load(zx + k), load(zy + k));
      }
    }
  }

 private:
  void lanes(State& state, Forces* entries, size_t at, const Lanes& z, const Lanes& zx,
             const Lanes& zy) const {
    const Lanes zero(0.0), one(1.0);
    const Vec3<Lanes> x = state.x.lanes(at);
    const Lanes slope2 = zx * zx + zy * zy;
    const Lanes rise = one / stdx::sqrt(one + slope2);
    const Lanes gap = (x.z - z) * rise - Lanes(surface_);
    const auto touching = gap < zero && slope2 < Lanes(kSteepest2);  // false where the mold is not defined
    if (stdx::none_of(touching)) {
      entries[0].force.set_lanes(at, {zero, zero, zero});
      if constexpr (kFriction) {
        entries[1].force.set_lanes(at, {zero, zero, zero});
        store(zero, &state.stuck[at]);
      }
      return;
    }
    const Lanes stiffness = load(&stiffness_[at]);
    Vec3<Lanes> normal{-(zx * rise), -(zy * rise), rise};
    for (Lanes* part : {&normal.x, &normal.y, &normal.z}) stdx::where(!touching, *part) = zero;  // may be NaN
    Lanes press = -(stiffness * gap);
    stdx::where(!touching, press) = zero;
    entries[0].force.set_lanes(at, press * normal);
    if constexpr (kFriction) {
      const auto fresh = load(&state.stuck[at]) < Lanes(0.5);
      Vec3<Lanes> anchor = state.anchor.lanes(at);
      stdx::where(fresh, anchor.x) = x.x;
      stdx::where(fresh, anchor.y) = x.y;
      stdx::where(fresh, anchor.z) = x.z;
      Vec3<Lanes> slip = x - anchor;
      slip = slip - dot(slip, normal) * normal;
      const Lanes share = share_held(Lanes(friction_) * press, stiffness * stdx::sqrt(dot(slip, slip)));
      const Vec3<Lanes> held = share * slip;
      Lanes pull = -stiffness;
      stdx::where(!touching, pull) = zero;
      entries[1].force.set_lanes(at, pull * held);
      state.anchor.set_lanes(at, x - held);
      Lanes stuck = one;
      stdx::where(!touching, stuck) = zero;
      store(stuck, &state.stuck[at]);
    }
  }

  Mold mold_;
  double friction_;
  std::vector<double> stiffness_;
  double surface_;
  int count_;
};

class GravityTerm final : public Term {
 public:
  GravityTerm(const std::vector<double>& mass, double acceleration) : weight_(int(mass.size())) {
    for (size_t n = 0; n < mass.size(); ++n) weight_.z[n] = -mass[n] * acceleration;
  }
  [[nodiscard]] std::string_view name() const override { return "gravity"; }
  [[nodiscard]] std::vector<Forces> entries() const override { return {{Book::gravity, weight_, {}}}; }
  void add_stiffness(NodalStiffness& /*stiffness*/) const override {}
  void forces(State& /*state*/, Forces* /*entries*/) const override {}  // constant: written once by entries()

 private:
  VectorField weight_;
};

}  // namespace

std::unique_ptr<Term> make_contact(const Mold& mold, std::optional<double> friction,
                                   std::vector<double> stiffness, double surface) {
  if (friction) return std::make_unique<ContactTerm<true>>(mold, *friction, std::move(stiffness), surface);
  return std::make_unique<ContactTerm<false>>(mold, 0.0, std::move(stiffness), surface);
}

std::unique_ptr<Term> make_gravity(const std::vector<double>& mass, double acceleration) {
  return std::make_unique<GravityTerm>(mass, acceleration);
}

}  // namespace drapeplan
