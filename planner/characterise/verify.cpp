#include "planner/characterise/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "fem/mesh/foot.hpp"
#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "mapping/error.hpp"
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
  constexpr double kDiagonals = 8, kCells = 4;  // across the width: of cells at 45 degrees, or cells along it
  fem.mesh_size = bias ? test.width / (kDiagonals * std::numbers::sqrt2) : test.width / kCells;
  fem.section_points = 1;
  fem.mass_scaling = mass_scaling;
  constexpr double kSimulated = 1;  // [s]: a run of a second, as in cases/bias-extension.json
  fem.time_scaling = std::max(1.0, strip.duration / kSimulated);
  strip.fidelities[kReport] = fem;
  return strip;
}

/// The errors between `compared_from` and `compared_to`, which ends where one of the two curves ends.
void compare(Verification& v) {
  const MonotoneCubic simulated = curve_through(v.simulated);
  constexpr double kRoundOff = 1e-9;
  v.compared_to = std::min({v.compared_to, simulated.end(), v.measured.back().x()});
  double largest = 0;
  for (const Eigen::Vector2d& point : v.measured) {
    if (point.x() > v.compared_to * (1 + kRoundOff)) break;
    largest = v.what == Compared::drop ? v.measured.back().y() : std::max(largest, point.y());
    if (point.x() < v.compared_from) continue;
    v.end_error = std::abs(simulated(point.x()) - point.y()) / largest;
    v.error = std::max(v.error, v.end_error);
  }
}

/// Plays a case and shows its frames. @return why it did not end; empty if it did.
std::string play(const Case& strip, const Model& model, int frames,
                 const std::function<void(const Snapshot&)>& observe) {
  RunRequest request;
  request.duration = strip.duration;
  request.frames = frames;
  request.observe = observe;
  const RunResult run = simulate(model, request);
  return run.summary.status == RunStatus::done ? "" : run.summary.message;
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

MonotoneCubic curve_through(const std::vector<Eigen::Vector2d>& history) {
  std::vector<double> x, y;
  for (const Eigen::Vector2d& point : history) {
    if (!x.empty() && !(point.x() > x.back())) continue;
    x.push_back(point.x()), y.push_back(point.y());
  }
  return {std::move(x), std::move(y)};
}

PulledStrip pull_strip(const StripTest& test, const Fabric& fabric, bool bias, double to, double mass_scaling) {
  PulledStrip result;
  const Case strip = strip_case(test, fabric, bias, to, mass_scaling);
  const Model model = model_of(strip, strip.fidelities.at(kReport));
  constexpr int kFrames = 61;
  const auto head = size_t(model.scene().grips.back().nodes.front());
  const double start = take_snapshot(model, model.flat_state(strip.start_height), RigDrive{}).position[head].y();
  result.failure = play(strip, model, kFrames, [&](const Snapshot& frame) {
    const double way = frame.position[head].y() - start;
    result.force.emplace_back(way, frame.grip_force.back().y());
    if (bias) result.angle.emplace_back(way, axis_shear(model.scene(), test, frame));
  });
  return result;
}

Verification verify_strip(const StripTest& test, std::vector<Eigen::Vector2d> measured, const Fabric& fabric,
                          bool bias, double to) {
  constexpr double kFrom = 0.2;  // of the way that is compared
  Verification result{.what = Compared::force,
                      .name = fmt::format("{} at {:g} mm/min", bias ? "bias extension" : "tension",
                                          std::round(6e6 * test.rate) / 100),
                      .file = test.file,
                      .measured = std::move(measured),
                      .simulated = {},
                      .compared_from = kFrom * to,
                      .compared_to = to,
                      .failure = {}};
  constexpr double kMassScaling = 20;  // as in cases/bias-extension.json
  PulledStrip strip = pull_strip(test, fabric, bias, to, kMassScaling);
  result.simulated = std::move(strip.force);
  result.failure = std::move(strip.failure);
  if (result.failure.empty()) compare(result);
  return result;
}

Verification verify_cantilever(const TipHistory& history, const std::string& file, const Fabric& fabric,
                               double gravity, int section_points) {
  constexpr double kSimulated = 13;  // [s]: longer tests are played faster; as in cases/cantilever-150.json
  constexpr double kPeriods = 1.25;  // after which less than 1 % of a critically damped fall is left
  constexpr int kFrames = 401;
  Verification result{.what = Compared::drop,
                      .name = fmt::format("cantilever of {:g} mm", 1e3 * history.length),
                      .file = file,
                      .measured = {},
                      .simulated = {},
                      .compared_from = 0,
                      .compared_to = history.time.back(),
                      .failure = {}};
  for (size_t k = 0; k < history.time.size(); ++k) result.measured.emplace_back(history.time[k], history.tip[k]);
  Case strip;
  try {
    strip = falling_strip(fabric, history.length, history.width, gravity, section_points);
  } catch (const NotFinished& error) {
    result.failure = error.what();
    return result;
  }
  strip.duration = history.time.back();
  FemOptions& fem = strip.fidelities.at(kReport);
  fem.time_scaling = std::max(1.0, strip.duration / kSimulated);
  const double period = 2 * std::numbers::pi / (0.5 * *strip.damping);
  result.compared_from = std::min(kPeriods * period * std::sqrt(fem.mass_scaling) * fem.time_scaling,
                                  result.compared_to);  // its end at least
  const Model model = model_of(strip, fem);
  const Mesh& mesh = model.scene().mesh;
  const Foot tip = nearest_foot(mesh, {0.5 * history.length, 0});
  result.failure = play(strip, model, kFrames, [&](const Snapshot& frame) {
    result.simulated.emplace_back(frame.time, -place_of(mesh, tip, frame.position).z());
  });
  if (result.failure.empty()) compare(result);
  return result;
}

}  // namespace drapeplan
