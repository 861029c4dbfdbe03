#include "planner/drape/run_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "planner/base/quantity.hpp"

namespace drapeplan {
namespace {

/// How far the pads' targets reach beyond the mold, or their places beyond the ply [m]; 0: nowhere.
double overhang(const DrapeProblem& problem) {
  const Case& c = problem.definition();
  const RigOptions& rig = *c.grippers;
  const Eigen::AlignedBox2d ply = bounding_box(corners_of(c.ply));
  const Extent& mold = c.mold->extent();
  double largest = 0;
  for (int g = 0; g < rig.count(); ++g) {
    const Eigen::Vector2d flat = rig.place(g), down = problem.mapping().targets[size_t(g)].head<2>();
    for (int k = 0; k < 2; ++k) {
      largest =
          std::max({largest, flat[k] + rig.pad_radius - ply.max()[k], ply.min()[k] - flat[k] + rig.pad_radius,
                    down[k] + rig.pad_radius - mold.upper[k], mold.lower[k] - down[k] + rig.pad_radius});
    }
  }
  return largest;
}

}  // namespace

std::vector<std::string> range_warnings(const MaterialNotes& material, const Score& score) {
  std::vector<std::string> warnings;
  const auto look = [&](const char* what, double reached, const char* curve, const CurveNotes& notes,
                        Dimension dimension) {
    if (!score.valid || !notes.valid_to || !(reached > *notes.valid_to)) return;
    const auto text = [dimension](double value) {
      return dimension == Dimension::angle ? fmt::format("{:.1f} deg", value * 180 / std::numbers::pi)
                                           : fmt::format("{:.3g} %", 1e2 * value);
    };
    warnings.push_back(fmt::format("the largest {} is {}, beyond what material.{} holds for ({})", what,
                                   text(reached), curve, text(*notes.valid_to)));
  };
  look("shear", score.max_shear_deg * std::numbers::pi / 180, "shear", material.shear, Dimension::angle);
  look("fibre tension", score.max_fibre_strain, "tension", material.tension, Dimension::strain);
  look("fibre compression", score.max_fibre_compression, "compression", material.compression,
       Dimension::strain);
  return warnings;
}

std::string thrown_text(double ratio, double limit) {
  return fmt::format(
      "the ply was thrown: its kinetic energy came to {:.2g} times its internal energy (limit {:g}, "
      "score.kinetic_limit); a smaller fem.time_scaling or fem.mass_scaling is slower and calmer",
      ratio, limit);
}

bool fabric_takes_part(const RunSummary& run) {
  return run.energy.internal > kFabricShare * run.energy.external;
}

std::vector<RunWarning> run_warnings(const DrapeProblem& problem, const Drape& drape,
                                     const std::string& fidelity) {
  const Case& c = problem.definition();
  const RunSummary& run = drape.run.summary;
  std::vector<RunWarning> list;
  const auto above = [&list](const char* check, double value, double limit, std::string text) {
    if (value > limit) list.push_back({check, value, limit, std::move(text)});
  };
  above("kinetic", fabric_takes_part(run) ? run.largest_kinetic_ratio : 0, kKineticLimit,
        fmt::format("kinetic: the ply's kinetic energy came to {:.2g} times its internal energy (limit "
                    "{:g}): inertia may "
                    "have moved it; a smaller fem.time_scaling or fem.mass_scaling shows whether",
                    run.largest_kinetic_ratio, kKineticLimit));
  const double damping = run.energy.external > 0 ? run.energy.damping / run.energy.external : 0;
  above("damping", damping, kDampingLimit,
        fmt::format("damping: mass damping took {:.0f} % of the work of gravity and actuators (limit {:.0f} "
                    "%): the ply "
                    "may have sunk too slowly; a smaller fem.time_scaling leaves it more time",
                    1e2 * damping, 1e2 * kDampingLimit));
  above("hourglass", run.largest_hourglass_share, kHourglassLimit,
        fmt::format(
            "hourglass: {:.1f} % of the internal energy lies in hourglass modes (limit {:.0f} %): a smaller "
            "fem.mesh_size has less",
            1e2 * run.largest_hourglass_share, 1e2 * kHourglassLimit));
  const FemOptions& fem = c.fidelities.at(fidelity);
  const double waves = double(run.steps) * fem.mesh_size / std::max(c.ply.width, c.ply.height);
  if (waves < kWavesLimit && run.status == RunStatus::done)
    list.push_back(
        {"waves", waves, kWavesLimit,
         fmt::format("waves: in {} steps a stress wave crosses the ply only {:.1f} times (limit {:g}): a "
                     "smaller fem.time_scaling or fem.mass_scaling takes more",
                     run.steps, waves, kWavesLimit)});
  const double depth = run.largest_penetration / c.material.thickness;
  above("penetration", depth, kPenetrationLimit,
        fmt::format("penetration: the ply came {:.3f} mm inside the mold, {:.0f} % of its thickness (limit "
                    "{:.0f} %): a "
                    "larger fem.contact_stiffness holds it",
                    1e3 * run.largest_penetration, 1e2 * depth, 1e2 * kPenetrationLimit));
  above("saturated", drape.score.saturated, 0,
        fmt::format("saturated: an actuator was at its limit of {:g} N for {:.1f} s",
                    c.grippers->actuator_force_limit, drape.score.saturated));
  const double beyond = overhang(problem);
  above("overhang", beyond, 1e-6,  // round-off
        fmt::format(
            "overhang: pads reach up to {:.1f} mm beyond the ply or the mold; the piece there holds nothing",
            1e3 * beyond));
  return list;
}

std::vector<std::string> drape_warnings(const DrapeProblem& problem, const Drape& drape,
                                        const std::string& fidelity) {
  std::vector<std::string> texts = range_warnings(problem.definition().material_notes, drape.score);
  for (const RunWarning& warning : run_warnings(problem, drape, fidelity)) texts.push_back(warning.text);
  return texts;
}

}  // namespace drapeplan
