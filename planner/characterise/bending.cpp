#include "planner/characterise/bending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fem/mesh/foot.hpp"
#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/characterise/beam.hpp"
#include "planner/drape/problem.hpp"
#include "planner/measured/strip_shape.hpp"

namespace drapeplan {
namespace {

constexpr int kStrips = 12;
constexpr double kSmallestScale = 0.02, kLargestScale = 10;
constexpr double kFirstTime = 0.4;   // [s], of the first curve
constexpr double kAtRest = 1e-15;    // [1/s], rate of the last one
constexpr int kCurves = 6;

/// The drop at rest of a strip with a compression curve, simulated without rates.
double simulated_drop(Fabric fabric, const Curve& compression, double length, double width, double gravity) {
  fabric.compression = compression;
  const double load = gravity * fabric.areal_density;
  const StripAtRest guess =
      strip_at_rest(section_bending(fabric.tension.slowest(), compression, fabric.thickness), length, load);
  const double frequency =
      strip_frequency(stiffness_of(guess.tip(), length, load), fabric.areal_density, length);
  Case strip;
  strip.name = "strip";
  strip.material = fabric;
  strip.ply.width = length;
  strip.ply.height = width;
  strip.gravity = gravity;
  strip.damping = 2 * frequency;
  strip.clamped = {Edge::left};
  strip.rest = RestCriterion{};
  constexpr double kPeriods = 30;  // far more than a critically damped strip needs
  strip.duration = kPeriods * 2 * M_PI / frequency;
  FemOptions fem;
  constexpr double kCellsAcross = 4;  // as in cases/cantilever-150.json
  fem.mesh_size = width / kCellsAcross;
  fem.rates = false;
  strip.fidelities[kReport] = fem;
  const Model model = model_of(strip, fem);
  RunRequest request;
  request.duration = strip.duration;
  const RunResult run = simulate(model, request);
  if (run.summary.status != RunStatus::done)
    throw NotFinished("a strip of the bending model: " + run.summary.message);
  const Mesh& mesh = model.scene().mesh;
  const Foot tip = nearest_foot(mesh, {0.5 * length, 0});
  const Snapshot start = take_snapshot(model, model.flat_state(0), RigDrive{});
  return (place_of(mesh, tip, start.position) - place_of(mesh, tip, run.final.position)).z();
}

}  // namespace

Curve master_compression(const Curve& tension) {
  constexpr double kBreak = 0.001, kEnd = 0.011, kSlopeBeyond = 5e8;  // [-], [-], [Pa]
  const double at_break = tension(kBreak);
  return {{0, kBreak, kEnd}, {0, at_break, at_break + (kEnd - kBreak) * kSlopeBeyond}};
}

double BendingModel::scale_of(double drop) const {
  if (!(drop <= tip.front() && drop >= tip.back()))
    throw NotFinished(fmt::format(
        "a drop of {:.1f} mm lies outside those of the bending model, {:.1f} to {:.1f} mm: nothing is "
        "extrapolated",
        1e3 * drop, 1e3 * tip.back(), 1e3 * tip.front()));
  std::vector<double> drops(tip.rbegin(), tip.rend()), logarithms;
  for (auto s = scale.rbegin(); s != scale.rend(); ++s) logarithms.push_back(std::log(*s));
  return std::exp(MonotoneCubic(drops, logarithms)(drop));
}

BendingModel bending_model(Fabric fabric, const Curve& master, double length, double width, double gravity,
                           int threads) {
  BendingModel model;
  for (int k = 0; k < kStrips; ++k)
    model.scale.push_back(kSmallestScale *
                          std::pow(kLargestScale / kSmallestScale, double(k) / (kStrips - 1)));
  model.tip.resize(kStrips);
  fabric.tension = fabric.tension.slowest();
  fabric.shear = fabric.shear.slowest();
  parallel_for(
      kStrips,
      [&](int k) {
        model.tip[size_t(k)] =
            simulated_drop(fabric, scaled(master, model.scale[size_t(k)]), length, width, gravity);
      },
      threads);
  for (int k = 1; k < kStrips; ++k) {
    if (!(model.tip[size_t(k)] < model.tip[size_t(k) - 1]))
      throw NotFinished("the bending model: a stiffer strip drops further; its mesh is too coarse");
  }
  return model;
}

CompressionLaw compression_law(const TipHistory& history, const Fabric& fabric, double gravity, int threads) {
  if (history.time.empty() || history.time.front() > kFirstTime)
    throw NotFinished(fmt::format("the cantilever's history starts after {} s", kFirstTime));
  CompressionLaw law;
  law.master = master_compression(fabric.tension.slowest());
  law.model = bending_model(fabric, law.master, history.length, history.width, gravity, threads);
  std::vector<double> time, strain;
  for (size_t k = 0; k < history.time.size(); ++k) {
    if (history.time[k] > 0 && history.root_strain[k] > 0)
      time.push_back(history.time[k]), strain.push_back(history.root_strain[k]);
  }
  const DoublePowerLaw strains = fit_double_power(time, strain);
  law.static_tip = *std::max_element(history.tip.begin(), history.tip.end());
  const std::vector<double> tips = not_decreasing(history.tip, std::vector<double>(history.tip.size(), 1));
  // Drops over time, straight between the measured instants.
  const auto drop_at = [&](double t) {
    const auto above = std::upper_bound(history.time.begin() + 1, history.time.end() - 1, t);
    const auto k = size_t(above - history.time.begin());
    const double share = (t - history.time[k - 1]) / (history.time[k] - history.time[k - 1]);
    return tips[k - 1] + share * (tips[k] - tips[k - 1]);
  };
  const auto time_at = [&](double drop) {
    size_t k = 1;
    while (k + 1 < tips.size() && tips[k] < drop) ++k;
    const double rise = tips[k] - tips[k - 1];
    const double share = rise > 0 ? std::clamp((drop - tips[k - 1]) / rise, 0.0, 1.0) : 0;
    return history.time[k - 1] + share * (history.time[k] - history.time[k - 1]);
  };
  law.first_tip = drop_at(kFirstTime);
  const double slowest = law.model.scale_of(law.static_tip), fastest = law.model.scale_of(law.first_tip);
  std::vector<double> logarithms;
  for (const double scale : law.model.scale) logarithms.push_back(std::log(scale));
  const MonotoneCubic drop_of(logarithms, law.model.tip);
  for (int k = 0; k < kCurves; ++k) {
    const double factor = slowest + (fastest - slowest) * k / (kCurves - 1);
    const double at = k == 0 ? history.time.back() : k + 1 == kCurves ? kFirstTime : time_at(drop_of(std::log(factor)));
    law.factors.push_back(factor);
    law.times.push_back(at);
    law.rates.push_back(k == 0 ? kAtRest : strains.rate(at));
  }
  const double load = gravity * fabric.areal_density;
  law.stiffness = stiffness_of(law.static_tip, history.length, load);
  law.frequency = strip_frequency(law.stiffness, fabric.areal_density, history.length);
  law.alpha = 2 * law.frequency;
  return law;
}

}  // namespace drapeplan
