#include "planner/characterise/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "planner/tables/smooth.hpp"
#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

/// The strip as a case: the foot held, the head pulled along +y at the test's speed.
Case strip_case(const StripTest& test, const Fabric& fabric, bool bias, double to, double mass_scaling) {
  Case strip;
  strip.name = "strip";
  strip.material = fabric;
  const double u = 0.5 * test.width, v = 0.5 * test.height;
  strip.ply.angle = bias ? -std::numbers::pi / 4 : 0;
  // In the frame of the ply, whose fibres are its axes: a strip at 45 degrees is turned the other way.
  const Eigen::Rotation2Dd turn(-strip.ply.angle);
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(-u, -v), Eigen::Vector2d(u, -v), Eigen::Vector2d(u, v), Eigen::Vector2d(-u, v)})
    strip.ply.outline.push_back(turn * corner);
  const Polygon& outline = strip.ply.outline;
  const Eigen::Vector2d size = bounding_box(outline).sizes();
  strip.ply.width = size.x();
  strip.ply.height = size.y();
  constexpr double kRamp = 0.1;  // of the whole time: slow enough that no wave is seen in the force
  strip.duration = to / test.rate / (1 - 0.5 * kRamp);
  strip.grips.push_back({"foot", outline[0], outline[1], {0, 0, 0}});
  strip.grips.push_back({"head", outline[3], outline[2], {0, test.rate, 0}, kRamp * strip.duration});
  FemOptions fem;
  constexpr double kCells = 11;  // across the width, as in cases/bias-extension.json
  fem.mesh_size = test.width / kCells * (bias ? std::numbers::sqrt2 / 1.4409 : 1);
  fem.section_points = 1;
  fem.mass_scaling = mass_scaling;
  constexpr double kSimulated = 1;  // [s]: a run of a second, as in cases/bias-extension.json
  fem.time_scaling = std::max(1.0, strip.duration / kSimulated);
  strip.fidelities[kReport] = fem;
  return strip;
}

/// Largest difference over the largest force so far, between the second tenth and the end: before, both are
/// small, and the grips still gain speed.
double largest_error(const Verification& v) {
  std::vector<double> way, force;
  for (const Eigen::Vector2d& point : v.simulated) {
    if (!way.empty() && !(point.x() > way.back())) continue;
    way.push_back(point.x()), force.push_back(point.y());
  }
  const MonotoneCubic simulated(way, force);
  double error = 0, largest = 0;
  for (const Eigen::Vector2d& point : v.measured) {
    largest = std::max(largest, point.y());
    if (point.x() < 0.2 * v.compared_to || point.x() > std::min(v.compared_to, way.back())) continue;
    error = std::max(error, std::abs(simulated(point.x()) - point.y()) / largest);
  }
  return error;
}

/// Mean shear angle along the axis of a bias-extension strip, of the elements that it cuts into halves between the
/// triangles at the clamps, L0 = H - W [rad].
double axis_shear(const Scene& scene, const StripTest& test, const Snapshot& frame) {
  const Eigen::Rotation2Dd upright(scene.angle);
  constexpr double kOnAxis = 1e-6;  // of the width
  double sum = 0;
  int count = 0;
  for (size_t e = 0; e < scene.mesh.quads.size(); ++e) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const int node : scene.mesh.quads[e]) middle += 0.25 * scene.mesh.rest[size_t(node)];
    const Eigen::Vector2d place = (upright * middle).cwiseAbs();
    if (place.x() > kOnAxis * test.width || place.y() > 0.5 * (test.height - test.width)) continue;
    sum += std::abs(frame.shear[e]);
    ++count;
  }
  return sum / count;
}

}  // namespace

PulledStrip pull_strip(const StripTest& test, const Fabric& fabric, bool bias, double to, double mass_scaling) {
  PulledStrip result;
  const Case strip = strip_case(test, fabric, bias, to, mass_scaling);
  const Model model = model_of(strip, strip.fidelities.at(kReport));
  RunRequest request;
  request.duration = strip.duration;
  constexpr int kFrames = 61;
  request.frames = kFrames;
  const auto head_node = size_t(model.scene().grips.back().nodes.front());
  const Snapshot start = take_snapshot(model, model.flat_state(strip.start_height), RigDrive{});
  request.observe = [&](const Snapshot& frame) {
    const double way = (frame.position[head_node] - start.position[head_node]).y();
    result.force.emplace_back(way, frame.grip_force.back().y());
    if (bias) result.angle.emplace_back(way, axis_shear(model.scene(), test, frame));
  };
  const RunResult run = simulate(model, request);
  if (run.summary.status != RunStatus::done) result.failure = run.summary.message;
  return result;
}

Verification verify_strip(const StripTest& test, const Fabric& fabric, bool bias, double to) {
  Verification result{.name = fmt::format("{} at {:g} mm/min", bias ? "bias extension" : "tension",
                                          std::round(6e6 * test.rate) / 100),
                      .file = test.file,
                      .measured = {},
                      .simulated = {},
                      .compared_to = to,
                      .failure = {}};
  const std::vector<double>& way = test.table[TestQuantity::displacement];
  for (size_t k = 0; k < test.table.rows(); ++k)
    result.measured.emplace_back(way[k] - way.front(), test.table[TestQuantity::force][k]);
  constexpr double kMassScaling = 20;  // as in cases/bias-extension.json
  PulledStrip strip = pull_strip(test, fabric, bias, to, kMassScaling);
  result.simulated = std::move(strip.force);
  result.failure = std::move(strip.failure);
  if (result.failure.empty()) result.error = largest_error(result);
  return result;
}

}  // namespace drapeplan
