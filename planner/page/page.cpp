#include "planner/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "planner/base/text.hpp"
#include "planner/page/assets.hpp"

namespace drapeplan {
namespace {

using BestTexts = std::array<std::optional<std::string>, kScoreParts.size()>;

bool counts(const ReportRow& row, const ScorePart& part) {
  return row.score.valid && !row.reference && !row.beside && std::isfinite(row.score.*part.value);
}

/// Smallest value of a part as it is shown; nothing if all rows that can be compared show the same.
std::optional<std::string> best_text(const std::vector<ReportRow>& rows, const ScorePart& part) {
  if (!part.compared) return std::nullopt;
  const ReportRow *best = nullptr, *worst = nullptr;
  for (const ReportRow& row : rows) {
    if (!counts(row, part)) continue;
    if (best == nullptr || row.score.*part.value < best->score.*part.value) best = &row;
    if (worst == nullptr || row.score.*part.value > worst->score.*part.value) worst = &row;
  }
  if (best == nullptr) return std::nullopt;
  const std::string text = value_text(part, best->score);
  if (text == value_text(part, worst->score)) return std::nullopt;
  return text;
}

/// Of the wrinkled area its share of the ply, on a line of its own; empty for other parts and where it is not
/// known.
std::string share_text(const ScorePart& part, const Score& score, double ply_area) {
  const double share = score.*part.value / ply_area;
  if (part.value != &Score::wrinkled_area || !(ply_area > 0) || !std::isfinite(share)) return "";
  return fmt::format("<small>{}\u2009%</small>", fixed(1e2 * share, 1));
}

std::string score_row(const ReportRow& row, const BestTexts& best, double ply_area) {
  std::string text = row.reference ? "<tr class=\"reference\">"
                     : row.beside  ? "<tr class=\"beside\">"
                                   : "<tr>";
  text += fmt::format("<td>{}</td>", escape_markup(row.name));
  if (!row.score.valid && !row.reference) {
    return text + fmt::format("<td class=\"failed\" colspan=\"{}\">failed: {}</td></tr>\n",
                              kScoreParts.size(), escape_markup(row.score.reason));
  }
  for (size_t k = 0; k < kScoreParts.size(); ++k) {
    const std::string value = value_text(kScoreParts[k], row.score);
    const bool stands_out = counts(row, kScoreParts[k]) && best[k] == value;
    text += fmt::format("<td{}>{}{}</td>", stands_out ? " class=\"best\"" : "", value,
                        share_text(kScoreParts[k], row.score, ply_area));
  }
  return text + "</tr>\n";
}

std::string score_table(const std::vector<ReportRow>& rows, double ply_area) {
  if (rows.empty()) return "";
  BestTexts best;
  std::string text = "<h2>Scores</h2>\n<div class=\"wide\"><table>\n<thead><tr><th>sequence</th>";
  for (size_t k = 0; k < kScoreParts.size(); ++k) {
    best[k] = best_text(rows, kScoreParts[k]);
    text += fmt::format("<th>{}<small>{}</small></th>", kScoreParts[k].label, kScoreParts[k].unit);
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const ReportRow& row : rows) text += score_row(row, best, ply_area);
  return text +
         "</tbody>\n<caption><span>Lower is better; the best value of a column stands out. Gap: between the "
         "ply\u2019s underside and the mold at the end. Wrinkled area: gap above the threshold where the ply "
         "does not bridge a hollow, below it its share of the ply. Boundary offset: between the ply\u2019s "
         "edge and the prescribed boundary." +
         (std::any_of(rows.begin(), rows.end(), [](const ReportRow& row) { return row.reference; })
              ? " Rows in italics are reported elsewhere and are not compared."
              : "") +
         (std::any_of(rows.begin(), rows.end(), [](const ReportRow& row) { return row.beside; })
              ? " Grey rows are scores that the objective does not take, or drapes at a finer setting: they "
                "are not compared."
              : "") +
         "</span></caption>\n</table></div>\n";
}

/// @param title  as markup.
std::string text_table(const ReportTable& table, const std::string& title) {
  std::string text = fmt::format("{}\n<div class=\"wide\"><table class=\"texts\">\n<thead><tr>", title);
  for (const std::string& head : table.head) text += fmt::format("<th>{}</th>", escape_markup(head));
  text += "</tr></thead>\n<tbody>\n";
  for (const ReportTable::Row& row : table.rows) {
    const char* style = row.failed ? " class=\"failed\"" : row.beside ? " class=\"beside\"" : "";
    text += fmt::format("<tr{}>", style);
    for (const std::string& cell : row.cells) text += fmt::format("<td>{}</td>", escape_markup(cell));
    text += "</tr>\n";
    if (!row.note.empty())
      text += fmt::format("<tr{}><td colspan=\"{}\">{}</td></tr>\n", style, table.head.size(),
                          escape_markup(row.note));
  }
  return text + fmt::format("</tbody>\n<caption><span>{}</span></caption>\n</table></div>\n",
                            escape_markup(table.caption));
}

std::string paragraph(const std::string& text, const std::string& style = "") {
  if (text.empty()) return "";
  const std::string opening = style.empty() ? "<p>" : fmt::format("<p class=\"{}\">", style);
  return fmt::format("{}{}</p>\n", opening, escape_markup(text));
}

std::string pairs(const std::string& title, const std::vector<std::pair<std::string, std::string>>& entries,
                  bool code) {
  if (entries.empty()) return "";
  std::string text = fmt::format("<h2>{}</h2>\n<table class=\"pairs\">\n", title);
  for (const auto& [name, value] : entries) {
    const std::string escaped = escape_markup(name);
    text += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n",
                        code ? fmt::format("<code>{}</code>", escaped) : escaped, escape_markup(value));
  }
  return text + "</table>\n";
}

std::string file_list(const std::vector<std::pair<std::string, std::string>>& files) {
  if (files.empty()) return "";
  std::string text = "<h2>Files of this run</h2>\n<table class=\"pairs\">\n";
  for (const auto& [name, what] : files) {
    // "./" keeps a name with a colon from being read as a scheme.
    text += fmt::format("<tr><td><a href=\"./{0}\"><code>{0}</code></a></td><td>{1}</td></tr>\n",
                        escape_markup(name), escape_markup(what));
  }
  return text + "</table>\n";
}

std::string heading(const std::string& title) {
  return fmt::format("<h2>{}</h2>\n", escape_markup(title));
}

std::string figure_text(const ReportFigure& figure) {
  return fmt::format("<figure>\n<div class=\"wide\">{}</div>\n<figcaption>{}</figcaption>\n</figure>\n",
                     figure.svg, escape_markup(figure.caption));
}

std::string reasons_text(const ReportReasons& reasons) {
  std::string text =
      heading("Why, and what would change it") + paragraph(reasons.text) + paragraph(reasons.remedy);
  if (!reasons.figure.svg.empty()) text += figure_text(reasons.figure);
  if (!reasons.folds.rows.empty()) text += text_table(reasons.folds, "");
  return text;
}

/// Words that an engineer need not know, on a page with scores.
constexpr std::array<std::pair<const char*, const char*>, 9> kWords{{
    {"objective",
     "the weighted sum of the parts of the score, each over its reference value; lower is better, and "
     "0 is a perfect drape"},
    {"prescribed boundary", "where the edge of the ply lies if it is draped as it was mapped"},
    {"mapped net",
     "the fibres of the ply as the kinematic mapping lays them on the mold, without any machine"},
    {"floor",
     "the smallest gap that a ply whose fibres hardly stretch can have under this rig, whatever the "
     "schedule"},
    {"interlinks", "the bars between the joints of neighbouring grippers"},
    {"lag", "how far a joint is behind its command before its pad touches the mold"},
    {"screen, search, report",
     "numerical settings, from cheap to careful: schedules are sought at the first ones, and "
     "the figures of a plan are at the last one unless another is named"},
    {"cells, time x, step x",
     "size of the finite elements; by how much faster the schedule is played in the simulation; "
     "by how much mass on the fibres lengthens a time step"},
    {"state hash", "a fingerprint of the end of the run: the same numbers give the same one"},
}};

std::string words_text() {
  std::string text = "<details><summary>Words on this page</summary>\n<table class=\"pairs\">\n";
  for (const auto& [word, meaning] : kWords)
    text += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", word, meaning);
  return text + "</table>\n</details>\n";
}

/// Words on lines of at most `width` characters, as far as no word is longer.
std::vector<std::string> wrapped(const std::string& words, size_t width) {
  std::vector<std::string> lines;
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    if (lines.empty() || lines.back().size() + 1 + word.size() > width)
      lines.push_back(word);
    else
      lines.back() += " " + word;
  }
  return lines;
}

}  // namespace

std::string html_report(const PlanReport& report) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0} \u2013 draping plan</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      escape_markup(report.title), kPageStyle);
  page += paragraph(report.description, "soft") + paragraph(report.verdict, "lead") +
          paragraph(report.outcome) + report.view;
  if (report.reasons) page += reasons_text(*report.reasons);
  if (!report.reach.empty()) page += heading("What the rig can reach") + paragraph(report.reach);
  page += score_table(report.rows, report.ply_area);
  for (const ReportTable& table : report.tables) page += text_table(table, heading(table.title));
  if (!report.figures.empty()) page += "<h2>Pictures</h2>\n";
  for (const ReportFigure& figure : report.figures) page += figure_text(figure);
  if (!report.notes.empty()) {
    page += "<h2>To keep in mind</h2>\n<ul>\n";
    for (const std::string& note : report.notes) page += fmt::format("<li>{}</li>\n", escape_markup(note));
    page += "</ul>\n";
  }
  page += pairs("The run", report.facts, false) + pairs("Settings", report.settings, true) +
          file_list(report.files);
  if (!report.rows.empty()) page += words_text();
  return page + "</body>\n</html>\n";
}

std::string console_table(const std::vector<ReportRow>& rows) {
  constexpr int kName = 28, kWidth = 10;
  std::vector<std::vector<std::string>> heads;  // of each column, the unit below the label
  size_t lines = 0;
  for (const ScorePart& part : kScoreParts) {
    if (!part.compared) continue;
    heads.push_back(wrapped(part.label, kWidth));
    heads.back().push_back(fmt::format("[{}]", *part.unit == '\0' ? "-" : part.unit));
    lines = std::max(lines, heads.back().size());
  }
  std::string text;
  for (size_t line = 0; line < lines; ++line) {
    text += std::string(kName, ' ');
    for (const std::vector<std::string>& head : heads) {
      const size_t above = lines - head.size();  // empty lines
      text += fmt::format(" {:>{}}", line < above ? "" : head[line - above], kWidth);
    }
    text += "\n";
  }
  for (const ReportRow& row : rows) {
    text += fmt::format("{:<{}.{}}", row.name, kName, kName);
    if (!row.score.valid) text += "  " + row.score.reason;
    for (const ScorePart& part : kScoreParts) {
      if (row.score.valid && part.compared)
        text += fmt::format(" {:>{}}", value_text(part, row.score), kWidth);
    }
    text += "\n";
  }
  return text;
}

}  // namespace drapeplan
