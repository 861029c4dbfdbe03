#include "fem/terms/press.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

using Eigen::Vector3d;

/// Signs of the corners' coordinates in their element, which reach from -1 to 1.
constexpr std::array<double, 4> kXi{-1, 1, 1, -1}, kEta{-1, -1, 1, 1};

class PressTerm final : public Term {
 public:
  PressTerm(const Press& press, const Mesh& mesh)
      : full_(press.pressure), quads_(mesh.quads), rest_(mesh.rest) {}

  [[nodiscard]] std::string_view name() const override { return "press"; }

  [[nodiscard]] std::vector<Forces> entries() const override {
    const auto chunks = (rest_.size() + size_t(kChunk) - 1) / size_t(kChunk);
    return {{Book::load, VectorField(int(rest_.size())), {}, std::vector<double>(chunks, kIdle)}};
  }

  void add_stiffness(NodalStiffness& stiffness) const override {
    const auto place_of = [this](int n) { return Vector3d(rest_[size_t(n)].x(), rest_[size_t(n)].y(), 0); };
    add_bounds(full_, place_of, stiffness);
  }

  void add_tangent(const State& state, NodalStiffness& stiffness) const override {
    if (state.pressure == 0) return;
    add_bounds(
        state.pressure, [&state](int n) { return place(state, n); }, stiffness);
  }

  /// Without pressure the forces are zero as entries() made them, and nobody looks at them.
  void forces(State& state, Forces* entries) const override {
    std::fill(entries->clearance.begin(), entries->clearance.end(), state.pressure == 0 ? kIdle : 0.0);
    if (state.pressure == 0) return;
    VectorField& force = entries->force;
    for (auto* part : {&force.x, &force.y, &force.z}) std::fill(part->begin(), part->end(), 0.0);
    for (const std::array<int, 4>& quad : quads_) {
      const Vector3d x0 = place(state, quad[0]), x1 = place(state, quad[1]), x2 = place(state, quad[2]),
                     x3 = place(state, quad[3]);
      const Vector3d ac = x2 - x0, bd = x3 - x1, twist = 0.25 * (x0 - x1 + x2 - x3);
      const Vector3d along = 0.25 * (ac - bd), across = 0.25 * (ac + bd);
      // The area vector is that of the middle, and changes linearly along both directions.
      const Vector3d middle = along.cross(across), by_xi = along.cross(twist) / 3,
                     by_eta = twist.cross(across) / 3;
      for (size_t c = 0; c < 4; ++c) {
        const auto n = size_t(quad[c]);
        const Vector3d part = -state.pressure * (middle + kXi[c] * by_xi + kEta[c] * by_eta);
        force.x[n] += part.x(), force.y[n] += part.y(), force.z[n] += part.z();
      }
    }
  }

 private:
  static constexpr double kIdle = 1;  ///< [m]: any length above 0

  static Vector3d place(const State& state, int node) {
    const auto n = size_t(node);
    return {state.position.x[n], state.position.y[n], state.position.z[n]};
  }

  /// Where all corners of an element move by 1, its tangents turn by at most 1/2 each; a corner's share of
  /// what that does to the area vector is at most half the longer edges of both directions. The stiffness of
  /// a load that follows is not symmetric, but its eigenvalues are below its largest row.
  void add_bounds(double pressure, const auto& place_of, NodalStiffness& stiffness) const {
    for (const std::array<int, 4>& quad : quads_) {
      std::array<double, 4> edge{};
      for (size_t c = 0; c < 4; ++c) edge[c] = (place_of(quad[(c + 1) % 4]) - place_of(quad[c])).norm();
      const double row = 0.5 * pressure * (std::max(edge[0], edge[2]) + std::max(edge[1], edge[3]));
      for (const int node : quad) stiffness.translation[size_t(node)] += row;
    }
  }

  double full_;
  std::vector<std::array<int, 4>> quads_;
  std::vector<Eigen::Vector2d> rest_;
};

}  // namespace

void check_press(const Press& press) {
  const bool good = std::isfinite(press.pressure) && press.pressure >= 0 &&
                    std::isfinite(press.delay.value_or(0)) && press.delay.value_or(0) >= 0 &&
                    std::isfinite(press.duration) && press.ramp > 0 && press.ramp <= press.duration;
  if (good) return;
  throw WrongInput(fmt::format(
      "press: needs a pressure >= 0 ({:g} Pa), a delay >= 0 ({:g} s), and a ramp > 0 ({:g} s) within its "
      "duration ({:g} s), all finite",
      press.pressure, press.delay.value_or(0), press.ramp, press.duration));
}

PressTimes press_times(const Press& press, const Schedule* schedule, double end) {
  double start = end;
  if (press.delay) start = (schedule != nullptr ? schedule->last_stroke() : end) + *press.delay;
  return {start, start + press.ramp, start + press.duration};
}

double pressure_at(const PressTimes& times, double full, double t) {
  const double s = std::clamp((t - times.start) / (times.full - times.start), 0.0, 1.0);
  return full * s * s * (3 - 2 * s);
}

std::unique_ptr<Term> make_press(const Press& press, const Mesh& mesh) {
  return std::make_unique<PressTerm>(press, mesh);
}

}  // namespace drapeplan
