// Scores and summaries as JSON; the names of what a summary holds, stated once for writing and reading.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "fem/core/run_summary.hpp"
#include "planner/reach/floor.hpp"
#include "planner/score/score.hpp"

namespace drapeplan {

/// Calls visit(key, field, part) for every energy of a summary. `part` points to the member of SummaryParts
/// that says whether the scene has any of it; null: every scene does.
template <class Summary, class Visit>
void for_each_energy(Summary& r, const Visit& visit) {
  using Part = bool SummaryParts::*;
  auto& e = r.energy;
  visit("kinetic", e.kinetic, Part(nullptr));
  visit("internal", e.internal, Part(nullptr));
  visit("external", e.external, &SummaryParts::external);
  visit("friction", e.friction, &SummaryParts::friction);
  visit("contact", e.contact, &SummaryParts::contact);
  visit("damping", e.damping, &SummaryParts::damping);
  visit("constraint", e.constraint, &SummaryParts::constraint);
  visit("hourglass", e.hourglass, Part(nullptr));
  visit("largest", e.largest, Part(nullptr));
  visit("balance_error", e.balance_error, Part(nullptr));
}

/// The same for the other doubles of a summary.
template <class Summary, class Visit>
void for_each_figure(Summary& r, const Visit& visit) {
  using Part = bool SummaryParts::*;
  visit("dt", r.dt, Part(nullptr));
  visit("simulated_time", r.simulated_time, Part(nullptr));
  visit("wall_seconds", r.wall_seconds, Part(nullptr));
  visit("element_updates_per_second", r.element_updates_per_second, Part(nullptr));
  visit("largest_kinetic_ratio", r.largest_kinetic_ratio, Part(nullptr));
  visit("largest_hourglass_share", r.largest_hourglass_share, Part(nullptr));
  visit("largest_penetration", r.largest_penetration, &SummaryParts::contact);
  visit("largest_link_error", r.largest_link_error, &SummaryParts::links);
}

/// The words of RunStatus, in its order.
inline constexpr std::array<const char*, 3> kRunStatus{"done", "diverged", "paused"};

/// JSON has no infinity and no NaN: null stands for every number that is not finite.
inline nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

inline std::string hex(std::uint64_t value) {
  return fmt::format("{:016x}", value);
}

inline nlohmann::json score_json(const Score& score) {
  nlohmann::json out;
  for (const ScorePart& part : kScoreParts) {
    // A failed run has no parts.
    out[part.key] = score.valid ? finite(score.*part.value) : nlohmann::json(nullptr);
  }
  out["objective"] = finite(score.objective);
  out["valid"] = score.valid;
  out["followed"] = score.followed;
  if (!score.valid) out["reason"] = score.reason;
  return out;
}

/// A number that `finite` wrote. @param otherwise  what null stands for.
inline double number_or(const nlohmann::json& value, double otherwise) {
  return value.is_null() ? otherwise : value.get<double>();
}

/// What `score_json` wrote; parts that are null are NaN. @throws nlohmann::json::exception if it is no score.
inline Score score_from(const nlohmann::json& value) {
  Score score;
  for (const ScorePart& part : kScoreParts)
    score.*part.value = number_or(value.at(part.key), std::numeric_limits<double>::quiet_NaN());
  score.valid = value.at("valid").get<bool>();
  score.followed = value.at("followed").get<bool>();
  if (!score.valid) score.reason = value.at("reason").get<std::string>();
  return score;
}

/// The score of the ply as laid; where it was pressed, also that after pressing. Which one the objective
/// takes, the case says.
inline void add_scores(const Score& score, const std::optional<OtherScore>& other, nlohmann::json& out) {
  const bool takes_after = other && other->before;
  out["score"] = score_json(takes_after ? other->score : score);
  if (other) out["score_pressed"] = score_json(takes_after ? score : other->score);
}

/// Of a front of floors: one object per boundary tolerance, null for free.
inline nlohmann::json front_json(const FloorFront& front) {
  nlohmann::json list = nlohmann::json::array();
  for (const FloorPoint& point : front.points) {
    list.push_back({{"boundary_tolerance", finite(point.boundary_tolerance)},
                    {"gap_floor", finite(point.gap)},
                    {"rms_gap", finite(point.rms_gap)},
                    {"boundary_offset", finite(point.boundary_offset)},
                    {"converged", point.converged},
                    {"status", point.status}});
  }
  return list;
}

/// Without the figures of what the scene does not have.
inline nlohmann::json summary_json(const RunSummary& summary) {
  nlohmann::json out, energy;
  const auto write_to = [&summary](nlohmann::json& object) {
    return [&](const char* key, double value, bool SummaryParts::*part) {
      if (part == nullptr || summary.parts.*part) object[key] = finite(value);
    };
  };
  for_each_figure(summary, write_to(out));
  for_each_energy(summary, write_to(energy));
  out["energy"] = energy;
  out["status"] = kRunStatus[size_t(summary.status)];
  out["message"] = summary.message;
  out["steps"] = summary.steps;
  out["state_hash"] = hex(summary.state_hash);
  return out;
}

}  // namespace drapeplan
