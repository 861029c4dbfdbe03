#include "planner/batch/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/base/text.hpp"
#include "planner/page/page.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

double number_at(const json& document, const char* pointer) {
  const json::json_pointer place(pointer);
  if (!document.contains(place) || !document.at(place).is_number()) return PlannedLine::kUnknown;
  return document.at(place).get<double>();
}

double edge_tolerance(const json& result) {
  const json::json_pointer place("/best/acceptance/tolerances");
  if (!result.contains(place)) return 0;
  for (const json& one : result.at(place)) {
    if (one.at("part") == "max_boundary_offset") return one.at("tolerance").get<double>();
  }
  return 0;
}

/// The front has the tightest edge first; its last point has no tolerance: the edge may lie anywhere.
double floor_within(const json& result, double tolerance) {
  if (!result.contains("front")) return PlannedLine::kUnknown;
  for (const json& point : result.at("front")) {
    const json& edge = point.at("boundary_tolerance");
    if (edge.is_null() || edge.get<double>() >= tolerance) return number_at(point, "/gap_floor");
  }
  return PlannedLine::kUnknown;
}

struct Column {
  const char* title;  ///< for people
  const char* key;    ///< in summary.csv
  double scale;       ///< from SI to what people read
  int digits;
  double (*value)(const PlannedLine&);
};

constexpr Column kColumns[] = {
    {"uniform [-]", "objective_uniform", 1, 2, [](const PlannedLine& l) { return l.uniform; }},
    {"wave [-]", "objective_wave", 1, 2, [](const PlannedLine& l) { return l.wave; }},
    {"optimised [-]", "objective_optimised", 1, 2, [](const PlannedLine& l) { return l.optimised; }},
    {"gap [mm]", "max_gap_m", 1e3, 2, [](const PlannedLine& l) { return l.max_gap; }},
    {"offset [mm]", "max_boundary_offset_m", 1e3, 2,
     [](const PlannedLine& l) { return l.max_boundary_offset; }},
    {"floor [mm]", "gap_floor_m", 1e3, 2, [](const PlannedLine& l) { return l.gap_floor; }},
    {"evaluations", "evaluations", 1, 0, [](const PlannedLine& l) { return double(l.evaluations); }},
    {"time [min]", "wall_seconds", 1.0 / 60, 1, [](const PlannedLine& l) { return l.wall_seconds; }},
};

std::string cell_of(const Column& column, const PlannedLine& line) {
  const double value = column.value(line);
  return std::isfinite(value) ? fmt::format("{:.{}f}", column.scale * value, column.digits) : "-";
}

std::string csv_text(const std::vector<PlannedLine>& lines) {
  std::string text = "case,folder,status";
  for (const Column& column : kColumns) text += fmt::format(",{}", column.key);
  text += ",reason\n";
  for (const PlannedLine& line : lines) {
    text += fmt::format("{},{},{}", quoted_cell(line.file), quoted_cell(line.folder.string()), line.status);
    for (const Column& column : kColumns) {
      const double value = column.value(line);
      text += std::isfinite(value) ? "," + exact(value) : ",";
    }
    std::string reason = line.reason;
    std::replace(reason.begin(), reason.end(), '\n', ' ');  // a line per case
    text += fmt::format(",{}\n", quoted_cell(reason));
  }
  return text;
}

std::string count_text(const std::vector<PlannedLine>& lines) {
  const auto count = [&](const char* status) {
    return std::count_if(lines.begin(), lines.end(),
                         [&](const PlannedLine& line) { return line.status == status; });
  };
  std::string text = fmt::format("{} of {} drapes are accepted", count("accepted"), lines.size());
  for (const char* status : {"interrupted", "not finished", "wrong input"})
    if (count(status) > 0) text += fmt::format(", {} {}", count(status), status);
  return text + ".";
}

PlanReport page_of(const std::filesystem::path& root, const std::vector<PlannedLine>& lines) {
  ReportTable table{
      .title = "Cases",
      .caption =
          "Objectives of both baselines and of the optimised drape; its largest gap and boundary offset; the "
          "gap below which no schedule of the rig comes while the edge keeps its tolerance.",
      .head = {"case", "verdict"},
      .rows = {}};
  for (const Column& column : kColumns) table.head.emplace_back(column.title);
  PlanReport page;
  for (const PlannedLine& line : lines) {
    ReportTable::Row row{
        .cells = {line.file, line.status}, .failed = !line.reason.empty(), .note = line.reason};
    for (const Column& column : kColumns) row.cells.push_back(cell_of(column, line));
    table.rows.push_back(std::move(row));
    if (std::error_code error; std::filesystem::exists(line.folder / "report.html", error))
      page.files.emplace_back((line.folder.lexically_relative(root) / "report.html").generic_string(),
                              "the plan of " + line.file);
  }
  page.title = fmt::format("{} cases", lines.size());
  page.verdict = count_text(lines);
  page.tables.push_back(std::move(table));
  page.files.emplace_back("summary.csv", "the same, in SI units");
  return page;
}

}  // namespace

PlannedLine planned_line(const std::string& file, const std::filesystem::path& folder, const json& result) {
  PlannedLine line{.file = file, .folder = folder, .status = {}, .reason = {}};
  const bool ran = std::isfinite(number_at(result, "/best/score/objective"));
  if (result.contains("status")) {
    line.status = result.at("status").get<std::string>();
    line.reason = result.value("reason", "");
    return line;
  }
  const bool interrupted = result.value("interrupted", false);
  line.status = interrupted                                         ? "interrupted"
                : !ran                                              ? "not finished"
                : result.at("best").at("acceptance").at("accepted") ? "accepted"
                                                                    : "not accepted";
  if (interrupted || !ran) line.reason = result.value("message", "");
  line.uniform = number_at(result, "/baselines/uniform/objective");
  line.wave = number_at(result, "/baselines/wave/objective");
  line.optimised = number_at(result, "/best/score/objective");
  line.max_gap = number_at(result, "/best/score/max_gap");
  line.max_boundary_offset = number_at(result, "/best/score/max_boundary_offset");
  line.gap_floor = floor_within(result, edge_tolerance(result));
  line.evaluations = result.value("evaluations", 0);
  line.wall_seconds = result.value("wall_seconds", 0.0);
  return line;
}

std::string summary_text(const std::vector<PlannedLine>& lines) {
  size_t widest = 4;
  for (const PlannedLine& line : lines) widest = std::max(widest, line.file.size());
  std::string text = fmt::format("{:<{}}  {:<12}", "case", widest, "verdict");
  for (const Column& column : kColumns) text += fmt::format("  {:>13}", column.title);
  text += '\n';
  for (const PlannedLine& line : lines) {
    text += line.file + std::string(widest - line.file.size(), ' ');
    text += fmt::format("  {:<12}", line.status);
    for (const Column& column : kColumns) text += fmt::format("  {:>13}", cell_of(column, line));
    text += '\n';
  }
  return text + count_text(lines) + '\n';
}

void write_summary(const std::filesystem::path& root, const std::vector<PlannedLine>& lines) {
  write_text(root / "summary.csv", csv_text(lines));
  write_text(root / "summary.html", html_report(page_of(root, lines)));
}

}  // namespace drapeplan
