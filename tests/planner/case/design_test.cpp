#include "planner/case/design.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "planner/case/file.hpp"

namespace drapeplan {
namespace {

const std::filesystem::path kQuick =
    std::filesystem::path(DRAPEPLAN_SOURCE_DIR) / "cases/flexdraper-quick.json";

TEST(Design, AVariableIsARangeInItsOwnUnit) {
  const DesignVariable offset{"grippers.joint_offset", "0 mm", "5 mm"};
  EXPECT_EQ(override_of(offset, 0.25), "grippers.joint_offset=\"1.25 mm\"");
  const DesignVariable share{"grippers.interlinks.closing.1", "0.5", "1"};
  EXPECT_EQ(override_of(share, 0.5), "grippers.interlinks.closing.1=0.75");
  EXPECT_FALSE(range_of({"a", "0 mm", "1 m"})) << "two units";
  EXPECT_FALSE(range_of({"a", "mm", "1 mm"}));
  EXPECT_FALSE(range_of({"a", "0 mm", "inf mm"}));
}

TEST(Design, ACaseIsChangedAndCheckedAnew) {
  const Case base = read_case(kQuick).definition;
  const CaseReading changed = changed_case(base, {override_of({"grippers.joint_offset", "0 mm", "4 mm"}, 0.5),
                                                  "grippers.interlinks.length=\"98 mm\""});
  ASSERT_TRUE(changed.errors.empty()) << changed.errors.front().text();
  EXPECT_DOUBLE_EQ(changed.definition.grippers->joint_offset, 0.002);
  EXPECT_EQ(changed.definition.grippers->interlinks->lengths.size(), 12u);
  EXPECT_EQ(changed.definition.name, base.name);
  const CaseReading refused = changed_case(base, {"grippers.spacing=\"1 mm\""});
  ASSERT_FALSE(refused.errors.empty());
  EXPECT_EQ(refused.errors.front().path, "/grippers/spacing");
}

TEST(Design, WrongVariablesAreNamedWithTheirPlace) {
  const CaseReading reading =
      read_case(kQuick, {R"(optimise.design=[{"path": "grippers.joint_ofset", "from": "0 mm", "to": "1 mm"},
                                   {"path": "score.target_gap", "from": "0 mm", "to": "1 mm"},
                                   {"path": "grippers.pad_radius", "from": "10 mm", "to": "5 mm"},
                                   {"path": "grippers.pad_radius", "from": "10 mm", "to": "2 cm"}])"});
  ASSERT_EQ(reading.errors.size(), 5u);
  EXPECT_EQ(reading.errors[0].path, "/optimise/design/0/path");
  EXPECT_NE(reading.errors[0].message.find("grippers.joint_offset"), std::string::npos);
  EXPECT_NE(reading.errors[1].message.find("judged"), std::string::npos);
  EXPECT_EQ(reading.errors[2].path, "/optimise/design/2/to");
  EXPECT_EQ(reading.errors[3].path, "/optimise/design/3/path");
  EXPECT_EQ(reading.errors[4].path, "/optimise/design/3/to");
}

}  // namespace
}  // namespace drapeplan
