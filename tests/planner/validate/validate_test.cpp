// Comparisons with outside data, but those of elements, which tests of verification play; their judge and documents.
#include "planner/validate/validate.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "planner/validate/files.hpp"

namespace drapeplan {
namespace {

const Comparison& named(const std::vector<Comparison>& list, const std::string& text) {
  for (const Comparison& one : list) {
    if ((one.group + ": " + one.name).find(text) != std::string::npos) return one;
  }
  throw std::runtime_error("no comparison " + text);
}

void expect_agreement(const std::string& text, size_t rows) {
  const ComparisonResult result = run_comparison(named(comparisons(), text));
  EXPECT_GE(result.findings.rows.size(), rows) << text;
  for (const ValidationRow& row : result.findings.rows)
    EXPECT_NE(row.agreement(), Agreement::differs)
        << row.what << ": " << row.ours << " instead of " << row.reference << ": " << row.why;
}

TEST(Validation, TheMappingGoesWhereKinDrapeGoes) {
  expect_agreement("mapping: net on the article's mold", 7);
  expect_agreement("mapping: net on a sphere", 11);
}

TEST(Validation, LawsOfBiasExtensionAndPictureFrameFitEachOther) { expect_agreement("Twintex: laws", 8); }

TEST(Validation, StripsBendAsOtherProgramsSay) {
  expect_agreement("bending: softening strip", 3);
  expect_agreement("bending: softening strip, its law from its shape", 4);
  expect_agreement("bending: two moduli", 3);
}

TEST(Validation, NamesASourceAndAToleranceInEveryRow) {
  for (const char* text : {"mapping: net on a sphere", "Twintex: laws", "bending: softening strip"}) {
    for (const ValidationRow& row : run_comparison(named(comparisons(), text)).findings.rows) {
      EXPECT_FALSE(row.what.empty());
      EXPECT_FALSE(row.source.empty()) << row.what;
      EXPECT_GT(row.tolerance, 0) << row.what;
      EXPECT_TRUE(row.judged || !row.why.empty()) << row.what;
    }
  }
}

TEST(Validation, ARowDiffersPastItsToleranceAndIfThereIsNoNumber) {
  ValidationRow row = within_share("x", "mm", -10, -10.9, 0.1, "source");
  EXPECT_EQ(row.agreement(), Agreement::agrees);
  row.ours = -11.1;
  EXPECT_EQ(row.agreement(), Agreement::differs);
  row.ours = std::nan("");
  EXPECT_EQ(row.agreement(), Agreement::differs);
  row.judged = false;
  EXPECT_EQ(row.agreement(), Agreement::context);
}

std::vector<ComparisonResult> some_results() {
  ValidationRow wrong = within_share("length | of <it>", "mm", 1, 2, 0.1, "a book");
  wrong.why = "the book is of another edition";
  const Comparison stopped{"b", "what stops",
                           []() -> Findings { throw std::runtime_error("the disk is full"); }};
  return {{"a", "lengths", {{within_share("width", "mm", 1, 1, 0.1, "a book"), wrong}}}, run_comparison(stopped)};
}

TEST(Validation, WhatStopsIsARowThatDiffersAndSaysWhy) {
  const ComparisonResult stopped = some_results().back();
  ASSERT_EQ(stopped.findings.rows.size(), 1U);
  EXPECT_EQ(stopped.findings.rows[0].agreement(), Agreement::differs);
  EXPECT_NE(stopped.findings.rows[0].why.find("the disk is full"), std::string::npos);
}

TEST(Validation, DocumentsKeepARowThatDiffersAndSayWhy) {
  const std::vector<ComparisonResult> results = some_results();
  const nlohmann::json document = validation_json(results);
  EXPECT_EQ(document["failures"], nlohmann::json({"a: length | of <it>", "b: what stops"}));
  EXPECT_EQ(document["verdicts"]["agrees"], 1);
  EXPECT_EQ(document["verdicts"]["differs"], 2);
  ASSERT_EQ(document["rows"].size(), 3U);
  for (const char* key : {"reference", "ours", "tolerance", "verdict", "source"})
    EXPECT_TRUE(document["rows"][0].contains(key)) << key;
  EXPECT_EQ(document["rows"][1]["why"], "the book is of another edition");
  EXPECT_TRUE(document["rows"][2]["ours"].is_null());
  EXPECT_NE(validation_text(results).find("why: the book is of another edition"), std::string::npos);
  EXPECT_NE(validation_text(results).find("3 rows: 1 agree, 2 differ"), std::string::npos);
  const std::string table = validation_markdown(results);
  EXPECT_NE(table.find("| length \\| of <it> | 1 mm | 2 | 0.1 (10 %) | **differs**: the book"), std::string::npos)
      << table;
  EXPECT_NE(validation_page(results).find("length | of &lt;it&gt;"), std::string::npos);
}

TEST(Validation, HasEveryGroup) {
  std::set<std::string> groups;
  for (const Comparison& one : comparisons()) groups.insert(one.group);
  EXPECT_EQ(groups, (std::set<std::string>{"Twintex", "bending", "mapping", "shells"}));
}

}  // namespace
}  // namespace drapeplan
