#include "fem/terms/contact.hpp"

#include <cmath>
#include <limits>

namespace drapeplan {
namespace {

namespace stdx = std::experimental;

constexpr double kSteepest2 = kSteepestContact * kSteepestContact;
constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

/// Nodes within this share of the half thickness above the surface get the second evaluation. The tangent
/// plane at the vertical foot errs by curvature (t tan(slope))^2 / 8 only (figures: tests/bench/fem.md).
constexpr double kNear = 0.1;

/// Sliding this many times faster than it approaches, a node that touches anew slides, whatever the
/// coefficient.
constexpr double kGrazing = 1e3;
constexpr double kHalfway = 0.5;  // of State::stuck, which is 0 or 1
constexpr double kTiny = 1e-300;  // keeps 0 / 0 away: a node at rest

Lanes zero_unless(const Lanes::mask_type& condition, Lanes value) {
  stdx::where(!condition, value) = Lanes(0.0);
  return value;
}

/// min(1, limit / pull), where pull may be zero.
Lanes share_held(const Lanes& limit, const Lanes& pull) {
  Lanes share(1.0);
  stdx::where(pull > limit, share) = limit / pull;
  return share;
}

/// Heights and slopes of a chunk of nodes at places of their own.
struct Feet {
  double x[kChunk], y[kChunk], z[kChunk], zx[kChunk], zy[kChunk];
};

/// What a chunk of nodes has of the mold.
struct Neighbourhood {
  bool near = false;     ///< a node may touch
  double clearance = 0;  ///< how far all may move without touching [m]; 0 if one may touch, or is beside it
};

template <bool kFriction, bool kTack = false>
class ContactTerm final : public Term {
 public:
  ContactTerm(const Mold& mold, double friction, ContactSprings springs, double surface, int look_ahead,
              ReleasedSprings released, NodalTack tack = {})
      : mold_(mold),
        friction_(friction),
        springs_(std::move(springs)),
        released_(std::move(released.springs)),
        surface_(surface),
        near_((1 + kNear) * surface),
        held_near_(near_),
        look_ahead_(look_ahead),
        count_(int(springs_.stiffness.size())),
        tack_(std::move(tack)) {
    springs_.stiffness.resize(padded(count_), 1.0);
    springs_.damping.resize(padded(count_), 0.0);
    pad_.assign(padded(count_), kNoPad);
    for (size_t g = 0; g < released.nodes.size(); ++g) {
      for (const int node : released.nodes[g]) pad_[size_t(node)] = int(g);
    }
    if constexpr (kTack) hold();
  }

  [[nodiscard]] std::string_view name() const override {
    return kTack ? "contact with friction and tack" : kFriction ? "contact with friction" : "contact";
  }

  [[nodiscard]] std::vector<Forces> entries() const override {
    const std::vector<double> clearance(size_t((count_ + kChunk - 1) / kChunk), 0.0);
    std::vector<Forces> list{{Book::contact, VectorField(count_), {}, clearance}};
    if constexpr (kFriction) list.push_back({Book::friction, VectorField(count_), {}, clearance});
    return list;
  }

  void add_stiffness(NodalStiffness& stiffness) const override {
    for (size_t n = 0; n < size_t(count_); ++n) add_node(springs_, n, stiffness);
  }

  /// Nodes that touch or are held, or would in `look_ahead` steps at twice their speed.
  void add_tangent(const State& state, NodalStiffness& stiffness) const override {
    double z[kChunk], zx[kChunk], zy[kChunk];
    for (int first = 0; first < count_; first += kChunk) {
      const int chunk = std::min(kChunk, int(padded(count_)) - first);
      mold_.heights(chunk, &state.position.x[size_t(first)], &state.position.y[size_t(first)], z, zx, zy);
      for (int k = 0; k < chunk && first + k < count_; ++k) {
        const auto n = size_t(first + k);
        const double speed = std::hypot(state.velocity.x[n], state.velocity.y[n], state.velocity.z[n]);
        const bool held = kTack && state.stuck[n] > kHalfway;
        const double reach = (held ? held_near_ : near_) + 2 * look_ahead_ * state.dt * speed;
        const double distance = (state.position.z[n] - z[k]) / std::sqrt(1 + zx[k] * zx[k] + zy[k] * zy[k]);
        if (distance < reach)  // false where the mold is not defined
          add_node(let_go(state, n) ? released_ : springs_, n, stiffness);
      }
    }
  }

  // Inlined as a whole: left to itself the compiler calls press() without friction for each few nodes, which
  // costs more than friction does.
  DRAPEPLAN_FLATTEN void forces(State& state, Forces* entries) const override {
    const bool follows = entries->step + 1 == state.step;
    entries->step = state.step;
    Feet feet;
    for (int first = 0; first < count_; first += kChunk) {
      const auto chunk = size_t(first / kChunk);
      if (follows && still_clear(state, size_t(first), entries->clearance[chunk])) continue;
      const int size = std::min(kChunk, int(padded(count_)) - first);
      const Neighbourhood mold = find_feet(state, size_t(first), size, feet);
      if (mold.near) mold_.heights(size, feet.x, feet.y, feet.z, feet.zx, feet.zy);
      for (int k = 0; k < size && first + k < count_; k += kLanes) {
        if (mold.near)
          press(state, entries, size_t(first + k), feet, size_t(k));
        else
          release(state, entries, size_t(first + k));
      }
      for (size_t e = 0; e < (kFriction ? 2 : 1); ++e) entries[e].clearance[chunk] = mold.clearance;
    }
  }

 private:
  /// Pads the nodes' forces; nodes as far off as the last bond breaks are near.
  void hold() {
    tack_.force.resize(padded(count_), 0.0);
    double last = tack_.reach;
    for (const ContactSprings* springs : {&springs_, &released_}) {
      for (size_t n = 0; n < size_t(count_) && n < springs->stiffness.size(); ++n)
        last = std::max(last, tack_.force[n] / springs->stiffness[n]);
    }
    held_near_ = (1 + kNear) * (surface_ + last);
  }

  static void add_node(const ContactSprings& springs, size_t n, NodalStiffness& stiffness) {
    stiffness.translation[n] += springs.stiffness[n];
    stiffness.damping[n] += springs.damping[n];
  }

  bool let_go(const State& state, size_t n) const {
    return pad_[n] != kNoPad && state.pads[size_t(pad_[n])].released;
  }

  /// Springs of the lanes at a node.
  void springs_at(const State& state, size_t at, Lanes& stiffness, Lanes& damping) const {
    stiffness = load(&springs_.stiffness[at]);
    damping = load(&springs_.damping[at]);
    if (!any_released(state)) return;
    for (size_t lane = 0; lane < size_t(kLanes); ++lane) {
      if (!let_go(state, at + lane)) continue;
      stiffness[lane] = released_.stiffness[at + lane];
      damping[lane] = released_.damping[at + lane];
    }
  }

  static bool any_released(const State& state) {
    for (const PadState& pad : state.pads) {
      if (pad.released) return true;
    }
    return false;
  }

  /// What is left of a chunk's clearance after the step that led here, at twice the speed of its fastest
  /// node.
  /// @return true if there is some.
  bool still_clear(const State& state, size_t first, double& clearance) const {
    if (!(clearance > 0)) return false;
    Lanes fastest2(0.0);
    for (size_t n = first; n < std::min(first + size_t(kChunk), size_t(count_)); n += size_t(kLanes)) {
      const Vec3<Lanes> v = state.velocity.lanes(n);
      fastest2 = stdx::max(fastest2, dot(v, v));
    }
    clearance -= 2 * state.dt_before * std::sqrt(stdx::hmax(fastest2));
    return clearance > 0;
  }

  /// Places where the normals of the tangent planes at the vertical feet come from: one step towards the
  /// closest points.
  Neighbourhood find_feet(const State& state, size_t first, int chunk, Feet& feet) const {
    mold_.heights(chunk, &state.position.x[first], &state.position.y[first], feet.z, feet.zx, feet.zy);
    Lanes lowest(std::numeric_limits<double>::infinity());
    Lanes::mask_type any(false);
    for (size_t k = 0; k < size_t(chunk); k += size_t(kLanes)) {
      const Vec3<Lanes> x = state.position.lanes(first + k);
      const Lanes zx = load(&feet.zx[k]), zy = load(&feet.zy[k]), above = x.z - load(&feet.z[k]);
      const Lanes slope2 = zx * zx + zy * zy, stretch2 = Lanes(1.0) + slope2;
      const Lanes reach(held_near_);  // false where the mold is not defined
      const auto near =
          (above < Lanes(0.0) || above * above < reach * reach * stretch2) && slope2 < Lanes(kSteepest2);
      any = any || near;
      Lanes clear = above - reach * stdx::sqrt(Lanes(1.0 + kSteepest2));
      stdx::where(near || !(clear > Lanes(0.0)), clear) = Lanes(0.0);
      lowest = stdx::min(lowest, clear);
      const Lanes along = above / stretch2;
      Lanes fx(kNowhere), fy(kNowhere);
      stdx::where(near, fx) = x.x + along * zx;
      stdx::where(near, fy) = x.y + along * zy;
      store(fx, &feet.x[k]);
      store(fy, &feet.y[k]);
    }
    // The gap shrinks by what a node moves down, and by the steepest slope times what it moves sideways.
    return {stdx::any_of(any), stdx::hmin(lowest) / (1 + std::sqrt(kSteepest2))};
  }

  void release(State& state, Forces* entries, size_t at) const {
    const Lanes zero(0.0);
    entries[0].force.set_lanes(at, {zero, zero, zero});
    if constexpr (kFriction) {
      entries[1].force.set_lanes(at, {zero, zero, zero});
      store(zero, &state.stuck[at]);
    }
  }

  void press(State& state, Forces* entries, size_t at, const Feet& feet, size_t k) const {
    const Lanes zero(0.0), one(1.0);
    const Vec3<Lanes> x = state.position.lanes(at),
                      foot{load(&feet.x[k]), load(&feet.y[k]), load(&feet.z[k])};
    const Lanes zx = load(&feet.zx[k]), zy = load(&feet.zy[k]);
    const Lanes rise = one / stdx::sqrt(one + zx * zx + zy * zy);
    Vec3<Lanes> normal{-(zx * rise), -(zy * rise), rise};
    Lanes gap = dot(x - foot, normal) - Lanes(surface_);
    Lanes stiffness, damping, held(zero);
    auto touching = gap < zero;  // false for NaN
    if constexpr (kTack) {
      springs_at(state, at, stiffness, damping);
      held = load(&tack_.force[at]);
      const auto bonded = load(&state.stuck[at]) > Lanes(kHalfway);
      touching = touching || (bonded && gap < stdx::max(Lanes(tack_.reach), held / stiffness));
    }
    if (stdx::none_of(touching)) return release(state, entries, at);
    gap = zero_unless(touching, gap);
    for (Lanes* part : {&normal.x, &normal.y, &normal.z}) *part = zero_unless(touching, *part);
    if constexpr (!kTack) springs_at(state, at, stiffness, damping);
    const Vec3<Lanes> v = state.velocity.lanes(at);
    const Lanes approach = -dot(v, normal);
    const Lanes push = stdx::max(damping * approach - stiffness * gap, kTack ? -held : zero);
    const Lanes pressure = zero_unless(touching, push);
    entries[0].force.set_lanes(at, pressure * normal);
    if constexpr (kFriction) {
      const Vec3<Lanes> slide = v + approach * normal, anchor = state.anchor.lanes(at);
      Vec3<Lanes> slip = x - anchor;
      slip = slip - dot(slip, normal) * normal;
      const auto fresh = load(&state.stuck[at]) < Lanes(kHalfway);
      const Lanes speed = stdx::sqrt(dot(slide, slide));
      const Lanes since = -gap / stdx::max(approach, speed * Lanes(1 / kGrazing) + Lanes(kTiny));
      stdx::where(fresh, slip.x) = since * slide.x;
      stdx::where(fresh, slip.y) = since * slide.y;
      stdx::where(fresh, slip.z) = since * slide.z;
      const Vec3<Lanes> pull = stiffness * slip + damping * slide;
      Lanes limit = Lanes(friction_) * pressure;
      if constexpr (kTack) limit = Lanes(friction_) * stdx::max(pressure, zero) + held;
      const Lanes share = share_held(limit, stdx::sqrt(dot(pull, pull)));
      const Lanes hold = zero_unless(touching, -share);
      entries[1].force.set_lanes(at, hold * pull);
      state.anchor.set_lanes(at, x - share * slip);
      store(zero_unless(touching, one), &state.stuck[at]);
    }
  }

  Mold mold_;
  double friction_;
  static constexpr int kNoPad = -1;
  ContactSprings springs_, released_;
  std::vector<int> pad_;  ///< that holds a node, or kNoPad
  double surface_;
  double near_, held_near_;  ///< from the mid-surface: a node may touch; one may be held [m]
  int look_ahead_;
  int count_;
  NodalTack tack_;  ///< padded; empty without tack
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

std::unique_ptr<Term> make_contact(const Mold& mold, std::optional<double> friction, ContactSprings springs,
                                   double surface, int look_ahead, ReleasedSprings released,
                                   std::optional<NodalTack> tack) {
  if (friction && tack)
    return std::make_unique<ContactTerm<true, true>>(mold, *friction, std::move(springs), surface, look_ahead,
                                                     std::move(released), std::move(*tack));
  if (friction)
    return std::make_unique<ContactTerm<true>>(mold, *friction, std::move(springs), surface, look_ahead,
                                               std::move(released));
  return std::make_unique<ContactTerm<false>>(mold, 0.0, std::move(springs), surface, look_ahead,
                                              std::move(released));
}

std::unique_ptr<Term> make_gravity(const std::vector<double>& mass, double acceleration) {
  return std::make_unique<GravityTerm>(mass, acceleration);
}

}  // namespace drapeplan
