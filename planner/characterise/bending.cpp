#include "planner/characterise/bending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fem/mesh/foot.hpp"
#include "fem/run/simulate.hpp"
#include "mapping/error.hpp"
#include "planner/base/parallel.hpp"
#include "planner/case/fields.hpp"
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
double simulated_drop(Fabric fabric, const Curve& compression, double length, double width, double gravity,
                      int section_points) {
  fabric.compression = compression;
  Case strip = falling_strip(fabric, length, width, gravity, section_points);
  strip.rest = RestCriterion{};
  FemOptions& fem = strip.fidelities.at(kReport);
  fem.rates = false;
  constexpr double kPeriods = 30;  // far more than a critically damped strip needs
  strip.duration = kPeriods * 2 * std::numbers::pi / (0.5 * *strip.damping);
  const Model model = model_of(strip, fem);
  RunRequest request;
  request.duration = strip.duration;
  const RunResult run = simulate(model, request);
  if (run.summary.status != RunStatus::done)
    throw NotFinished("a strip of the bending model: " + run.summary.message);
  const Mesh& mesh = model.scene().mesh;
  return strip.start_height - place_of(mesh, nearest_foot(mesh, {0.5 * length, 0}), run.final.position).z();
}

}  // namespace

Case falling_strip(const Fabric& fabric, double length, double width, double gravity, int section_points) {
  const double load = gravity * fabric.areal_density;
  const BendingLaw law =
      section_bending(fabric.tension.slowest(), fabric.compression.slowest(), fabric.thickness);
  const double drop = strip_at_rest(law, length, load).tip();
  double stiffness = 0;
  try {
    stiffness = stiffness_of(drop, length, load);
  } catch (const std::invalid_argument&) {
    throw NotFinished(fmt::format("a strip of {:g} mm of this material hangs down straight: no test of its bending",
                                  1e3 * length));
  }
  Case strip;
  strip.name = "strip";
  strip.material = fabric;
  strip.ply.width = length;
  strip.ply.height = width;
  strip.gravity = gravity;
  strip.damping = 2 * strip_frequency(stiffness, fabric.areal_density, length);
  strip.clamped = {Edge::left};
  FemOptions fem;
  constexpr double kCellsAcross = 3;  // four, as in cases/cantilever-150.json, drop by 0.03 mm less
  fem.mesh_size = width / kCellsAcross;
  fem.section_points = section_points;
  fem.fibre_mass_scaling = 8;  // nothing stretches: drops change by less than 0.01 mm, and runs take an eighth
  strip.fidelities[kReport] = fem;
  return strip;
}

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
                           int section_points, int threads, const std::vector<double>& sought) {
  fabric.tension = fabric.tension.slowest();
  fabric.shear = fabric.shear.slowest();
  BendingModel model;
  const auto add = [&](const std::vector<double>& scales) {
    std::vector<double> tips(scales.size());
    parallel_for(
        int(scales.size()),
        [&](int k) {
          tips[size_t(k)] =
              simulated_drop(fabric, scaled(master, scales[size_t(k)]), length, width, gravity, section_points);
        },
        threads);
    for (size_t k = 0; k < scales.size(); ++k) {
      const auto at = std::lower_bound(model.scale.begin(), model.scale.end(), scales[k]);
      model.tip.insert(model.tip.begin() + (at - model.scale.begin()), tips[k]);
      model.scale.insert(at, scales[k]);
    }
    for (size_t k = 1; k < model.tip.size(); ++k) {
      if (!(model.tip[k] < model.tip[k - 1]))
        throw NotFinished("the bending model: a stiffer strip drops further; its mesh is too coarse");
    }
  };
  std::vector<double> scales;
  for (int k = 0; k < kStrips; ++k)
    scales.push_back(kSmallestScale * std::pow(kLargestScale / kSmallestScale, double(k) / (kStrips - 1)));
  add(scales);
  constexpr double kNear = 1e-3;  // of a scale: a strip there is near enough
  scales.clear();
  for (const double drop : sought) {
    const double scale = model.scale_of(drop);
    const auto near = [scale](double other) { return std::abs(other - scale) < kNear * scale; };
    if (std::none_of(model.scale.begin(), model.scale.end(), near) &&
        std::none_of(scales.begin(), scales.end(), near))
      scales.push_back(scale);
  }
  add(scales);
  return model;
}

CompressionLaw compression_law(const TipHistory& history, const Fabric& fabric, double gravity, int section_points,
                               int threads) {
  if (history.time.empty() || history.time.front() > kFirstTime)
    throw NotFinished(fmt::format("the cantilever's history starts after {} s", kFirstTime));
  if (history.time.size() < kCurves)
    throw NotFinished(
        fmt::format("the cantilever was seen at {} times; its {} curves need as many", history.time.size(), kCurves));
  CompressionLaw law;
  const std::vector<double> tips = not_decreasing(history.tip, std::vector<double>(history.tip.size(), 1));
  law.static_tip = tips.back();
  law.first_tip = value_between(history.time, tips, kFirstTime);
  law.master = master_compression(fabric.tension.slowest());
  law.model = bending_model(fabric, law.master, history.length, history.width, gravity, section_points, threads,
                            {law.first_tip, law.static_tip});
  const double load = gravity * fabric.areal_density;
  std::vector<double> time, strain;  // outside at the clamp
  for (size_t k = 0; k < tips.size(); ++k) {
    if (!(history.time[k] > 0 && tips[k] <= law.model.tip.front() && tips[k] >= law.model.tip.back())) continue;
    const BendingLaw bending = section_bending(
        fabric.tension.slowest(), scaled(law.master, law.model.scale_of(tips[k])), fabric.thickness);
    time.push_back(history.time[k]);
    strain.push_back(0.5 * fabric.thickness * strip_at_rest(bending, history.length, load).curvature.front());
  }
  constexpr size_t kFewestTimes = 4;  // of a double power
  if (time.size() < kFewestTimes)
    throw NotFinished(fmt::format("the cantilever has {} drops among those of the bending model, {:.1f} to {:.1f} mm; "
                                  "its rates need {}",
                                  time.size(), 1e3 * law.model.tip.back(), 1e3 * law.model.tip.front(), kFewestTimes));
  const DoublePowerLaw strains = fit_double_power(time, strain);
  law.largest_strain = *std::max_element(strain.begin(), strain.end());
  const double slowest = law.model.scale_of(law.static_tip), fastest = law.model.scale_of(law.first_tip);
  std::vector<double> logarithms;
  for (const double scale : law.model.scale) logarithms.push_back(std::log(scale));
  const MonotoneCubic drop_of(logarithms, law.model.tip);
  for (int k = 0; k < kCurves; ++k) {
    const double factor = slowest + (fastest - slowest) * k / (kCurves - 1);
    const double at = k == 0             ? history.time.back()
                      : k + 1 == kCurves ? kFirstTime
                                         : value_between(tips, history.time, drop_of(std::log(factor)));
    law.factors.push_back(factor);
    law.times.push_back(at);
    law.rates.push_back(k == 0 ? kAtRest : strains.rate(at));
    if (k > 0 && !(law.rates.back() > *(law.rates.end() - 2)))
      throw NotFinished(fmt::format(
          "the cantilever's strain at the clamp does not grow more slowly the longer it hangs: {:.2g} 1/s after "
          "{:.3g} s; its pictures are too coarse, or too few",
          law.rates.back(), at));
  }
  law.stiffness = stiffness_of(law.static_tip, history.length, load);
  law.frequency = strip_frequency(law.stiffness, fabric.areal_density, history.length);
  law.alpha = 2 * law.frequency;
  return law;
}

}  // namespace drapeplan
