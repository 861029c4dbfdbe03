#include "planner/page/page.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "planner/report/svg.hpp"
#include "planner/score/scoring.hpp"

namespace drapeplan {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

ReportRow row(const std::string& name, double gap) {
  ReportRow result{name, {}};
  result.score.valid = true;
  result.score.max_gap = gap;
  return result;
}

TEST(HtmlReport, EscapesEveryTextButThePictures) {
  const std::string evil = "<script>alert(\"x\")</script>";
  PlanReport report;
  report.title = report.description = report.verdict = report.reach = evil;
  report.rows = {{evil, failed_score(evil)}};
  report.tables = {{evil, evil, {evil}, {{{evil}, true, false, evil}}}};
  report.figures = {{evil, "<svg><title>kept</title></svg>"}};
  report.reasons = ReportReasons{evil, evil, {evil, "<svg></svg>"}, {evil, evil, {evil}, {{{evil}}}}};
  report.notes = {evil};
  report.facts = report.settings = report.files = {{evil, evil}};
  const std::string page = html_report(report);
  EXPECT_FALSE(contains(page, "<script"));
  EXPECT_FALSE(contains(page, "\"x\""));
  EXPECT_TRUE(contains(page, "<svg><title>kept</title></svg>"));
  EXPECT_TRUE(contains(page, "failed: &lt;script&gt;"));
}

TEST(HtmlReport, SaysWhyBeforeTheScores) {
  PlanReport report;
  report.verdict = "Not accepted.";
  report.rows = {row("uniform", 0.002)};
  EXPECT_FALSE(contains(html_report(report), "Why, and what would change it"));
  report.reasons = ReportReasons{"A chord.", "A press.", {}, {"Folds", "", {"fold"}, {{{"1"}}}}};
  const std::string page = html_report(report);
  const std::vector<std::string> order{"Not accepted.", "Why, and what would change it",
                                       "A chord.",      "A press.",
                                       "<th>fold</th>", "<h2>Scores</h2>"};
  for (size_t k = 1; k < order.size(); ++k)
    EXPECT_LT(page.find(order[k - 1]), page.find(order[k])) << order[k];
}

TEST(HtmlReport, LoadsNothingFromElsewhere) {
  PlanReport report;
  report.title = "t";
  report.files = {{"schedule.json", "knots"}};
  const std::string page = html_report(report);
  for (const char* word : {"http:", "https:", "<script", "@import", "url(", "<link"}) {
    EXPECT_FALSE(contains(page, word)) << word;
  }
  EXPECT_TRUE(contains(page, "href=\"./schedule.json\""));
}

TEST(HtmlReport, BestValidRowStandsOutAndReferencesDoNot) {
  PlanReport report;
  ReportRow published = row("published", 0.0001);
  published.reference = true;
  published.score.rms_gap = kNan;
  ReportRow failed{"failed", failed_score("diverged")};
  report.rows = {published, row("uniform", 0.0122), row("optimised", 0.0034), failed};
  const std::string page = html_report(report);
  EXPECT_TRUE(contains(page, "<td class=\"best\">3.40</td>"));
  EXPECT_FALSE(contains(page, "<td class=\"best\">0.10</td>"));
  EXPECT_FALSE(contains(page, "<td class=\"best\">12.20</td>"));
  EXPECT_TRUE(contains(page, "<td>0.10</td><td>\u2013</td>"));
  EXPECT_TRUE(contains(page, "failed: diverged"));
}

TEST(HtmlReport, AScoreThatTheObjectiveDoesNotTakeStandsBesideAndIsNotCompared) {
  PlanReport report;
  ReportRow before = row("optimised, before pressing", 0.001);
  before.beside = true;
  report.rows = {row("uniform", 0.0122), row("optimised", 0.0034)};
  EXPECT_FALSE(contains(html_report(report), "Grey rows"));
  report.rows.push_back(before);
  const std::string page = html_report(report);
  EXPECT_TRUE(contains(page, "<tr class=\"beside\"><td>optimised, before pressing</td><td>1.00</td>"));
  EXPECT_TRUE(contains(page, "<td class=\"best\">3.40</td>"));
  EXPECT_TRUE(contains(page, "Grey rows"));
}

TEST(HtmlReport, WrinkledAreaIsAlsoAShareOfThePly) {
  PlanReport report;
  report.rows = {row("uniform", 0.0122)};
  report.rows.front().score.wrinkled_area = 0.01;
  EXPECT_FALSE(contains(html_report(report), "\u2009%"));
  report.ply_area = 0.04;
  EXPECT_TRUE(contains(html_report(report), "<td>100.0<small>25.0\u2009%</small></td>"));
}

TEST(HtmlReport, DarkPagesTurnTheInkOfPictures) {
  const std::string page = html_report({});
  EXPECT_TRUE(contains(page, "prefers-color-scheme: dark"));
  for (const char* colour : {ink::kText, ink::kSoft, ink::kGrid, ink::kSurface})
    EXPECT_TRUE(contains(page, std::string("=\"") + colour + "\"]")) << colour;
}

TEST(HtmlReport, OneRowHasNothingToStandOutFrom) {
  PlanReport report;
  report.rows = {row("uniform", 0.0122)};
  EXPECT_FALSE(contains(html_report(report), "class=\"best\""));
}

TEST(ConsoleTable, HasAColumnForEveryComparedPartAndARowForEverySequence) {
  const std::string table = console_table({row("uniform", 0.0122), {"failed", failed_score("diverged")}});
  EXPECT_TRUE(contains(table, "       gap r.m.s. gap"));
  EXPECT_TRUE(contains(table, "[cm\u00b2]"));
  EXPECT_TRUE(contains(table, "\nuniform                           12.20       0.00        0.0"));
  EXPECT_TRUE(contains(table, "\nfailed                        diverged\n"));
  EXPECT_FALSE(contains(table, "actuator"));
}

TEST(HtmlReport, EmptyPartsAreLeftOut) {
  const std::string page = html_report({});
  EXPECT_FALSE(contains(page, "<h2>"));
  EXPECT_FALSE(contains(page, "<table"));
  EXPECT_TRUE(contains(page, "</html>"));
}

}  // namespace
}  // namespace drapeplan
