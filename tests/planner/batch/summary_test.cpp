// What is said of several plans: every case has a line, whatever became of it.
#include "planner/batch/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/batch/run_folders.hpp"

namespace drapeplan {
namespace {

nlohmann::json planned(bool accepted) {
  return {{"baselines", {{"uniform", {{"objective", 30.0}}}, {"wave", {{"objective", 28.0}}}}},
          {"best",
           {{"score", {{"objective", 21.0}, {"max_gap", 0.0095}, {"max_boundary_offset", 0.006}}},
            {"acceptance",
             {{"accepted", accepted},
              {"tolerances",
               {{{"part", "max_gap"}, {"tolerance", 0.001}},
                {{"part", "max_boundary_offset"}, {"tolerance", 0.002}}}}}}}},
          {"front",
           {{{"boundary_tolerance", 0.001}, {"gap_floor", 0.02}},
            {{"boundary_tolerance", 0.005}, {"gap_floor", 0.0037}},
            {{"boundary_tolerance", nullptr}, {"gap_floor", 0.002}}}},
          {"interrupted", false},
          {"evaluations", 400},
          {"wall_seconds", 600.0}};
}

TEST(Summary, TakesTheFloorAtTheEdgeThatIsAllowed) {
  const PlannedLine line = planned_line("a.json", "out/a", planned(false));
  EXPECT_EQ(line.status, "not accepted");
  EXPECT_EQ(line.gap_floor, 0.0037);
  EXPECT_EQ(line.optimised, 21.0);
  EXPECT_EQ(planned_line("a.json", "out/a", planned(true)).status, "accepted");
  nlohmann::json anywhere = planned(false);
  anywhere["front"].erase(1);
  EXPECT_EQ(planned_line("a.json", "out/a", anywhere).gap_floor, 0.002) << "wherever the edge lies";
}

TEST(Summary, HasALineForWhatWasNotPlanned) {
  const PlannedLine wrong =
      planned_line("b.json", {}, {{"case", "b.json"}, {"status", "wrong input"}, {"reason", "no mold"}});
  EXPECT_EQ(wrong.status, "wrong input");
  EXPECT_TRUE(std::isnan(wrong.optimised));
  nlohmann::json stopped = planned(false);
  stopped["interrupted"] = true;
  stopped["message"] = "interrupted, --resume goes on";
  const std::string text = summary_text({wrong, planned_line("c.json", "out/c", stopped)});
  EXPECT_NE(text.find("0 of 2 drapes are accepted, 1 interrupted, 1 wrong input."), std::string::npos)
      << text;
  EXPECT_NE(text.find("9.50"), std::string::npos) << text;
}

TEST(RunFolders, AreNamedByTheFileOrByTheUser) {
  EXPECT_EQ(run_folders({"cases/a.json"}, "x").front(), "x");
  EXPECT_EQ(run_folders({"cases/a.json"}, "").front(), "out/a");
  EXPECT_EQ(run_folders({"cases/a.json", "b.json"}, "x")[1], "x/b");
  const std::vector<std::string> twins{"a.json", "other/a.json"};
  ASSERT_EQ(shared_folders(twins, run_folders(twins, "x")).size(), 1u);
  EXPECT_EQ(shared_folders(twins, run_folders(twins, "x")).front().file, "other/a.json");
}

}  // namespace
}  // namespace drapeplan
