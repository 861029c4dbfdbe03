#include "fem/run/throughput.hpp"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "fem/run/workspace.hpp"
#include "fem/shell/kernel.hpp"
#include "mapping/error.hpp"

namespace drapeplan {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A number that counts what is done with it.
struct Counted {
  Counted() = default;
  explicit Counted(double number) : value(number) {}
  double value = 0;
  static inline thread_local int operations = 0;

  static Counted done(double value, int count = 1) {
    operations += count;
    return Counted(value);
  }
  friend Counted operator+(Counted a, Counted b) { return done(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return done(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return done(a.value * b.value); }
  friend Counted operator-(Counted a) { return Counted(-a.value); }  // folded into what follows
  Counted& operator+=(Counted b) { return *this = *this + b; }
};

void root_and_inverse(Counted square, Counted& root, Counted& inverse) {
  constexpr int kSeries = 12;  // two products and five FMAs: see fem/core/lanes.hpp
  root = Counted::done(std::sqrt(square.value), kSeries);
  inverse = Counted(1 / root.value);
}

/// A law whose lookups cost what those of tables do: two for the place, two for the line.
struct CountedLaw {
  [[nodiscard]] static Counted line(Counted at) { return Counted::done(at.value, 4); }
  [[nodiscard]] static Counted fibre(Counted strain, size_t /*slot*/) { return line(strain); }
  [[nodiscard]] static Counted shear(Counted sine, size_t /*slot*/) { return line(sine); }
};

template <int N, int A>
int count_flops() {
  ElementGeometry<Counted> g;
  for (Counted* part : g.parts()) *part = Counted(1);
  KernelMaterial material;
  material.thickness = 1;
  FibreViscosity<Counted, A> viscosity;
  Corners<Counted> x, d, force, moment;
  for (size_t c = 0; c < 4; ++c) {
    x[c] = {Counted(c == 1 || c == 2), Counted(c > 1), Counted(0)};
    d[c] = {Counted(0), Counted(0), Counted(1)};
  }
  CountedLaw law;
  Counted::operations = 0;
  shell_forces<N, A, true>(g, material, law, viscosity, x, d, force, moment);
  return Counted::operations;
}

}  // namespace

int kernel_flops(int section_points, int fibre_points) {
  const bool two = fibre_points == 2;
  if (section_points == 1) return two ? count_flops<1, 2>() : count_flops<1, 1>();
  if (section_points == 3) return two ? count_flops<3, 2>() : count_flops<3, 1>();
  return two ? count_flops<5, 2>() : count_flops<5, 1>();
}

double step_bytes(const Model& model) {
  const Workspace work(model);
  double vectors = 0;  // read or written, per node
  for (const Forces& entry : work.entries) {
    vectors += entry.book == Book::gravity ? 1 : 3;  // cleared or set, and read by the kick
    if (!entry.moment.x.empty()) vectors += 3;
  }
  vectors += 2 + 4;                          // the ply: reads x and d; adds to forces and moments
  if (model.scene().mold) vectors += 2;      // contact reads x and v
  if (model.scene().friction) vectors += 2;  // and moves anchors
  vectors += 3 + 2 + 4.0 / 3;                // kick: v, w, d; v, w; four masses
  vectors += 4 + 3;                          // drift: x, v, d, w; x, d, w
  const double history = 2 * double(model.shell().history_count());  // read and written
  return sizeof(double) * (3 * vectors * model.node_count() + history) / model.scene().mesh.element_count();
}

namespace {

/// Allocated and not freed.
std::size_t heap_bytes() {
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

}  // namespace

Footprint measure_footprint(const Scene& scene) {
  Footprint bytes;
  for (int round = 0; round < 2; ++round) {
    const std::size_t before = heap_bytes();
    const Model model(scene);
    const std::size_t with_model = heap_bytes();
    const State state = model.flat_state(0);
    const std::size_t with_state = heap_bytes();
    const Workspace work(model);
    bytes = {with_model - before, with_state - with_model, heap_bytes() - with_state};
  }
  return bytes;
}

double fma_peak() {
  constexpr int kRuns = 9, kRounds = 400000;
  constexpr size_t kChains = 12;  // more than the latency of an FMA times the number of its pipes
  double best = 0;
  for (int run = 0; run < kRuns; ++run) {
    const volatile double below_one = 0.999999;  // not known to the compiler
    const Lanes factor(below_one), term(1 - below_one);
    std::array<Lanes, kChains> chain;
    for (size_t k = 0; k < kChains; ++k) chain[k] = Lanes(below_one + double(k));
    const auto start = std::chrono::steady_clock::now();
    for (int round = 0; round < kRounds; ++round) {
      unroll<kChains>([&](auto k) { chain[k] = chain[k] * factor + term; });
    }
    const double seconds = seconds_since(start);
    Lanes sum(0.0);
    for (const Lanes& value : chain) sum += value;
    if (std::experimental::reduce(sum) == 0) throw std::logic_error("fma_peak: the sum cannot be zero");
    best = std::max(best, 2.0 * kLanes * double(kChains) * kRounds / seconds);
  }
  return best;
}

double stream_rate(std::size_t bytes) {
  constexpr int kRuns = 9;
  constexpr double kLeast = 0.01;  // [s]
  const std::size_t count =
      std::max<std::size_t>(bytes / (2 * sizeof(double)), size_t(kLanes)) / size_t(kLanes) * size_t(kLanes);
  std::vector<double> from(count, 1), to(count, 0);
  double best = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    double moved = 0;
    while (seconds_since(start) < kLeast) {
      for (std::size_t k = 0; k < count; k += size_t(kLanes)) store(load(&from[k]) + load(&to[k]), &to[k]);
      moved += 3.0 * sizeof(double) * double(count);
    }
    best = std::max(best, moved / seconds_since(start));
  }
  return best;
}

Throughput measure_throughput(const Model& model, const ThroughputRequest& request) {
  const auto run = [&](RunRequest part) {
    part.schedule = request.schedule;
    part.duration = request.duration;
    RunResult result = simulate(model, part);
    if (result.summary.status == RunStatus::diverged) throw NotFinished(result.summary.message);
    return result;
  };
  const State from = run({.pause = request.start}).state;
  std::int64_t steps = request.steps;
  if (steps == 0) {  // a short run says how many fill a repeat
    constexpr std::int64_t kTrialSteps = 200;
    const RunSummary trial = run({.from = &from, .steps = kTrialSteps}).summary;
    const double per_step = trial.wall_seconds / double(trial.steps - from.step);
    steps = std::max(std::int64_t(request.seconds / per_step), kTrialSteps);
  }
  Throughput out;
  std::vector<double> rates;
  for (int k = 0; k < request.repeats; ++k) {
    const RunSummary summary = run({.from = &from, .steps = steps}).summary;
    rates.push_back(summary.element_updates_per_second);
    out.same_hash = out.same_hash && (k == 0 || summary.state_hash == out.state_hash);
    out.state_hash = summary.state_hash;
    out.steps = summary.steps - from.step;
  }
  std::sort(rates.begin(), rates.end());
  out.updates_per_second = rates[rates.size() / 2];
  out.spread = (rates.back() - rates.front()) / out.updates_per_second;
  return out;
}

}  // namespace drapeplan
