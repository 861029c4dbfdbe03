// Outcomes of stress scenes as JSON, for programs and for people.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/base/text.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/stress/stress.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

json maybe(const std::optional<double>& value) {
  return value ? finite(*value) : json(nullptr);
}

std::optional<double> true_over_estimated(const StressOutcome& o) {
  if (!o.true_step || !o.estimated_step) return std::nullopt;
  const double ratio = *o.true_step / *o.estimated_step;
  return std::isfinite(ratio) ? std::optional(ratio) : std::nullopt;
}

/// Empty where there is no finite value. @param format  of fmt, for a double.
std::string cell(const std::optional<double>& value, fmt::string_view format) {
  if (!value || !std::isfinite(*value)) return "";
  return fmt::format(fmt::runtime(format), *value);
}

template <class Field>
std::optional<double> of_summary(const StressOutcome& o, const Field& field) {
  return o.summary ? std::optional<double>(field(*o.summary)) : std::nullopt;
}

std::optional<double> balance_of(const StressOutcome& o) {
  return of_summary(o, [](const RunSummary& r) { return r.energy.balance_error; });
}
std::optional<double> kinetic_ratio_of(const StressOutcome& o) {
  return of_summary(o, [](const RunSummary& r) { return r.largest_kinetic_ratio; });
}

json outcome_json(const StressOutcome& o) {
  json checks = json::array();
  for (const StressCheck& c : o.checks) {
    checks.push_back({{"what", c.what},
                      {"value", finite(c.value)},
                      {"least", finite(c.least)},
                      {"most", finite(c.most)},
                      {"holds", c.holds()}});
  }
  json entry = {{"name", o.name},
                {"group", o.group},
                {"verdict", verdict_name(o.verdict)},
                {"reason", o.reason},
                {"elements", o.elements},
                {"balance_error", maybe(balance_of(o))},
                {"kinetic_ratio", maybe(kinetic_ratio_of(o))},
                {"drift", maybe(o.drift)},
                {"estimated_step", maybe(o.estimated_step)},
                {"true_step", maybe(o.true_step)},
                {"true_over_estimated_step", maybe(true_over_estimated(o))},
                {"limit_over_estimated_step", maybe(o.limit_over_estimate)},
                {"wall_seconds", o.wall_seconds},
                {"checks", std::move(checks)}};
  entry["steps"] = o.summary ? json(o.summary->steps) : json(nullptr);
  entry["dt"] = o.summary ? finite(o.summary->dt) : json(nullptr);
  return entry;
}

size_t count(const std::vector<StressOutcome>& outcomes, Verdict verdict) {
  return size_t(std::count_if(outcomes.begin(), outcomes.end(),
                              [verdict](const StressOutcome& o) { return o.verdict == verdict; }));
}

}  // namespace

json stress_json(const std::vector<StressOutcome>& outcomes) {
  json scenes = json::array(), failures = json::array(), verdicts = json::object();
  for (const StressOutcome& o : outcomes) {
    scenes.push_back(outcome_json(o));
    if (o.verdict == Verdict::wrong) failures.push_back(fmt::format("{}: {}", o.group, o.name));
  }
  for (const Verdict v : {Verdict::right, Verdict::refused, Verdict::stopped, Verdict::wrong})
    verdicts[verdict_name(v)] = count(outcomes, v);
  return {
      {"scenes", std::move(scenes)}, {"failures", std::move(failures)}, {"verdicts", std::move(verdicts)}};
}

std::string stress_csv(const std::vector<StressOutcome>& outcomes) {
  std::string text =
      "group,scene,verdict,balance_error,kinetic_ratio,drift_m,true_over_estimated_step,"
      "limit_over_estimated_step,steps,dt_s,elements,reason\n";
  for (const StressOutcome& o : outcomes) {
    const std::optional<double> dt = of_summary(o, [](const RunSummary& r) { return r.dt; });
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted_cell(o.group), quoted_cell(o.name), verdict_name(o.verdict),
        cell(balance_of(o), "{:.2e}"), cell(kinetic_ratio_of(o), "{:.3g}"), cell(o.drift, "{:.2e}"),
        cell(true_over_estimated(o), "{:.4f}"), cell(o.limit_over_estimate, "{:.3f}"),
        o.summary ? fmt::to_string(o.summary->steps) : "", cell(dt, "{:.4g}"), o.elements, quoted_cell(o.reason));
  }
  return text;
}

std::string stress_markdown(const std::vector<StressOutcome>& outcomes) {
  std::string text = "# Stability of stiff and extreme scenes\n\n";
  text += fmt::format("{} scenes: ", outcomes.size());
  for (const Verdict v : {Verdict::right, Verdict::refused, Verdict::stopped, Verdict::wrong}) {
    text += fmt::format("{} {}{}", count(outcomes, v), verdict_name(v), v == Verdict::wrong ? ".\n" : ", ");
  }
  text +=
      "Balance: largest error of the books over the largest energy. Kinetic: largest ratio of the ply's\n"
      "kinetic to its internal energy. Drift: r.m.s. motion of the nodes in the last tenth of a run that\n"
      "ends at rest. Step: true over estimated stable step at the end; in brackets the step at which runs\n"
      "become unstable, by bisection, over the estimate.\n";
  std::string group;
  for (const StressOutcome& o : outcomes) {
    if (o.group != group) {
      group = o.group;
      text += fmt::format(
          "\n## {}\n\n| scene | verdict | measured, or why | balance | kinetic | drift [m] | step |\n"
          "|---|---|---|---|---|---|---|\n",
          group);
    }
    const std::string limit = cell(o.limit_over_estimate, " ({:.2f})");
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {}{} |\n", markdown_cell(o.name),
                        o.verdict == Verdict::wrong ? "**wrong**" : verdict_name(o.verdict),
                        markdown_cell(o.reason), cell(balance_of(o), "{:.0e}"), cell(kinetic_ratio_of(o), "{:.2g}"),
                        cell(o.drift, "{:.0e}"), cell(true_over_estimated(o), "{:.2f}"), limit);
  }
  return text;
}

}  // namespace drapeplan
