#include "planner/study/study.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "planner/drape/problem.hpp"
#include "planner/search/evaluation_log.hpp"
#include "planner/study/files.hpp"
#include "planner/study/runner.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

std::string shipped(const std::string& name) {
  return std::string(DRAPEPLAN_SOURCE_DIR) + "/cases/" + name + ".json";
}

/// A study of a strip that falls for a moment.
StudySubject short_strip() {
  return {shipped("cantilever-150"), {"duration=0.02 s", "fem.mesh_size=12.5 mm"}};
}

StudyRun run_of(double gap, double offset) {
  StudyRun run;
  run.valid = true;
  run.figures = {{"gap", gap}, {"boundary_offset", offset}};
  run.places = {{0, 0, 0}, {1, 0, 0}};
  run.shear_deg = {0, 2};
  return run;
}

TEST(StudyErrors, AreTheLargestOfTheRuns) {
  const auto errors = study_errors({run_of(1.1, 2), run_of(1, 2.5)}, {run_of(1, 2), run_of(1, 2)}, true);
  EXPECT_NEAR(errors.at("gap"), 0.1, 1e-15);
  EXPECT_NEAR(errors.at("boundary_offset"), 0.5, 1e-15);
  EXPECT_NEAR(errors.at("relative"), 0.25, 1e-15);
  EXPECT_EQ(errors.at("places"), 0);
}

TEST(StudyErrors, OfPlacesAndShearAreRootMeanSquares) {
  StudyRun moved = run_of(1, 2);
  moved.places[1] = {1, 0.2, 0};
  moved.shear_deg[0] = 0.5;
  const auto errors = study_errors({moved}, {run_of(1, 2)}, true);
  EXPECT_NEAR(errors.at("places"), 0.2 / std::sqrt(2), 1e-15);
  EXPECT_NEAR(errors.at("shear_deg"), 0.5 / std::sqrt(2), 1e-15);
}

TEST(StudyErrors, OfAFailedRunAreNone) {
  StudyRun failed = run_of(1, 2);
  failed.valid = false;
  EXPECT_TRUE(study_errors({failed}, {run_of(1, 2)}, true).empty());
}

TEST(StudySubject, SaysWhatAFidelityChanges) {
  const StudySubject subject(shipped("flexdraper-5x5"), {});
  const Settings changes = subject.changes_of("search");
  ASSERT_FALSE(changes.empty());
  const FemOptions direct = subject.whole().fidelities.at("search");
  const FemOptions through = subject.with(changes).fidelities.at(kReport);
  EXPECT_EQ(through.mesh_size, direct.mesh_size);
  EXPECT_EQ(through.mass_scaling, direct.mass_scaling);
  EXPECT_EQ(through.time_scaling, direct.time_scaling);
  EXPECT_EQ(through.fibre_mass_scaling, direct.fibre_mass_scaling);
}

TEST(StudySubject, SchedulesDifferAndBeginWithTheBaselines) {
  const StudySubject subject(shipped("flexdraper-quick"), {});
  const std::vector<Schedule> schedules = subject.schedules(24);
  ASSERT_EQ(schedules.size(), 24U);
  std::set<std::uint64_t> hashes;
  for (const Schedule& schedule : schedules) hashes.insert(schedule_hash(schedule));
  EXPECT_EQ(hashes.size(), 24U);
  // Free strokes in turn with waves: no gripper is early, or late, in all of them.
  for (const int gripper : {0, 4, 8}) {
    int early = 0, late = 0;
    for (size_t k = 3; k < schedules.size(); k += 2) {
      const auto& path = schedules[k].paths;
      double mean = 0;
      for (const auto& knots : path) mean += knots[knots.size() - 2].time / double(path.size());
      (path[size_t(gripper)][path[size_t(gripper)].size() - 2].time < mean ? early : late)++;
    }
    EXPECT_GE(std::min(early, late), 2) << gripper;
  }
  const DrapeProblem problem(subject.base());
  EXPECT_EQ(schedule_hash(schedules[0]),
            schedule_hash(to_schedule(problem.frame(), uniform_strokes(problem.frame()))));
  EXPECT_LE(schedules.back().largest_velocity(), problem.frame().rig.max_velocity * 1.001);
}

TEST(StudySubject, SettingsThatTheCaseCannotHaveAreFailedRuns) {
  const std::vector<StudyRun> runs = short_strip().run({{"fem.mesh_size", "0 mm"}}, {});
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_FALSE(runs[0].valid);
  EXPECT_NE(runs[0].reason.find("mesh_size"), std::string::npos) << runs[0].reason;
}

TEST(StudySubject, ComparesMeshesAtTheSamePoints) {
  const StudySubject subject = short_strip();
  const StudyRun coarse = subject.run({}, {}).front(),
                 fine = subject.run({{"fem.mesh_size", "6.25 mm"}}, {}).front();
  ASSERT_TRUE(coarse.valid && fine.valid);
  ASSERT_EQ(coarse.places.size(), fine.places.size());
  const double fall = 0.5 * 9.81 * 0.02 * 0.02;  // of a free body: no point falls further
  const auto errors = study_errors({coarse}, {fine}, false);
  EXPECT_GT(errors.at("places"), 0);
  EXPECT_LE(errors.at("places"), 0.2 * fall);
}

TEST(StudyRunner, ResumesWithoutRunningAgain) {
  const fs::path folder = fs::temp_directory_path() / "drapeplan_study_test";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const StudySubject subject = short_strip();
  const std::vector<StudyJob> jobs{{{}, {}}, {{{"fem.mass_scaling", "40"}}, {}}};
  int runs = 0;
  const auto count = [&runs](const std::string&, int, int) { ++runs; };
  const StudyRunnerOptions options{folder / kStudyLog, 1, 1};
  const std::vector<StudyRun> first = StudyRunner(subject, options, count).run("sweep", jobs);
  EXPECT_EQ(runs, 2);
  fs::resize_file(options.log, fs::file_size(options.log) - 7);  // killed while it wrote the last line
  const std::vector<StudyRun> second = StudyRunner(subject, options, count).run("sweep", jobs);
  EXPECT_EQ(runs, 3);
  const std::vector<StudyRun> third = StudyRunner(subject, options, count).run("sweep", jobs);
  EXPECT_EQ(runs, 3) << "what a resumed study added must be readable";
  for (const auto& list : {second, third}) {
    EXPECT_EQ(list[0].figures, first[0].figures);
    EXPECT_EQ(list[1].figures, first[1].figures);
    EXPECT_EQ(list[1].places, first[1].places);
  }
  fs::remove_all(folder);
}

TEST(Study, ChoosesTheCheapestFidelitiesThatAreGoodEnough) {
  const auto point = [](const char* mesh, double seconds, double error) {
    StudyPoint result{"mesh size", {{"fem.mesh_size", mesh}}, {StudyRun()}, {{"relative", error}}, {}};
    result.runs[0].cpu_seconds = seconds;
    return result;
  };
  Study study;
  study.points = {point("5 mm", 100, 0.003), point("7 mm", 40, 0.009), point("10 mm", 10, 0.05)};
  study.schedules = 24;
  study.ranks = {{.name = "",
                  .settings = {{"fem.mesh_size", "10 mm"}},
                  .cpu_seconds = 5,
                  .spearman = 0.95,
                  .kendall = 0.8,
                  .compared = 24},
                 {.name = "",
                  .settings = {{"fem.mesh_size", "15 mm"}},
                  .cpu_seconds = 1,
                  .spearman = 0.92,
                  .kendall = 0.8,
                  .compared = 24},
                 {.name = "",
                  .settings = {{"fem.mesh_size", "20 mm"}},
                  .cpu_seconds = 0.3,
                  .spearman = 0.8,
                  .kendall = 0.6,
                  .compared = 24},
                 {.name = "",
                  .settings = {{"fem.mesh_size", "30 mm"}},
                  .cpu_seconds = 0.1,
                  .spearman = 0.4,
                  .kendall = 0.2,
                  .compared = 24}};
  const std::map<std::string, Settings> chosen = chosen_fidelities(study);
  EXPECT_EQ(chosen.at("report").at("fem.mesh_size"), "7 mm");
  EXPECT_EQ(chosen.at("search").at("fem.mesh_size"), "15 mm");
  EXPECT_EQ(chosen.at("screen").at("fem.mesh_size"), "20 mm");
}

TEST(Study, TextAndJsonNameWhatFailed) {
  Study study;
  study.case_name = "strip";
  StudyRun failed;
  failed.reason = "a fibre is torn";
  study.points = {{"mass scaling", {{"fem.mass_scaling", "400"}}, {failed}, {}, {}}};
  EXPECT_NE(study_text(study).find("a fibre is torn"), std::string::npos);
  EXPECT_EQ(study_json(study)["points"][0]["reason"], "a fibre is torn");
}

}  // namespace
}  // namespace drapeplan
