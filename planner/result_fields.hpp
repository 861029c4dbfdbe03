// Names of what scores and reports hold, stated once for the evaluation log and for result files.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "fem/report.hpp"
#include "planner/score.hpp"

namespace drapeplan {

/// Calls visit(key, field) for every number of a score: one list for writing and reading.
template <class ScoreType, class Visit>
void for_each_part(ScoreType& s, const Visit& visit) {
  visit("max_separation", s.max_separation);
  visit("rms_separation", s.rms_separation);
  visit("wrinkled_area", s.wrinkled_area);
  visit("max_boundary_offset", s.max_boundary_offset);
  visit("rms_boundary_offset", s.rms_boundary_offset);
  visit("max_shear_deg", s.max_shear_deg);
  visit("max_fibre_strain", s.max_fibre_strain);
  visit("max_fibre_compression", s.max_fibre_compression);
  visit("max_actuator_force", s.max_actuator_force);
  visit("duration", s.duration);
  visit("objective", s.objective);
}

/// The same for energies.
template <class EnergiesType, class Visit>
void for_each_energy(EnergiesType& e, const Visit& visit) {
  visit("kinetic", e.kinetic);
  visit("internal", e.internal);
  visit("external", e.external);
  visit("friction", e.friction);
  visit("contact", e.contact);
  visit("damping", e.damping);
  visit("constraint", e.constraint);
  visit("hourglass", e.hourglass);
  visit("largest", e.largest);
  visit("balance_error", e.balance_error);
}

/// The same for the other doubles of a report.
template <class ReportType, class Visit>
void for_each_figure(ReportType& r, const Visit& visit) {
  visit("dt", r.dt);
  visit("simulated_time", r.simulated_time);
  visit("wall_seconds", r.wall_seconds);
  visit("element_updates_per_second", r.element_updates_per_second);
  visit("largest_kinetic_ratio", r.largest_kinetic_ratio);
  visit("largest_hourglass_share", r.largest_hourglass_share);
  visit("largest_penetration", r.largest_penetration);
  visit("largest_link_error", r.largest_link_error);
}

/// The words of RunStatus, in its order.
inline constexpr std::array<const char*, 3> kRunStatus{"done", "diverged", "paused"};

/// JSON has no infinity and no NaN: null stands for every number that is not finite.
inline nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

inline std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

inline nlohmann::json score_json(const Score& score) {
  nlohmann::json out;
  for_each_part(score, [&](const char* key, double value) {
    out[key] = score.valid ? finite(value) : nlohmann::json(nullptr);  // a failed run has no parts
  });
  out["objective"] = finite(score.objective);
  out["valid"] = score.valid;
  if (!score.valid) out["reason"] = score.reason;
  return out;
}

inline nlohmann::json report_json(const RunReport& report) {
  nlohmann::json out, energy;
  for_each_figure(report, [&](const char* key, double value) { out[key] = finite(value); });
  for_each_energy(report.energy, [&](const char* key, double value) { energy[key] = finite(value); });
  out["energy"] = energy;
  out["status"] = kRunStatus[size_t(report.status)];
  out["message"] = report.message;
  out["steps"] = report.steps;
  out["state_hash"] = hex(report.state_hash);
  return out;
}

}  // namespace drapeplan
