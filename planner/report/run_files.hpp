// Files of simulated drapes and plans in a run directory.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "planner/diagnosis/diagnosis.hpp"
#include "planner/page/page.hpp"
#include "planner/report/picture.hpp"
#include "planner/schedule/robot_files.hpp"
#include "planner/search/plan.hpp"
#include "planner/trust/claim.hpp"

namespace drapeplan {

/// All terms of a model in one line: "[shell, 3 section points] [gravity]".
std::string terms_line(const Model& model);

/// The panel of one drape for `drape_picture`.
DrapePanel drape_panel(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity,
                       const std::string& title);

/// The published results that a case names, as rows of a table.
std::vector<ReportRow> reference_rows(const Case& definition);

/// All that a drape and its mapping are to be warned of, as notes of a page.
std::vector<std::string> warning_notes(const DrapeProblem& problem, const Drape& drape,
                                       const std::string& fidelity);

/// The scores of one drape: that which the objective takes, and the other one of a ply that was pressed.
std::vector<ReportRow> drape_rows(const std::string& name, const Drape& drape);

/// Why a drape is as it is: one paragraph, what would change it, the folds, and one picture of them and of
/// the grippers whose strokes matter.
ReportReasons reasons_report(const DrapeProblem& problem, const Drape& drape, const std::string& fidelity,
                             const Diagnosis& diagnosis);

/// The case with its design, in a run directory; it runs on its own.
inline constexpr const char* kDesignFile = "design.json";

/// Writes all files of a plan but result.json and resolved.json: schedule.json and the files for a robot of
/// the best, schedules of the baselines, contour picture, charts, VTU and PVD, report.html.
/// @param cycle  of the robot's controller [s].
void write_plan(const std::filesystem::path& folder, const DrapeProblem& problem, const PlanResult& result,
                const PlanTrust& trust = {}, const Diagnosis& diagnosis = {}, double cycle = kDefaultCycle);

/// Of these, what people look at: contour picture, charts, VTU and PVD, and report.html as the last one. All
/// depends on the arguments only.
/// @param notes  more of them for the page.
void write_plan_page(const std::filesystem::path& folder, const DrapeProblem& problem,
                     const PlanResult& result, const PlanTrust& trust, const Diagnosis& diagnosis,
                     const std::vector<std::string>& notes = {});

/// result.json of a plan (plan_results.cpp).
nlohmann::json plan_json(const DrapeProblem& problem, const PlanResult& result, const PlanTrust& trust,
                         const Diagnosis& diagnosis);

/// The comparison as text: one row per reference and drape.
std::string comparison_table(const DrapeProblem& problem, const PlanResult& result);

}  // namespace drapeplan
