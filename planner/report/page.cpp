#include "planner/report/page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

constexpr const char* kStyle = R"css(
:root { color: #1d2733; background: #fff; font: 16px/1.55 Inter, "Helvetica Neue", Arial, "Liberation Sans", sans-serif; }
body { max-width: 76rem; margin: 0 auto; padding: 2.5rem 1.5rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.15rem; margin: 2.6rem 0 .7rem; padding-top: 1.1rem; border-top: 1px solid #dfe4ea; }
p { max-width: 46rem; margin: .5rem 0; }
.lead { font-size: 1.1rem; }
.soft, figcaption, caption { color: #5b6775; font-size: .9rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { caption-side: bottom; text-align: left; padding-top: .5rem; max-width: 60rem; }
th, td { padding: .38rem .7rem; text-align: right; border-bottom: 1px solid #dfe4ea; white-space: nowrap; }
th { font-weight: 600; font-size: .86rem; line-height: 1.3; vertical-align: bottom; white-space: normal; max-width: 6.2rem; }
th small { display: block; font-weight: 400; color: #5b6775; }
th:first-child, td:first-child, .pairs td { text-align: left; }
.pairs td { white-space: normal; padding: .25rem 1.4rem .25rem 0; vertical-align: top; }
.best { font-weight: 700; background: #eaf4ee; }
.reference td { color: #5b6775; font-style: italic; }
.failed { color: #b3261e; text-align: left; white-space: normal; }
figure { margin: 1.2rem 0 1.8rem; }
figure svg { max-width: 100%; height: auto; }
code { font: .92em ui-monospace, "DejaVu Sans Mono", monospace; }
@media print { body { padding: 0; } h2, figure, tr { break-inside: avoid; } }
)css";

/// A column of the table of scores.
struct Column {
  const char* name;
  const char* unit;
  double Score::*part;
  double factor;  ///< from SI to the unit shown
  int decimals;
  bool compared;  ///< lower is better
};

constexpr std::array kColumns{
    Column{"largest gap", "mm", &Score::max_gap, 1e3, 2, true},
    Column{"gap, r.m.s.", "mm", &Score::rms_gap, 1e3, 2, true},
    Column{"wrinkled area", "cm\u00b2", &Score::wrinkled_area, 1e4, 1, true},
    Column{"largest boundary offset", "mm", &Score::max_boundary_offset, 1e3, 2, true},
    Column{"boundary offset, r.m.s.", "mm", &Score::rms_boundary_offset, 1e3, 2, true},
    Column{"largest shear", "\u00b0", &Score::max_shear_deg, 1, 1, false},
    Column{"largest fibre tension", "%", &Score::max_fibre_strain, 100, 3, false},
    Column{"largest actuator force", "N", &Score::max_actuator_force, 1, 1, false},
    Column{"duration", "s", &Score::duration, 1, 1, false},
    Column{"objective", "", &Score::objective, 1, 2, true},
};

bool counts(const ReportRow& row, const Column& column) {
  return row.score.valid && !row.reference && std::isfinite(row.score.*column.part);
}

/// Smallest value of a column as it is shown; nothing if all rows that can be compared show the same.
std::optional<std::string> best_text(const std::vector<ReportRow>& rows, const Column& column) {
  if (!column.compared) return std::nullopt;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double best = kInfinity, worst = -kInfinity;
  for (const ReportRow& row : rows) {
    if (!counts(row, column)) continue;
    best = std::min(best, row.score.*column.part);
    worst = std::max(worst, row.score.*column.part);
  }
  const std::string text = fixed(column.factor * best, column.decimals);
  if (text == fixed(column.factor * worst, column.decimals)) return std::nullopt;
  return text;
}

std::string score_row(const ReportRow& row,
                      const std::array<std::optional<std::string>, kColumns.size()>& best) {
  std::string text = row.reference ? "<tr class=\"reference\">" : "<tr>";
  text += "<td>" + escape_markup(row.name) + "</td>";
  if (!row.score.valid && !row.reference) {
    return text + "<td class=\"failed\" colspan=\"" + std::to_string(kColumns.size()) +
           "\">failed: " + escape_markup(row.score.reason) + "</td></tr>\n";
  }
  for (size_t k = 0; k < kColumns.size(); ++k) {
    const std::string value = fixed(kColumns[k].factor * row.score.*kColumns[k].part, kColumns[k].decimals);
    const bool stands_out = counts(row, kColumns[k]) && best[k] == value;
    text += (stands_out ? "<td class=\"best\">" : "<td>") + value + "</td>";
  }
  return text + "</tr>\n";
}

std::string score_table(const std::vector<ReportRow>& rows) {
  if (rows.empty()) return "";
  std::array<std::optional<std::string>, kColumns.size()> best;
  std::string text = "<h2>Scores</h2>\n<div class=\"wide\"><table>\n<thead><tr><th>sequence</th>";
  for (size_t k = 0; k < kColumns.size(); ++k) {
    best[k] = best_text(rows, kColumns[k]);
    text += std::string("<th>") + kColumns[k].name + "<small>" + kColumns[k].unit + "</small></th>";
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const ReportRow& row : rows) text += score_row(row, best);
  return text +
         "</tbody>\n<caption>Lower is better; the best value of a column stands out. Gap: between the "
         "ply\u2019s "
         "underside and the mold at the end. Wrinkled area: gap above the threshold where the ply does not "
         "bridge a "
         "hollow. Boundary offset: between the ply\u2019s edge and the prescribed boundary. Rows in italics "
         "are "
         "reported elsewhere and are not compared.</caption>\n</table></div>\n";
}

std::string paragraph(const std::string& text, const std::string& style = "") {
  if (text.empty()) return "";
  return (style.empty() ? "<p>" : "<p class=\"" + style + "\">") + escape_markup(text) + "</p>\n";
}

std::string pairs(const std::string& title, const std::vector<std::pair<std::string, std::string>>& entries,
                  bool code) {
  if (entries.empty()) return "";
  std::string text = "<h2>" + title + "</h2>\n<table class=\"pairs\">\n";
  for (const auto& [name, value] : entries) {
    const std::string escaped = escape_markup(name);
    text += "<tr><td>" + (code ? "<code>" + escaped + "</code>" : escaped) + "</td><td>" +
            escape_markup(value) + "</td></tr>\n";
  }
  return text + "</table>\n";
}

std::string file_list(const std::vector<std::pair<std::string, std::string>>& files) {
  if (files.empty()) return "";
  std::string text = "<h2>Files of this run</h2>\n<table class=\"pairs\">\n";
  for (const auto& [name, what] : files) {
    const std::string escaped = escape_markup(name);
    // "./" keeps a name with a colon from being read as a scheme.
    text += "<tr><td><a href=\"./" + escaped + "\"><code>" + escaped + "</code></a></td><td>" +
            escape_markup(what) + "</td></tr>\n";
  }
  return text + "</table>\n";
}

}  // namespace

std::string html_report(const PlanReport& report) {
  const std::string title = escape_markup(report.title);
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      title + " \u2013 draping plan</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title +
      "</h1>\n";
  page += paragraph(report.description, "soft") + paragraph(report.verdict, "lead");
  if (!report.reach.empty()) page += "<h2>What the rig can reach</h2>\n" + paragraph(report.reach);
  page += score_table(report.rows);
  if (!report.figures.empty()) page += "<h2>Pictures</h2>\n";
  for (const ReportFigure& figure : report.figures) {
    page += "<figure>\n<div class=\"wide\">" + figure.svg + "</div>\n<figcaption>" +
            escape_markup(figure.caption) + "</figcaption>\n</figure>\n";
  }
  if (!report.notes.empty()) {
    page += "<h2>To keep in mind</h2>\n<ul>\n";
    for (const std::string& note : report.notes) page += "<li>" + escape_markup(note) + "</li>\n";
    page += "</ul>\n";
  }
  page += pairs("The run", report.facts, false) + pairs("Settings", report.settings, true) +
          file_list(report.files);
  return page + "</body>\n</html>\n";
}

}  // namespace drapeplan
