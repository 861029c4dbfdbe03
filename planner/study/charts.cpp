#include "planner/study/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "planner/base/statistics.hpp"
#include "planner/report/charts.hpp"
#include "planner/score/score.hpp"

namespace drapeplan {
namespace {

/// The series of a curve; made if there is none. Fidelities of the case share one.
ChartSeries& series_of(Chart& chart, const std::string& curve) {
  const std::string name = curve.starts_with("fidelity") ? "fidelities of the case" : curve;
  for (ChartSeries& series : chart.series) {
    if (series.name == name) return series;
  }
  const bool dots = name != curve || curve == "combination";
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

Chart work_precision(const Study& study, const StudyColumn& column) {
  Chart chart = work_chart(study, "Error against run time", column.head);
  const auto place = [&](const StudyPoint& point) {
    return Eigen::Vector2d(point.mean(&StudyRun::cpu_seconds), column.factor * error_of(point, column.name));
  };
  for (const StudyPoint& point : study.points) {
    if (point.valid()) series_of(chart, point.curve).points.push_back(place(point));
  }
  ChartSeries front{.name = "Pareto front", .points = {}, .dots = true, .rings = true};
  for (const int k : study_front(study, column.name)) front.points.push_back(place(study.points[size_t(k)]));
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
  Chart chart{fmt::format("How settings rank {} schedules, {}", study.schedules, study.case_name),
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

Chart mapping_chart(const Study& study) {
  Chart chart{"Error of the mapping against its time, " + study.case_name, "time [ms]", "error [um]", {}};
  chart.log_x = chart.log_y = true;
  ChartSeries places{.name = "places, r.m.s.", .points = {}, .marks = true}, targets = places;
  targets.name = "targets, largest";
  for (const MappingRow& m : study.mapping) {
    places.points.emplace_back(1e3 * m.wall_seconds, 1e6 * m.places);
    targets.points.emplace_back(1e3 * m.wall_seconds, 1e6 * m.targets);
  }
  chart.series = {places};
  if (study.drapes) chart.series.push_back(targets);
  return chart;
}

}  // namespace

double error_of(const StudyPoint& point, const std::string& name) {
  const auto found = point.error.find(name);
  return found == point.error.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::vector<StudyColumn> study_columns(const Study& study) {
  const StudyColumn places{"places", "nodes r.m.s. [mm]", 1e3}, shear{"shear_deg", "shear r.m.s. [deg]", 1};
  if (!study.drapes) return {{"relative", "largest relative [%]", 1e2}, places, shear};
  std::vector<StudyColumn> columns;
  for (const ScorePart& part : kScoreParts) {
    if (part.leads) columns.push_back({part.study, title_of(part), part.factor});
  }
  columns.insert(columns.end(), {{"relative", "larger of gap and offset [%]", 1e2}, places, shear});
  for (const ScorePart& part : kScoreParts) {
    if (part.value == &Score::objective) columns.push_back({part.study, title_of(part), part.factor});
  }
  return columns;
}

std::vector<int> study_front(const Study& study, const std::string& error) {
  std::vector<double> cost, errors;
  for (const StudyPoint& point : study.points) {
    cost.push_back(point.valid() && only_numerical(point.settings) ? point.mean(&StudyRun::cpu_seconds)
                                                                   : std::numeric_limits<double>::infinity());
    errors.push_back(error_of(point, error));
  }
  return pareto_front(cost, errors);
}

std::map<std::string, std::string> study_charts(const Study& study) {
  std::map<std::string, std::string> charts;
  if (!study.points.empty()) {
    for (const StudyColumn& column : study_columns(study)) {
      if (column.name == "relative" || column.name == "places")
        charts["work_precision_" + column.name] = line_chart(work_precision(study, column));
    }
    charts["knobs"] = line_chart(knob_chart(study));
  }
  if (!study.mapping.empty()) charts["mapping"] = line_chart(mapping_chart(study));
  if (!study.ranks.empty()) charts["ranks"] = line_chart(rank_chart(study));
  if (!study.searches.empty()) {
    charts["search_evaluations"] = line_chart(search_chart(study, false));
    charts["search_time"] = line_chart(search_chart(study, true));
  }
  return charts;
}

}  // namespace drapeplan
