#include "planner/stress/kit.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <stdexcept>

#include "fem/run/workspace.hpp"
#include "mapping/article_mold.hpp"
#include "planner/base/text.hpp"
#include "planner/case/file.hpp"
#include "planner/drape/problem.hpp"

namespace drapeplan {
namespace {

constexpr double kThickness = 3e-4, kArealDensity = 0.314;  // of the article's prepreg [m], [kg/m^2]

/// A file in the folder for temporary files, gone when it goes out of scope.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    static std::atomic<int> count{0};  // several threads build scenes at once
    path_ = std::filesystem::temp_directory_path() /
            fmt::format("drapeplan-stress-{}-{}.json", getpid(), count++);
    write_text(path_, text);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// R.m.s. gap to the mold [m].
double rms_gap(const StressRun& run, const Snapshot& ply) {
  double sum = 0;
  for (const Eigen::Vector3d& x : ply.position) {
    const double gap =
        run.setup.scene.mold->closest(x).signed_distance - 0.5 * run.setup.scene.fabric.thickness;
    sum += std::pow(std::max(gap, 0.0), 2);
  }
  return std::sqrt(sum / double(ply.position.size()));
}

}  // namespace

RunRequest request_of(const StressSetup& setup) {
  RunRequest request;
  request.schedule = setup.schedule ? &*setup.schedule : nullptr;
  request.duration = setup.duration;
  return request;
}

Fabric linear_fabric(double modulus, double shear, double transverse, double compression_share) {
  Fabric fabric;
  fabric.thickness = kThickness;
  fabric.areal_density = kArealDensity;
  fabric.tension = Curve{{0, 0.01}, {0, 0.01 * modulus}};
  fabric.compression = Curve{{0, 0.01}, {0, 0.01 * modulus * compression_share}};
  fabric.shear = Curve{{0, 1}, {0, shear}};
  fabric.transverse_shear_modulus = transverse;
  return fabric;
}

Fabric woven_fabric() {
  Fabric fabric = linear_fabric(0, 0, 2e5);
  fabric.tension = Curve{{0, 0.001, 0.003, 0.0067}, {0, 5.6e6, 23.5e6, 66.7e6}};
  fabric.compression = Curve{{0, 0.001, 0.02}, {0, 0.53e6, 1.43e6}};
  fabric.shear = Curve{{0, 10 * kDegree, 35 * kDegree, 50 * kDegree}, {0, 0.09e6, 0.11e6, 0.4e6}};
  return fabric;
}

HingedSag sag_of(const StripSetup& s) {
  return hinged_sag({.length = s.length,
                     .stretch = s.modulus * s.thickness,
                     .bending = s.modulus * std::pow(s.thickness, 3) / 12,
                     .transverse = 5.0 / 6 * s.transverse * s.thickness,
                     .load = s.density * s.thickness * s.gravity});
}

StressSetup hinged_strip(const StripSetup& s) {
  StressSetup setup;
  Scene& scene = setup.scene;
  scene.mesh = grid_mesh(s.along, s.across, [&s](double u, double v) {
    return Eigen::Vector2d((u - 0.5) * s.length, (v - 0.5) * s.width);
  });
  std::mt19937 random(7);
  std::uniform_real_distribution<double> move(-s.distortion, s.distortion);
  for (int n = 0; n < scene.mesh.node_count(); ++n) {
    Eigen::Vector2d& x = scene.mesh.rest[size_t(n)];
    const Eigen::Vector2d by(move(random) * s.length / s.along, move(random) * s.width / s.across);
    const int i = n % (s.along + 1), j = n / (s.along + 1);
    if (i > 0 && i < s.along && j > 0 && j < s.across) x += by;
    if (i == 0 || i == s.along) scene.pinned.push_back(n);
  }
  scene.fabric = linear_fabric(s.modulus, s.shear, s.transverse, s.compression_share);
  scene.fabric.thickness = s.thickness;
  scene.fabric.areal_density = s.density * s.thickness;
  scene.options = s.options;
  scene.gravity = s.gravity;
  // Critical for the lowest mode about the sagged state; at rest after some twenty of its time constants.
  constexpr double kConstants = 40;
  const double wave2 = std::pow(std::numbers::pi / s.length, 2);
  const double bending = s.modulus * std::pow(s.thickness, 3) / 12;
  const double rate = std::sqrt((bending * wave2 + sag_of(s).tension) * wave2 / (s.density * s.thickness));
  scene.damping = 2 * rate;
  setup.duration = kConstants / rate * std::sqrt(s.options.mass_scaling);
  return setup;
}

double middle_sag(const StressRun& run) {
  const Mesh& mesh = run.setup.scene.mesh;
  double sag = 0;
  int count = 0;
  for (size_t n = 0; n < mesh.rest.size(); ++n) {
    if (std::abs(mesh.rest[n].x()) > 1e-9) continue;  // distorted meshes have such nodes at the edges only
    sag -= run.result.final.position[n].z();
    ++count;
  }
  return sag / count;
}

StressScene strip_scene(std::string group, std::string name, const StripSetup& strip, double share) {
  StressScene scene{std::move(group), std::move(name), [strip] { return hinged_strip(strip); },
                    [strip, share](const StressRun& run) {
                      return std::vector{near("sag [m]", middle_sag(run), sag_of(strip).sag, share)};
                    }};
  scene.most_drift = 1e-4 * sag_of(strip).sag;
  return scene;
}

StressSetup from_case(const std::string& text, const std::vector<std::string>& overrides) {
  const TemporaryFile file(text);
  const CaseReading reading = read_case(file.path(), overrides);
  std::string errors;
  for (const InputError& error : reading.errors)
    errors += fmt::format("{}{}: {}", errors.empty() ? "" : "; ", error.path, error.message);
  if (!errors.empty()) throw std::invalid_argument(errors);
  const Case& definition = reading.definition;
  StressSetup setup;
  if (!definition.grippers) {
    setup.scene = scene_of(definition, definition.fidelities.at(kReport));
    setup.duration = definition.duration;
    return setup;
  }
  const DrapeProblem problem(definition);
  setup.scene = problem.model(kReport).scene();
  setup.schedule = to_schedule(problem.frame(), uniform_strokes(problem.frame()));
  setup.warnings = map_warnings(definition, problem.mapping());
  return setup;
}

StressSetup corner_drape(double mesh_size) {
  StressSetup setup;
  Scene& scene = setup.scene;
  RigOptions rig;
  rig.columns = rig.rows = 2;
  rig.spacing = 0.12;
  scene.rig = rig;
  scene.mesh =
      rectangle_mesh(0.16, 0.16, mesh_size, column_places(rig, mesh_size), row_places(rig, mesh_size));
  scene.fabric = woven_fabric();
  scene.options.mass_scaling = 4;
  scene.options.time_scaling = 10;
  scene.position = {0.1, 0.1};
  scene.gravity = kGravity;
  scene.damping = 200;  // nearly critical for the ply between its pads
  scene.mold = article_mold();
  scene.friction = 1.5;
  setup.schedule = lay_down(scene);
  return setup;
}

Schedule lay_down(const Scene& scene, double depth, double speed) {
  constexpr double kClearance = 0.02;                   // [m]
  constexpr double kAbove = 2, kTouch = 5, kRest = 10;  // [s], the last beside the others
  Schedule schedule;
  schedule.blend_time = 0.1;
  std::vector<double> place;
  double top = -1e300;
  for (int g = 0; g < scene.rig->count(); ++g) {
    const Eigen::Vector2d xy = scene.position + scene.rig->place(g);
    place.push_back(scene.mold->height(xy.x(), xy.y()) + scene.rig->joint_offset);
    top = std::max(top, place.back());
  }
  for (const double end : place) {
    schedule.paths.push_back({{0, top + kClearance},
                              {kAbove / speed, end + kClearance},
                              {kTouch / speed, end - depth},
                              {kTouch / speed + kRest, end - depth}});
  }
  return schedule;
}

double weight_of(const Scene& scene) {
  double area = 0;
  for (const double share : nodal_areas(scene.mesh)) area += share;
  return area * scene.fabric.areal_density * scene.gravity.value_or(0);
}

double support_over_weight(const StressRun& run) {
  State state = run.result.state;
  Workspace work(run.model);
  compute_forces(run.model, state, work);
  double sum = 0;
  for (const Forces& entry : work.entries) {
    if (entry.book != Book::contact && entry.book != Book::friction) continue;
    for (int n = 0; n < run.model.node_count(); ++n) sum += entry.force.z[size_t(n)];
  }
  for (const double force : run.result.final.actuator_force) sum += force;
  return sum / weight_of(run.setup.scene);
}

double apart_from(const StressRun& run, const FemOptions& options) {
  StressSetup changed = run.setup;
  changed.scene.options = options;
  const Model model(changed.scene);
  const RunResult other = simulate(model, request_of(changed));
  if (other.summary.status != RunStatus::done) return std::nan("");
  double sum = 0;
  const auto &a = run.result.final.position, &b = other.final.position;
  for (size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]).squaredNorm();
  return std::sqrt(sum / double(a.size()));
}

StressCheck weight_carried(const StressRun& run, double share) {
  constexpr double kOfActuators = 1e-3;
  const double weight = weight_of(run.setup.scene);
  double actuators = 0;
  for (const double force : run.result.final.actuator_force) actuators += std::abs(force);
  return at_most("weight not carried [N]", std::abs(support_over_weight(run) - 1) * weight,
                 share * weight + kOfActuators * actuators);
}

double covered_area(const Mesh& mesh, const Snapshot& ply) {
  double sum = 0;
  for (size_t k = 0; k < mesh.outline.size(); ++k) {
    const Eigen::Vector3d &a = ply.position[size_t(mesh.outline[k])],
                          &b = ply.position[size_t(mesh.outline[(k + 1) % mesh.outline.size()])];
    sum += 0.5 * (a.x() * b.y() - b.x() * a.y());
  }
  return sum;
}

std::vector<StressCheck> pressed_down(const StressRun& run) {
  if (!run.result.unpressed) return {at_most("no ply before pressing", std::nan(""), 0)};
  const double weight = weight_of(run.setup.scene);
  const double load =
      weight + run.setup.scene.press->pressure * covered_area(run.setup.scene.mesh, run.result.final);
  return {near("forces that bear the ply [N]", support_over_weight(run) * weight, load, 0.02),
          at_most("r.m.s. gap [m]", rms_gap(run, run.result.final),
                  1.02 * rms_gap(run, *run.result.unpressed) + 1e-5)};
}

StressScene drape_scene(std::string group, std::string name, std::function<void(StressSetup&)> change) {
  StressScene scene{std::move(group), std::move(name),
                    [change] {
                      StressSetup setup = corner_drape();
                      change(setup);
                      return setup;
                    },
                    [](const StressRun& run) { return std::vector{weight_carried(run)}; }};
  scene.most_drift = 1e-4;
  return scene;
}

FemOptions safer(const StressRun& run, double step_safety) {
  FemOptions options = run.setup.scene.options;
  options.step_safety = step_safety;
  return options;
}

Eigen::Vector3d mean_displacement(const StressRun& run) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto &from = run.frames.front().position, &to = run.result.final.position;
  for (size_t n = 0; n < to.size(); ++n) sum += to[n] - from[n];
  return sum / double(to.size());
}

}  // namespace drapeplan
