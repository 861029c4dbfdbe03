#include "planner/study/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/base/statistics.hpp"
#include "planner/base/text.hpp"
#include "planner/drape/result_fields.hpp"
#include "planner/study/charts.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

std::string words(const Settings& settings) {
  std::string text;
  for (const auto& [path, value] : settings)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", path.substr(path.find('.') + 1), value);
  return text.empty() ? "the base" : text;
}

std::string row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string head(const std::vector<std::string>& cells) {
  std::string rule = "|";
  for (size_t k = 0; k < cells.size(); ++k) rule += "---|";
  return row(cells) + rule + "\n";
}

/// Three significant digits; an en dash for what is not finite.
std::string short_number(double value) {
  if (!std::isfinite(value)) return "\u2013";
  return fmt::format("{:.3g}", value);
}

std::string reference_text(const Study& study) {
  double seconds = 0;
  for (const StudyRun& run : study.reference_runs) seconds += run.cpu_seconds;
  const std::string text = fmt::format(
      "The base is the case's `fem` section{}. Reference: {}, all else as in the base; {} s per run.\n\n"
      "What is left in it, from the sweeps: ",
      study.at.empty() ? "" : " with " + words(study.at), words(study.reference),
      short_number(seconds / double(std::max<size_t>(study.reference_runs.size(), 1))));
  std::string rest;
  for (const StudyPoint& point : study.points) {
    if (point.curve == "mesh size" && point.valid() && rest.empty())
      rest = fmt::format("a mesh of {} differs by {} %", point.settings.begin()->second,
                         short_number(1e2 * error_of(point, "relative")));
  }
  for (const auto& [curve, error] : study.base_error) {
    if (curve == "mesh size" || curve == "rates") continue;  // stated before; other physics
    rest += fmt::format("; the base's {} differs from the most careful by {} %", curve,
                        short_number(1e2 * error));
  }
  return text + rest + ".\n\n";
}

std::string points_text(const Study& study) {
  const std::vector<StudyColumn> columns = study_columns(study);
  std::vector<std::string> cells{"curve", "setting", "time [s]", "10^6 updates", "steps", "step [us]"};
  for (const StudyColumn& column : columns) cells.push_back(column.head);
  cells.insert(cells.end(), {"balance", "kinetic ratio", "front"});
  std::string text = head(cells);
  const std::vector<int> front = study_front(study, "relative");
  for (size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    cells = {point.curve, words(point.settings)};
    if (!point.valid()) {
      const auto failed =
          std::find_if(point.runs.begin(), point.runs.end(), [](const auto& r) { return !r.valid; });
      std::string reason = failed == point.runs.end() ? "no reference" : failed->reason;
      std::replace_if(
          reason.begin(), reason.end(), [](char c) { return c == '\n' || c == '|'; }, ' ');
      cells.push_back(reason);
      text += row(cells);
      continue;
    }
    for (const double value :
         {point.mean(&StudyRun::cpu_seconds), 1e-6 * point.mean(&StudyRun::element_updates),
          point.mean(&StudyRun::steps), 1e6 * point.mean(&StudyRun::dt)})
      cells.push_back(short_number(value));
    for (const StudyColumn& column : columns)
      cells.push_back(short_number(column.factor * error_of(point, column.name)));
    for (const double value : {point.mean(&StudyRun::balance_error), point.mean(&StudyRun::kinetic_ratio)})
      cells.push_back(short_number(value));
    cells.push_back(std::find(front.begin(), front.end(), int(k)) == front.end() ? "" : "x");
    text += row(cells);
  }
  return text;
}

std::string cheapest_text(const Study& study) {
  std::string text = head({"error below [%]", "cheapest setting", "time [s]", "error [%]"});
  for (const double limit : {30.0, 10.0, 5.0, 3.0, 2.0, 1.0, 0.3, 0.1}) {
    const StudyPoint* best = nullptr;
    for (const int k : study_front(study, "relative")) {
      const StudyPoint& point = study.points[size_t(k)];
      if (1e2 * error_of(point, "relative") <= limit && best == nullptr) best = &point;
    }
    if (best == nullptr) {
      text += row({short_number(limit), "none", "", ""});
    } else {
      text +=
          row({short_number(limit), words(best->settings), short_number(best->mean(&StudyRun::cpu_seconds)),
               short_number(1e2 * error_of(*best, "relative"))});
    }
  }
  return text;
}

std::string orders_text(const Study& study) {
  const std::vector<StudyColumn> columns = study_columns(study);
  std::vector<std::string> cells{"knob"};
  for (const StudyColumn& column : columns) cells.push_back(column.head.substr(0, column.head.find(" [")));
  std::string text = head(cells);
  for (const auto& [curve, orders] : orders_of(study)) {
    cells = {curve};
    for (const StudyColumn& column : columns)
      cells.push_back(orders.count(column.name) > 0 ? short_number(orders.at(column.name)) : "\u2013");
    text += row(cells);
  }
  return text;
}

std::string ranks_text(const Study& study) {
  std::string text = head({"fidelity", "setting", "time [s]", "Spearman", "Kendall", "schedules"});
  for (const RankRow& r : study.ranks)
    text += row({r.name, words(r.settings), short_number(r.cpu_seconds), fixed(r.spearman, 3),
                 fixed(r.kendall, 3), fmt::to_string(r.compared)});
  return text;
}

std::string parts_text(const Study& study) {
  std::string text;
  if (!study.ranks.empty()) {
    text += fmt::format("\n## Ranks of {} schedules, against {}\n\n{}", study.schedules, study.rank_reference,
                        ranks_text(study));
  }
  if (!study.noise.empty()) {
    text += "\n## Noise of the objective\n\n" +
            head({"fidelity", "setting", "objective", "noise", "noise [%]", "levels agree"});
    for (const NoiseRow& n : study.noise)
      text += row({n.name, words(n.settings), fixed(n.objective, 3), short_number(n.noise),
                   short_number(1e2 * n.noise / n.objective), n.consistent ? "yes" : "no"});
  }
  if (!study.mapping.empty()) {
    text += "\n## Mapping, against the finest\n\n" +
            head({"cell [mm]", "wall [ms]", "targets [um]", "places r.m.s. [um]",
                  "error of the largest shear [deg]"});
    for (const MappingRow& m : study.mapping)
      text +=
          row({short_number(1e3 * m.cell_size), short_number(1e3 * m.wall_seconds),
               short_number(1e6 * m.targets), short_number(1e6 * m.places), short_number(m.max_shear_deg)});
    std::vector<double> sizes, errors;
    for (const MappingRow& m : study.mapping) sizes.push_back(m.cell_size), errors.push_back(m.places);
    text += fmt::format("\nObserved order of the places: {}\n",
                        short_number(observed_order(sizes, errors, sizes.front())));
  }
  if (!study.reach.empty()) {
    text += "\n## Reach, against the most starts\n\n" +
            head({"random starts", "wall [ms]", "floor r.m.s. [mm]", "error [um]", "floor max [mm]",
                  "error [um]", "link violation [m]"});
    for (const ReachRow& r : study.reach)
      text += row({fmt::to_string(r.starts), short_number(1e3 * r.wall_seconds), fixed(1e3 * r.floor_rms, 4),
                   short_number(1e6 * r.floor_rms_error), fixed(1e3 * r.floor_max, 4),
                   short_number(1e6 * r.floor_max_error), short_number(r.link_violation)});
  }
  return text;
}

std::string fidelities_text(const Study& study) {
  const std::map<std::string, Settings> chosen = chosen_fidelities(study);
  if (chosen.empty()) return "";
  std::string text = "\n## Fidelities that follow\n\n";
  for (const auto& [name, settings] : chosen) text += fmt::format("- `{}`: {}\n", name, words(settings));
  return text;
}

json settings_json(const Settings& settings) {
  json out = json::object();
  for (const auto& [path, value] : settings) out[path] = value;
  return out;
}

json point_json(const StudyPoint& point) {
  json out{{"curve", point.curve}, {"settings", settings_json(point.settings)}, {"valid", point.valid()}};
  out["wall_seconds"] = finite(point.mean(&StudyRun::wall_seconds));
  out["cpu_seconds"] = finite(point.mean(&StudyRun::cpu_seconds));
  out["element_updates"] = finite(point.mean(&StudyRun::element_updates));
  out["steps"] = point.mean(&StudyRun::steps);
  out["dt"] = point.mean(&StudyRun::dt);
  out["balance_error"] = finite(point.mean(&StudyRun::balance_error));
  out["kinetic_ratio"] = finite(point.mean(&StudyRun::kinetic_ratio));
  for (const StudyRun& run : point.runs) {
    if (!run.valid) out["reason"] = run.reason;
  }
  for (const auto& [name, value] : point.error) out["error"][name] = finite(value);
  for (const auto& [name, value] : point.knob_error) out["knob_error"][name] = finite(value);
  return out;
}

std::string points_csv(const Study& study) {
  std::string text =
      "curve,settings,valid,wall_s,cpu_s,element_updates,steps,dt_s,balance_error,kinetic_ratio";
  const std::vector<StudyColumn> columns = study_columns(study);
  for (const StudyColumn& column : columns) text += ",error_" + column.name;
  text += "\n";
  for (const StudyPoint& point : study.points) {
    text += fmt::format("{},\"{}\",{}", point.curve, words(point.settings), point.valid() ? 1 : 0);
    for (const double value :
         {point.mean(&StudyRun::wall_seconds), point.mean(&StudyRun::cpu_seconds),
          point.mean(&StudyRun::element_updates), point.mean(&StudyRun::steps), point.mean(&StudyRun::dt),
          point.mean(&StudyRun::balance_error), point.mean(&StudyRun::kinetic_ratio)})
      text += "," + exact(value);
    for (const StudyColumn& column : columns) {
      const double error = error_of(point, column.name);
      text += "," + (std::isfinite(error) ? exact(error) : "");
    }
    text += "\n";
  }
  return text;
}

std::string ranks_csv(const Study& study) {
  std::string text = "fidelity,settings,cpu_s,spearman,kendall,objectives\n";
  for (const RankRow& r : study.ranks) {
    text += fmt::format("{},\"{}\",{},{},{},\"", r.name, words(r.settings), exact(r.cpu_seconds),
                        exact(r.spearman), exact(r.kendall));
    for (size_t k = 0; k < r.objectives.size(); ++k)
      text += (k > 0 ? " " : "") + (std::isfinite(r.objectives[k]) ? fixed(r.objectives[k], 4) : "-");
    text += "\"\n";
  }
  return text;
}

}  // namespace

json study_json(const Study& study) {
  json out{{"case", study.case_name},      {"base", settings_json(study.at)},   {"points", json::array()},
           {"fidelities", json::object()}, {"rank_correlation", json::array()}, {"noise", json::array()}};
  out["reference"] = {{"settings", settings_json(study.reference)}, {"runs", json::array()}};
  for (const auto& [curve, error] : study.base_error) out["reference"]["left"][curve] = finite(error);
  for (const StudyRun& run : study.reference_runs) {
    json figures;
    for (const auto& [name, value] : run.figures) figures[name] = finite(value);
    out["reference"]["runs"].push_back({{"valid", run.valid},
                                        {"reason", run.reason},
                                        {"wall_seconds", run.wall_seconds},
                                        {"figures", figures}});
  }
  for (const StudyPoint& point : study.points) out["points"].push_back(point_json(point));
  for (const auto& [name, settings] : chosen_fidelities(study))
    out["fidelities"][name] = settings_json(settings);
  for (const auto& [curve, orders] : orders_of(study)) {
    for (const auto& [name, order] : orders) out["orders"][curve][name] = finite(order);
  }
  for (const RankRow& r : study.ranks) {
    out["rank_correlation"].push_back({{"name", r.name},
                                       {"settings", settings_json(r.settings)},
                                       {"wall_seconds", finite(r.wall_seconds)},
                                       {"cpu_seconds", finite(r.cpu_seconds)},
                                       {"spearman", finite(r.spearman)},
                                       {"kendall", finite(r.kendall)},
                                       {"schedules", r.compared}});
  }
  for (const NoiseRow& n : study.noise) {
    out["noise"].push_back({{"name", n.name},
                            {"settings", settings_json(n.settings)},
                            {"objective", finite(n.objective)},
                            {"noise", finite(n.noise)},
                            {"levels_agree", n.consistent}});
  }
  for (const MappingRow& m : study.mapping) {
    out["mapping"].push_back(
        {{"cell_size", m.cell_size},
         {"wall_seconds", m.wall_seconds},
         {"error", {{"targets", m.targets}, {"places", m.places}, {"max_shear_deg", m.max_shear_deg}}}});
  }
  for (const ReachRow& r : study.reach) {
    out["reach"].push_back(
        {{"random_starts", r.starts},
         {"wall_seconds", r.wall_seconds},
         {"floor_rms", finite(r.floor_rms)},
         {"floor_max", finite(r.floor_max)},
         {"error", {{"floor_rms", finite(r.floor_rms_error)}, {"floor_max", finite(r.floor_max_error)}}},
         {"link_violation", finite(r.link_violation)}});
  }
  for (const SearchTrace& trace : study.searches) {
    out["searches"].push_back({{"name", trace.name},
                               {"evaluations", trace.evaluations},
                               {"seconds", trace.seconds},
                               {"best", trace.best}});
  }
  return out;
}

std::string study_text(const Study& study) {
  std::string text = fmt::format("# Study of {}\n\n", study.case_name);
  if (!study.points.empty()) {
    text += fmt::format(
        "{}## Work and precision\n\nErrors against the reference, the largest of the baselines. Times are "
        "of one run on one core (processor time).\n\n{}\n## Cheapest settings\n\n{}\n## Observed orders\n\n"
        "Of the mesh against the reference, of other knobs against their most careful value.\n\n{}",
        reference_text(study), points_text(study), cheapest_text(study), orders_text(study));
  }
  return text + parts_text(study) + fidelities_text(study);
}

void write_study(const std::filesystem::path& folder, const Study& study) {
  write_text(folder / "study.md", study_text(study));
  if (!study.points.empty()) write_text(folder / "points.csv", points_csv(study));
  if (!study.ranks.empty()) write_text(folder / "ranks.csv", ranks_csv(study));
  for (const auto& [name, svg] : study_charts(study)) write_text(folder / (name + ".svg"), svg);
}

}  // namespace drapeplan
