#include "planner/validate/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "planner/base/text.hpp"
#include "planner/drape/result_fields.hpp"

namespace drapeplan {
namespace {

using nlohmann::json;

constexpr std::array kAgreements{Agreement::agrees, Agreement::differs, Agreement::context};

struct Group {
  std::string name;
  std::vector<ValidationRow> rows;
};

/// Rows by group, in the order of their first appearance.
std::vector<Group> groups_of(const std::vector<ComparisonResult>& results) {
  std::vector<Group> groups;
  for (const ComparisonResult& result : results) {
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.name == result.group; });
    if (group == groups.end()) group = groups.insert(groups.end(), {result.group, {}});
    group->rows.insert(group->rows.end(), result.findings.rows.begin(), result.findings.rows.end());
  }
  return groups;
}

size_t count(const std::vector<Group>& groups, Agreement agreement) {
  size_t sum = 0;
  for (const Group& group : groups)
    sum += size_t(std::count_if(group.rows.begin(), group.rows.end(),
                                [&](const ValidationRow& row) { return row.agreement() == agreement; }));
  return sum;
}

/// "61 rows: 57 agree, 0 differ, 4 are context."
std::string summary_of(const std::vector<Group>& groups) {
  size_t rows = 0;
  for (const Group& group : groups) rows += group.rows.size();
  return fmt::format("{} rows: {} agree, {} differ, {} are context.", rows, count(groups, Agreement::agrees),
                     count(groups, Agreement::differs), count(groups, Agreement::context));
}

/// Five digits; a dash where there is no number.
std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.5g}", value) : "-";
}

std::string tolerance_of(const ValidationRow& row) {
  return row.judged ? fmt::format("{:.2g}", row.tolerance) : "-";
}

/// With what it is.
std::string explained_tolerance(const ValidationRow& row) {
  return row.judged && !row.basis.empty() ? fmt::format("{} ({})", tolerance_of(row), row.basis)
                                          : tolerance_of(row);
}

/// Why a row does not agree; empty if nothing is to be said.
std::string reason_of(const ValidationRow& row) {
  if (row.agreement() == Agreement::differs && row.why.empty())
    return "no reason is known: something is wrong";
  return row.agreement() == Agreement::agrees ? "" : row.why;
}

}  // namespace

json validation_json(const std::vector<ComparisonResult>& results) {
  json rows = json::array(), failures = json::array(), verdicts = json::object();
  const std::vector<Group> groups = groups_of(results);
  for (const Group& group : groups) {
    for (const ValidationRow& row : group.rows) {
      const Agreement agreement = row.agreement();
      rows.push_back({{"group", group.name},
                      {"what", row.what},
                      {"unit", row.unit},
                      {"reference", finite(row.reference)},
                      {"ours", finite(row.ours)},
                      {"tolerance", row.judged ? finite(row.tolerance) : json(nullptr)},
                      {"tolerance_is", row.basis},
                      {"verdict", agreement_name(agreement)},
                      {"why", reason_of(row)},
                      {"source", row.source}});
      if (agreement == Agreement::differs) failures.push_back(fmt::format("{}: {}", group.name, row.what));
    }
  }
  for (const Agreement agreement : kAgreements)
    verdicts[agreement_name(agreement)] = count(groups, agreement);
  json seconds = json::array();
  for (const ComparisonResult& result : results)
    seconds.push_back({{"group", result.group}, {"name", result.name}, {"wall_seconds", result.seconds}});
  return {{"rows", std::move(rows)},
          {"failures", std::move(failures)},
          {"verdicts", std::move(verdicts)},
          {"comparisons", std::move(seconds)}};
}

std::string validation_text(const std::vector<ComparisonResult>& results) {
  const std::vector<Group> groups = groups_of(results);
  size_t widest = 0;
  for (const Group& group : groups)
    for (const ValidationRow& row : group.rows) widest = std::max(widest, row.what.size());
  std::string text, last_why;  // the same reason stands once
  for (const Group& group : groups) {
    text += fmt::format("{}{}\n{:<8} {:<{}} {:>9} {:>9} {:>8} {:<5} {}\n", text.empty() ? "" : "\n",
                        group.name, "verdict", "", widest, "reference", "ours", "+-", "unit", "source");
    for (const ValidationRow& row : group.rows) {
      text += fmt::format("{:<8} {:<{}} {:>9} {:>9} {:>8} {:<5} {}\n", agreement_name(row.agreement()),
                          row.what, widest, number(row.reference), number(row.ours), tolerance_of(row),
                          row.unit, row.source);
      const std::string why = reason_of(row);
      if (!why.empty() && why != last_why) text += fmt::format("{:<8} why: {}\n", "", why);
      last_why = why;
    }
  }
  return text + "\n" + summary_of(groups) + "\n";
}

std::string validation_markdown(const std::vector<ComparisonResult>& results) {
  const std::vector<Group> groups = groups_of(results);
  std::string text =
      "# Comparisons with outside data\n\n" + summary_of(groups) +
      "\nA row is context where nobody says how exact the reference is: it is shown, not judged.\n";
  for (const Group& group : groups) {
    text += fmt::format(
        "\n## {}\n\n| what | reference | ours | tolerance | verdict | source |\n|---|---|---|---|---|---|\n",
        group.name);
    for (const ValidationRow& row : group.rows) {
      const Agreement agreement = row.agreement();
      const std::string why = reason_of(row), name = agreement_name(agreement);
      const std::string verdict = agreement == Agreement::differs ? "**" + name + "**" : name;
      const std::string unit = row.unit.empty() ? "" : " " + row.unit;
      text += fmt::format("| {} | {}{} | {} | {} | {} | {} |\n", markdown_cell(row.what), number(row.reference),
                          unit, number(row.ours), explained_tolerance(row),
                          verdict + (why.empty() ? "" : ": " + markdown_cell(why)), markdown_cell(row.source));
    }
  }
  return text;
}

std::string validation_page(const std::vector<ComparisonResult>& results) {
  const std::vector<Group> groups = groups_of(results);
  PlanReport page;
  page.title = "Comparisons with outside data";
  page.description =
      "What other codes compute and what others have measured, beside what this program gives.";
  page.verdict = summary_of(groups);
  for (const Group& group : groups) {
    ReportTable table{.title = group.name,
                      .caption = "",
                      .head = {"what", "reference", "ours", "tolerance", "unit", "verdict", "source"},
                      .rows = {}};
    for (const ValidationRow& row : group.rows) {
      const Agreement agreement = row.agreement();
      const std::string why = reason_of(row);
      table.rows.push_back(
          {.cells = {row.what, number(row.reference), number(row.ours), explained_tolerance(row), row.unit,
                     agreement_name(agreement), row.source},
           .failed = agreement == Agreement::differs,
           .beside = agreement == Agreement::context,
           .note = why.empty() ? "" : "Why: " + why});
    }
    page.tables.push_back(std::move(table));
  }
  for (const ComparisonResult& result : results)
    page.figures.insert(page.figures.end(), result.findings.figures.begin(), result.findings.figures.end());
  page.notes = {"A row is context where nobody says how exact the reference is: it is shown, not judged."};
  page.files = {{"result.json", "all figures"}, {"validate.md", "the tables as text"}};
  return html_report(page);
}

}  // namespace drapeplan
