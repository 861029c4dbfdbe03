#include "planner/views/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fem/run/monitor.hpp"
#include "fem/run/simulate.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

Recorder::Recorder(const Case& definition, const Model& model, const Schedule* schedule)
    : model_(model), thickness_(definition.material.thickness), wanted_(definition.instants) {
  const Scene& scene = model.scene();
  history_.time_scaling = scene.options.time_scaling;
  const Snapshot start = take_snapshot(model, model.flat_state(start_height(model, schedule)), RigDrive{});
  for (const Probe& probe : definition.probes) {
    feet_.push_back(nearest_foot(scene.mesh, probe.place));
    history_.probes.push_back({probe.name, place_of(scene.mesh, feet_.back(), start.position), {}, {}});
  }
  for (const Grip& grip : scene.grips) {
    grip_start_.push_back(start.position[size_t(grip.nodes.front())]);
    history_.grips.push_back({grip.name, grip.velocity, {}, {}});
  }
  std::stable_sort(wanted_.begin(), wanted_.end(),
                   [](const Instant& a, const Instant& b) { return a.time < b.time; });
  nearest_.resize(wanted_.size());
}

void Recorder::see(const Snapshot& now) {
  if (!history_.time.empty() && now.time <= history_.time.back()) return;
  const Scene& scene = model_.scene();
  Snapshot points;
  for (size_t k = 0; k < feet_.size(); ++k) {
    points.position.push_back(place_of(scene.mesh, feet_[k], now.position));
    history_.probes[k].place.push_back(points.position.back());
  }
  if (scene.mold) {
    const std::vector<double> gaps = signed_gaps(points, *scene.mold, thickness_);
    for (size_t k = 0; k < gaps.size(); ++k) history_.probes[k].gap.push_back(gaps[k]);
  }
  for (size_t k = 0; k < history_.grips.size(); ++k) {
    const auto node = size_t(scene.grips[k].nodes.front());
    history_.grips[k].displacement.push_back(now.position[node] - grip_start_[k]);
    history_.grips[k].force.push_back(now.grip_force[k]);
  }
  history_.time.push_back(now.time);
  for (size_t k = 0; k < wanted_.size(); ++k) {
    std::optional<Snapshot>& nearest = nearest_[k];
    if (!nearest || std::abs(now.time - wanted_[k].time) < std::abs(nearest->time - wanted_[k].time))
      nearest = now;
  }
}

std::vector<NamedSnapshot> Recorder::instants() const {
  std::vector<NamedSnapshot> seen;
  for (size_t k = 0; k < wanted_.size() && !history_.time.empty(); ++k) {
    if (wanted_[k].time >= history_.time.front() && wanted_[k].time <= history_.time.back())
      seen.push_back({wanted_[k].name, *nearest_[k]});
  }
  return seen;
}

json probes_json(const History& history) {
  json probes = json::object();
  for (const ProbeTrack& probe : history.probes) {
    if (!probe.place.empty())
      probes[probe.name] = {{"displacement", vector_json(probe.place.back() - probe.start)}};
  }
  for (const GripTrack& grip : history.grips) {
    if (!grip.force.empty())
      probes[grip.name] = {{"displacement", vector_json(grip.displacement.back())},
                           {"force", vector_json(grip.force.back())}};
  }
  return probes;
}

std::string probes_text(const History& history) {
  std::string text;
  const auto line = [&text](const std::string& what, const Eigen::Vector3d& v, const char* unit) {
    text += fmt::format("{} ({:.3f}, {:.3f}, {:.3f}) {}\n", what, v.x(), v.y(), v.z(), unit);
  };
  for (const ProbeTrack& probe : history.probes) {
    if (!probe.place.empty()) line(probe.name + " moved by", 1e3 * (probe.place.back() - probe.start), "mm");
  }
  for (const GripTrack& grip : history.grips) {
    if (grip.force.empty()) continue;
    line(grip.name + " moved by", 1e3 * grip.displacement.back(), "mm");
    line(grip.name + " pulls with", grip.force.back(), "N");
  }
  return text;
}

}  // namespace drapeplan
