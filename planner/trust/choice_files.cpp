// The choice of numerical settings as people and programs see it.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "planner/base/parallel.hpp"
#include "planner/base/text.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/trust/choice.hpp"

namespace drapeplan {
namespace {

const char* knob_name(const Level& level) {
  if (level.knob == &FemOptions::time_scaling) return "time_scaling";
  if (level.knob == &FemOptions::fibre_mass_scaling) return "fibre_mass_scaling";
  return level.knob ? "mesh_size" : "rates";
}

}  // namespace

std::string choice_table(const FidelityChoice& choice, const OptimiseOptions& optimise, int threads) {
  const bool timed = optimise.evaluations == 0;
  std::string text =
      fmt::format("  numerics: chosen from {} runs in {:.0f} s\n    {:<10}{:<40}{:>10}{:>8}{:>10}",
                  choice.runs, choice.seconds, "fidelity", "setting", "error [%]", "ranks", "run [s]");
  text += timed ? "   runs in the budget\n" : "\n";
  for (const ChosenFidelity& one : choice.chosen) {
    text += fmt::format("    {:<10}{:<40}{:>10}{:>8}{:>10}", one.name, setting_text(one.options),
                        fixed(1e2 * one.error, 1), fixed(one.ranks, 2), fixed(one.seconds, 1));
    text += timed ? fmt::format("{:>21}\n", std::max(0, int((optimise.budget - choice.seconds) / one.seconds *
                                                            thread_count(threads))))
                  : "\n";
  }
  if (!choice.ranked_against.empty()) text += fmt::format("    (ranks: against {})\n", choice.ranked_against);
  if (!choice.message.empty()) text += "    " + choice.message + "\n";
  return text;
}

nlohmann::json choice_json(const FidelityChoice& choice) {
  nlohmann::json levels = nlohmann::json::array(), chosen = nlohmann::json::array();
  for (const Level& level : choice.levels) {
    levels.push_back({{"knob", knob_name(level)},
                      {"setting", setting_text(level.options)},
                      {"error", finite(level.error)},
                      {"objective_error", finite(level.objective_error)},
                      {"element_updates", level.updates},
                      {"seconds", level.seconds},
                      {"most_careful", level.careful}});
  }
  for (const ChosenFidelity& one : choice.chosen) {
    chosen.push_back({{"fidelity", one.name},
                      {"setting", setting_text(one.options)},
                      {"error", one.error},
                      {"objective_error", one.objective_error},
                      {"ranks", finite(one.ranks)},
                      {"seconds", one.seconds}});
  }
  return {
      {"chosen", std::move(chosen)}, {"levels", std::move(levels)}, {"ranked_against", choice.ranked_against},
      {"runs", choice.runs},         {"seconds", choice.seconds},   {"message", choice.message}};
}

FidelityChoice choice_from(const nlohmann::json& value, const std::map<std::string, FemOptions>& fidelities) {
  FidelityChoice choice;
  for (const nlohmann::json& one : value.at("chosen")) {
    const std::string name = one.at("fidelity").get<std::string>();
    choice.chosen.push_back({.name = name,
                             .options = fidelities.at(name),
                             .error = one.at("error").get<double>(),
                             .objective_error = one.at("objective_error").get<double>(),
                             .ranks = number_or(one.at("ranks"), std::numeric_limits<double>::quiet_NaN()),
                             .seconds = one.at("seconds").get<double>()});
  }
  choice.ranked_against = value.at("ranked_against").get<std::string>();
  choice.runs = value.at("runs").get<int>();
  choice.seconds = value.at("seconds").get<double>();
  choice.message = value.at("message").get<std::string>();
  return choice;
}

}  // namespace drapeplan
