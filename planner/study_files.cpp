#include "planner/study_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "planner/charts.hpp"
#include "planner/result_fields.hpp"
#include "planner/statistics.hpp"
#include "planner/text.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

std::string words(const Settings& settings) {
  std::string text;
  for (const auto& [path, value] : settings)
    text += (text.empty() ? "" : ", ") + path.substr(path.find('.') + 1) + " " + value;
  return text.empty() ? "as in the case" : text;
}

std::string row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

std::string head(const std::vector<std::string>& cells) {
  std::string rule = "|";
  for (size_t k = 0; k < cells.size(); ++k) rule += "---|";
  return row(cells) + rule + "\n";
}

/// Three significant digits; an en dash for what is not finite.
std::string short_number(double value) {
  if (!std::isfinite(value)) return "\u2013";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

double error_of(const StudyPoint& point, const std::string& name) {
  const auto found = point.error.find(name);
  return found == point.error.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

/// An error as tables show it: lengths in mm, shares in per cent.
struct Column {
  std::string name, head;
  double factor;
};

std::vector<Column> columns_of(const Study& study) {
  if (study.drapes) {
    return {{"separation", "gap [mm]", 1e3},
            {"boundary_offset", "offset [mm]", 1e3},
            {"relative", "larger of gap and offset [%]", 1e2},
            {"places", "nodes r.m.s. [mm]", 1e3},
            {"shear_deg", "shear r.m.s. [deg]", 1},
            {"objective", "objective", 1}};
  }
  return {{"relative", "largest relative [%]", 1e2},
          {"places", "nodes r.m.s. [mm]", 1e3},
          {"shear_deg", "shear r.m.s. [deg]", 1}};
}

std::vector<int> front_of(const Study& study, const std::string& error) {
  std::vector<double> cost, errors;
  for (const StudyPoint& point : study.points) {
    const bool numerical = std::all_of(point.settings.begin(), point.settings.end(),
                                       [](const auto& s) { return s.first.starts_with("fem."); });
    cost.push_back(point.valid() && numerical ? point.mean(&StudyRun::cpu_seconds)
                                              : std::numeric_limits<double>::infinity());
    errors.push_back(error_of(point, error));
  }
  return pareto_front(cost, errors);
}

std::string reference_text(const Study& study) {
  std::string text = "Reference: " + words(study.reference) + ", all else as in the case";
  double seconds = 0;
  for (const StudyRun& run : study.reference_runs) seconds += run.cpu_seconds;
  text += "; " + short_number(seconds / double(std::max<size_t>(study.reference_runs.size(), 1))) +
          " s per run.\n\nWhat is left in it, from the sweeps: ";
  std::string rest;
  for (const StudyPoint& point : study.points) {
    if (point.curve == "mesh size" && point.valid() && rest.empty())
      rest = "a mesh of " + point.settings.begin()->second + " differs by " +
             short_number(1e2 * error_of(point, "relative")) + " %";
  }
  for (const auto& [curve, error] : study.base_error) {
    if (curve == "mesh size" || curve == "rates") continue;  // stated before; other physics
    rest += "; the case's " + curve + " differs from the most careful by " + short_number(1e2 * error) + " %";
  }
  return text + rest + ".\n\n";
}

std::string points_text(const Study& study) {
  const std::vector<Column> columns = columns_of(study);
  std::vector<std::string> cells{"curve", "setting", "time [s]", "10^6 updates", "steps", "step [us]"};
  for (const Column& column : columns) cells.push_back(column.head);
  cells.insert(cells.end(), {"balance", "kinetic ratio", "front"});
  std::string text = head(cells);
  const std::vector<int> front = front_of(study, "relative");
  for (size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    cells = {point.curve, words(point.settings)};
    if (!point.valid()) {
      const auto failed =
          std::find_if(point.runs.begin(), point.runs.end(), [](const auto& r) { return !r.valid; });
      cells.push_back(failed == point.runs.end() ? "no reference" : failed->reason);
      text += row(cells);
      continue;
    }
    for (const double value :
         {point.mean(&StudyRun::cpu_seconds), 1e-6 * point.mean(&StudyRun::element_updates),
          point.mean(&StudyRun::steps), 1e6 * point.mean(&StudyRun::dt)})
      cells.push_back(short_number(value));
    for (const Column& column : columns)
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
    for (const int k : front_of(study, "relative")) {
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
  const std::vector<Column> columns = columns_of(study);
  std::vector<std::string> cells{"knob"};
  for (const Column& column : columns) cells.push_back(column.head.substr(0, column.head.find(" [")));
  std::string text = head(cells);
  for (const auto& [curve, orders] : orders_of(study)) {
    cells = {curve};
    for (const Column& column : columns)
      cells.push_back(orders.count(column.name) > 0 ? short_number(orders.at(column.name)) : "\u2013");
    text += row(cells);
  }
  return text;
}

std::string ranks_text(const Study& study) {
  std::string text = head({"fidelity", "setting", "time [s]", "Spearman", "Kendall", "schedules"});
  for (const RankRow& r : study.ranks)
    text += row({r.name, words(r.settings), short_number(r.cpu_seconds), fixed(r.spearman, 3),
                 fixed(r.kendall, 3), std::to_string(r.compared)});
  return text;
}

std::string parts_text(const Study& study) {
  std::string text;
  if (!study.ranks.empty()) {
    text += "\n## Ranks of " + std::to_string(study.schedules) + " schedules, against " +
            study.rank_reference + "\n\n" + ranks_text(study);
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
            head({"cell [mm]", "wall [ms]", "targets [um]", "places r.m.s. [um]", "largest shear [deg]"});
    for (const MappingRow& m : study.mapping)
      text +=
          row({short_number(1e3 * m.cell_size), short_number(1e3 * m.wall_seconds),
               short_number(1e6 * m.targets), short_number(1e6 * m.places), short_number(m.max_shear_deg)});
    std::vector<double> sizes, errors;
    for (const MappingRow& m : study.mapping) sizes.push_back(m.cell_size), errors.push_back(m.places);
    text += "\nObserved order of the places: " + short_number(observed_order(sizes, errors, sizes.front())) +
            "\n";
  }
  if (!study.reach.empty()) {
    text += "\n## Reach, against the most starts\n\n" +
            head({"random starts", "wall [ms]", "floor r.m.s. [mm]", "error [um]", "floor max [mm]",
                  "error [um]", "link violation [m]"});
    for (const ReachRow& r : study.reach)
      text += row({std::to_string(r.starts), short_number(1e3 * r.wall_seconds), fixed(1e3 * r.floor_rms, 4),
                   short_number(1e6 * r.floor_rms_error), fixed(1e3 * r.floor_max, 4),
                   short_number(1e6 * r.floor_max_error), short_number(r.link_violation)});
  }
  return text;
}

std::string fidelities_text(const Study& study) {
  const std::map<std::string, Settings> chosen = chosen_fidelities(study);
  if (chosen.empty()) return "";
  std::string text = "\n## Fidelities that follow\n\n";
  for (const auto& [name, settings] : chosen) text += "- `" + name + "`: " + words(settings) + "\n";
  return text;
}

/// The series of a chart by name; made if there is none.
ChartSeries& series_of(Chart& chart, const std::string& name) {
  for (ChartSeries& series : chart.series) {
    if (series.name == name) return series;
  }
  const bool dots = name == "combination" || name.starts_with("fidelity");
  return chart.series.emplace_back(ChartSeries{.name = name, .points = {}, .dots = dots, .marks = true});
}

Chart work_chart(const Study& study, const std::string& title, const std::string& error) {
  constexpr double kWidth = 820, kHeight = 460;
  Chart chart{title + ", " + study.case_name, "run time on one core [s]", "error: " + error, {}};
  chart.log_x = chart.log_y = chart.side_legend = true;
  chart.width = kWidth;
  chart.height = kHeight;
  return chart;
}

Chart work_precision(const Study& study, const Column& column) {
  Chart chart = work_chart(study, "Error against run time", column.head);
  const auto place = [&](const StudyPoint& point) {
    return Eigen::Vector2d(point.mean(&StudyRun::cpu_seconds), column.factor * error_of(point, column.name));
  };
  for (const StudyPoint& point : study.points) {
    if (point.valid()) series_of(chart, point.curve).points.push_back(place(point));
  }
  ChartSeries front{.name = "Pareto front", .points = {}, .dots = true, .rings = true};
  for (const int k : front_of(study, column.name)) front.points.push_back(place(study.points[size_t(k)]));
  chart.series.push_back(front);
  return chart;
}

/// What each knob alone does: its error against its own most careful value.
Chart knob_chart(const Study& study) {
  Chart chart = work_chart(study, "What each knob costs and saves", "against its most careful value [%]");
  for (const StudyPoint& point : study.points) {
    const auto error = point.knob_error.find("relative");
    if (point.settings.size() != 1 || error == point.knob_error.end() || !(error->second > 0)) continue;
    series_of(chart, point.curve)
        .points.emplace_back(point.mean(&StudyRun::cpu_seconds), 1e2 * error->second);
  }
  return chart;
}

Chart search_chart(const Study& study, bool by_time) {
  Chart chart{"Best objective of the search, " + study.case_name,
              by_time ? "run time of all evaluations [s]" : "evaluations",
              "best objective so far",
              {}};
  for (const SearchTrace& trace : study.searches) {
    ChartSeries series{.name = trace.name, .points = {}, .steps = true};
    const std::vector<double>& x = by_time ? trace.seconds : trace.evaluations;
    for (size_t k = 0; k < x.size(); ++k) series.points.emplace_back(x[k], trace.best[k]);
    chart.series.push_back(series);
  }
  return chart;
}

Chart rank_chart(const Study& study) {
  Chart chart{"How settings rank " + std::to_string(study.schedules) + " schedules, " + study.case_name,
              "run time on one core [s]",
              "Spearman's rank correlation",
              {}};
  chart.log_x = true;
  ChartSeries named{.name = "fidelities of the case", .points = {}, .dots = true, .marks = true},
      others{.name = "combinations", .points = {}, .dots = true, .marks = true};
  for (const RankRow& r : study.ranks)
    (r.name.empty() ? others : named).points.emplace_back(r.cpu_seconds, r.spearman);
  chart.series = {named, others};
  return chart;
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
  const std::vector<Column> columns = columns_of(study);
  for (const Column& column : columns) text += ",error_" + column.name;
  text += "\n";
  for (const StudyPoint& point : study.points) {
    text += point.curve + ",\"" + words(point.settings) + "\"," + (point.valid() ? "1" : "0");
    for (const double value :
         {point.mean(&StudyRun::wall_seconds), point.mean(&StudyRun::cpu_seconds),
          point.mean(&StudyRun::element_updates), point.mean(&StudyRun::steps), point.mean(&StudyRun::dt),
          point.mean(&StudyRun::balance_error), point.mean(&StudyRun::kinetic_ratio)})
      text += "," + exact(value);
    for (const Column& column : columns) {
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
    text += r.name + ",\"" + words(r.settings) + "\"," + exact(r.cpu_seconds) + "," + exact(r.spearman) +
            "," + exact(r.kendall) + ",\"";
    for (size_t k = 0; k < r.objectives.size(); ++k)
      text += (k > 0 ? " " : "") + (std::isfinite(r.objectives[k]) ? fixed(r.objectives[k], 4) : "-");
    text += "\"\n";
  }
  return text;
}

}  // namespace

json study_json(const Study& study) {
  json out{{"case", study.case_name},
           {"points", json::array()},
           {"fidelities", json::object()},
           {"rank_correlation", json::array()},
           {"noise", json::array()}};
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
  std::string text = "# Study of " + study.case_name + "\n\n";
  if (!study.points.empty()) {
    text += reference_text(study) +
            "## Work and precision\n\nErrors against the reference, the largest of the baselines. Times are "
            "of one run on one core (processor time).\n\n" +
            points_text(study) + "\n## Cheapest settings\n\n" + cheapest_text(study) +
            "\n## Observed orders\n\n" +
            "Of the mesh against the reference, of other knobs against their most careful value.\n\n" +
            orders_text(study);
  }
  return text + parts_text(study) + fidelities_text(study);
}

void write_study(const std::filesystem::path& folder, const Study& study) {
  std::filesystem::create_directories(folder);
  write_text(folder / "study.md", study_text(study));
  if (!study.points.empty()) {
    write_text(folder / "points.csv", points_csv(study));
    for (const Column& column : columns_of(study)) {
      if (column.name == "relative" || column.name == "places")
        write_text(folder / ("work_precision_" + column.name + ".svg"),
                   line_chart(work_precision(study, column)));
    }
  }
  if (!study.points.empty()) write_text(folder / "knobs.svg", line_chart(knob_chart(study)));
  if (!study.ranks.empty()) {
    write_text(folder / "ranks.csv", ranks_csv(study));
    write_text(folder / "ranks.svg", line_chart(rank_chart(study)));
  }
  if (!study.searches.empty()) {
    write_text(folder / "search_evaluations.svg", line_chart(search_chart(study, false)));
    write_text(folder / "search_time.svg", line_chart(search_chart(study, true)));
  }
}

}  // namespace drapeplan
