#include "planner/trust/spread.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "planner/base/parallel.hpp"
#include "planner/case/fields.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/search/batch_evaluate.hpp"
#include "planner/search/interrupted.hpp"

namespace drapeplan {
namespace {

constexpr const char* kUndisturbed = "none";  // in results

/// All times of the schedule.
void stretch(Schedule& schedule, double factor) {
  for (std::vector<Knot>& path : schedule.paths) {
    for (Knot& knot : path) knot.time *= factor;
  }
  for (std::vector<PlaneKnot>& path : schedule.plane_paths) {
    for (PlaneKnot& knot : path) knot.time *= factor;
  }
  for (std::optional<double>& time : schedule.release) {
    if (time) *time *= factor;
  }
}

/// Places of the joints, where the schedule commands them: they are the rig's.
void move(Schedule& schedule, const std::function<void(Eigen::Vector2d&)>& change) {
  for (std::vector<PlaneKnot>& path : schedule.plane_paths) {
    for (PlaneKnot& knot : path) change(knot.xy);
  }
}

Outcome drape(const DrapeProblem& problem, const Disturbance& disturbance, Schedule schedule,
              const std::string& fidelity) {
  Case plant = problem.definition();  // with the lengths that its interlinks have
  disturbance.apply(plant, schedule);
  const Model model = model_of(plant, plant.fidelities.at(fidelity));
  return outcome_of(problem.run_on(model, schedule));
}

/// Smallest, mean and largest value of a part of the score over all plants in which the drape ran to its end.
nlohmann::json range_of(const PlantSpread& spread, Score DisturbedPair::*schedule, double Score::*part) {
  double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0;
  int count = 0;
  for (const DisturbedPair& pair : spread.pairs) {
    if (!(pair.*schedule).valid) continue;
    const double value = pair.*schedule.*part;
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    ++count;
  }
  return {{"least", finite(least)}, {"mean", finite(sum / count)}, {"worst", finite(most)}};
}

}  // namespace

std::vector<Disturbance> disturbances(const Case& definition) {
  std::vector<Disturbance> list{{"", [](Case&, Schedule&) {}}};
  for (const double sign : {1.0, -1.0}) {
    const char* mark = sign > 0 ? "+" : "-";
    const auto add = [&](const std::string& name, std::function<void(Case&, Schedule&)> apply) {
      list.push_back({name, std::move(apply)});
    };
    if (definition.friction) {
      add(fmt::format("friction {} {:.0f} %", mark, 1e2 * kFrictionSpread),
          [sign](Case& plant, Schedule&) { *plant.friction *= 1 + sign * kFrictionSpread; });
    }
    for (const int axis : {0, 1}) {
      add(fmt::format("rig {} {:.0f} mm in {}", mark, 1e3 * kPlacementSpread, axis == 0 ? "x" : "y"),
          [sign, axis](Case& plant, Schedule& schedule) {
            plant.ply.position[axis] += sign * kPlacementSpread;
            move(schedule, [&](Eigen::Vector2d& xy) { xy[axis] += sign * kPlacementSpread; });
          });
    }
    add(fmt::format("rig turned by {} {:.0f} deg", mark, kAngleSpreadDeg), [sign](Case& plant,
                                                                                  Schedule& schedule) {
      const double turn = sign * kAngleSpreadDeg * std::numbers::pi / 180;
      plant.ply.angle += turn;
      const Eigen::Vector2d centre = plant.ply.position;
      move(schedule, [&](Eigen::Vector2d& xy) { xy = centre + Eigen::Rotation2Dd(turn) * (xy - centre); });
    });
    add(fmt::format("shear stress {} {:.0f} %", mark, 1e2 * kShearSpread),
        [sign](Case& plant, Schedule&) {
          for (Curve& curve : plant.material.shear.curves) curve = scaled(curve, 1 + sign * kShearSpread);
        });
    add(fmt::format("joints {} {:.1f} mm", mark, 1e3 * kJointSpread), [sign](Case& plant, Schedule&) {
      plant.grippers->joint_offset = std::max(0.0, plant.grippers->joint_offset + sign * kJointSpread);
    });
    add(fmt::format("times {} {:.0f} %", mark, 1e2 * kTimingSpread),
        [sign](Case&, Schedule& schedule) { stretch(schedule, 1 + sign * kTimingSpread); });
  }
  return list;
}

int PlantSpread::better() const {
  return int(
      std::count_if(pairs.begin() + 1, pairs.end(), [](const DisturbedPair& pair) { return pair.better(); }));
}

std::optional<PlantSpread> spread_of(const DrapeProblem& problem, const Schedule& best,
                                     const Schedule& baseline, const std::vector<std::string>& fidelities,
                                     const SideRuns& runs, EvaluationLog& log) {
  const std::vector<Disturbance> list = disturbances(problem.definition());
  // Both schedules in each plant, one after the other: the undisturbed pair tells what all will take.
  const auto evaluate = [&](const std::string& fidelity, size_t from, size_t to) {
    std::vector<Outcome> outcomes(to - from);
    std::vector<char> finished(outcomes.size(), 0);
    const auto schedule_of = [&](size_t k) -> const Schedule& {
      return (from + k) % 2 == 0 ? best : baseline;
    };
    // In the log a plant is a fidelity of its own: its objectives are not those of the case.
    const auto name_of = [&](size_t k) {
      const std::string& plant = list[(from + k) / 2].name;
      return plant.empty() ? fidelity : fidelity + ", " + plant;
    };
    const auto write = [&] {
      for (size_t k = 0; k < outcomes.size(); ++k) {
        if (finished[k] && !outcomes[k].cached)
          log.write(candidate_hash(runs.design, schedule_of(k)), name_of(k), "spread", outcomes[k]);
      }
    };
    const auto one = [&](int i) {
      const auto k = size_t(i);
      if (runs.stop && runs.stop()) throw Interrupted();
      outcomes[k] = log.evaluate_once(candidate_hash(runs.design, schedule_of(k)), name_of(k), [&] {
        return scored([&] { return drape(problem, list[(from + k) / 2], schedule_of(k), fidelity); });
      });
      finished[k] = 1;
    };
    try {
      parallel_for(int(outcomes.size()), one, runs.threads);
    } catch (...) {
      write();
      throw;
    }
    write();
    return outcomes;
  };
  const size_t count = 2 * list.size();
  PlantSpread spread;
  std::vector<Outcome> outcomes;
  for (auto name = fidelities.rbegin(); name != fidelities.rend() && spread.fidelity.empty(); ++name) {
    outcomes = evaluate(*name, 0, 2);
    const double each = 0.5 * (outcomes[0].wall_seconds + outcomes[1].wall_seconds);
    if (runs.seconds <= 0 || double(count) * each <= runs.seconds * thread_count(runs.threads))
      spread.fidelity = *name;
  }
  if (spread.fidelity.empty()) return {};
  const std::vector<Outcome> others = evaluate(spread.fidelity, 2, count);
  outcomes.insert(outcomes.end(), others.begin(), others.end());
  for (size_t k = 0; k < list.size(); ++k)
    spread.pairs.push_back({list[k].name, outcomes[2 * k].score, outcomes[2 * k + 1].score});
  return spread;
}

Worth worth_of(const PlantSpread& spread, Choose rule) {
  Worth worth{0, rule == Choose::mean ? 0 : -std::numeric_limits<double>::infinity()};
  const size_t counting = rule == Choose::nominal ? 1 : spread.pairs.size();
  int runs = 0;
  for (size_t k = 0; k < counting; ++k) {
    const Score& best = spread.pairs[k].best;
    if (!best.valid) {
      ++worth.failures;
      continue;
    }
    ++runs;
    worth.value = rule == Choose::mean ? worth.value + best.objective : std::max(worth.value, best.objective);
  }
  if (rule == Choose::mean && runs > 0) worth.value /= runs;
  return worth;
}

const char* name_of(Choose rule) {
  return rule == Choose::mean ? "mean" : rule == Choose::worst ? "worst" : "nominal";
}

std::string spread_text(const PlantSpread& spread) {
  const bool is_baseline =
      std::all_of(spread.pairs.begin(), spread.pairs.end(),
                  [](const DisturbedPair& pair) { return pair.best.objective == pair.baseline.objective; });
  std::string worst, failed;
  int failures = 0;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const DisturbedPair& pair : spread.pairs) {
    const std::string name = pair.disturbance.empty() ? "nothing changed" : pair.disturbance;
    if (!pair.best.valid) {
      ++failures;
      failed = name + ": " + pair.best.reason;
      continue;
    }
    least = std::min(least, pair.best.objective);
    if (pair.best.objective > most) most = pair.best.objective, worst = name;
  }
  if (failures == int(spread.pairs.size()))
    return "it fails in every plant that differs, the last with " + failed;
  std::string text = fmt::format(
      "in {} plants that differ (friction, placement, shear, joints, times; at `{}`) its objective is {:.2f} "
      "to {:.2f}, "
      "worst with {}",
      spread.plants(), spread.fidelity, least, most, worst);
  if (failures > 0) text += fmt::format("; it fails in {}, the last with {}", failures, failed);
  if (!is_baseline)
    text += fmt::format("; it stays better than the better baseline in {} of them", spread.better());
  return text;
}

nlohmann::json spread_json(const PlantSpread& spread, Choose rule) {
  nlohmann::json plants = nlohmann::json::array();
  for (const DisturbedPair& pair : spread.pairs) {
    plants.push_back({{"disturbance", pair.disturbance.empty() ? kUndisturbed : pair.disturbance},
                      {"best", score_json(pair.best)},
                      {"baseline", score_json(pair.baseline)}});
  }
  nlohmann::json best, baseline;
  for (const ScorePart& part : kScoreParts) {
    if (!part.compared) continue;
    best[part.key] = range_of(spread, &DisturbedPair::best, part.value);
    baseline[part.key] = range_of(spread, &DisturbedPair::baseline, part.value);
  }
  return {{"fidelity", spread.fidelity},
          {"rule", rule == Choose::nominal
                       ? "the best is the candidate with the lowest objective in the undisturbed plant"
                   : rule == Choose::mean
                       ? "the best is the candidate with the lowest mean objective over all plants"
                       : "the best is the candidate with the lowest worst objective over all plants"},
          {"best", std::move(best)},
          {"baseline", std::move(baseline)},
          {"better_in", spread.better()},
          {"plants", spread.plants()},
          {"disturbed", std::move(plants)}};
}

PlantSpread spread_from(const nlohmann::json& value) {
  PlantSpread spread{.fidelity = value.at("fidelity").get<std::string>(), .pairs = {}};
  for (const nlohmann::json& plant : value.at("disturbed")) {
    const std::string name = plant.at("disturbance").get<std::string>();
    spread.pairs.push_back(
        {name == kUndisturbed ? "" : name, score_from(plant.at("best")), score_from(plant.at("baseline"))});
  }
  return spread;
}

}  // namespace drapeplan
