#include "planner/tables/test_table.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <numbers>

namespace drapeplan {
namespace {

const std::vector<WantedColumn> kWanted{
    {TestQuantity::time, false}, {TestQuantity::displacement, true}, {TestQuantity::force, true}};

TableReading read(const std::string& text, const std::vector<WantedColumn>& wanted = kWanted) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("test_table_" + std::to_string(::getpid()) + ".csv");
  std::ofstream(file, std::ios::binary) << text;
  return read_test_table(file, wanted);
}

/// Twelve rows: k, then what `row` makes of it.
std::string rows(const std::function<std::string(int)>& row) {
  std::string text;
  for (int k = 0; k < 12; ++k) text += row(k);
  return text;
}

TEST(TestTable, ReadsWhatMachinesWrite) {
  // Bluehill: notes, names, units below, all in quotes.
  const TableReading instron = read(
      "\"Specimen label\",\"A 1\"\r\n\r\n\"Time\",\"Extension\",\"Load\"\r\n\"(s)\",\"(mm)\",\"(kN)\"\r\n" +
      rows([](int k) {
        return "\"" + std::to_string(k) + "\",\"0." + std::to_string(10 + k) + "\",\"-1.5e-3\"\r\n";
      }));
  ASSERT_TRUE(instron.errors.empty()) << instron.errors.front().text();
  EXPECT_EQ(instron.table.rows(), 12U);
  EXPECT_DOUBLE_EQ(instron.table[TestQuantity::displacement][1], 0.11e-3);
  EXPECT_DOUBLE_EQ(instron.table[TestQuantity::force][1], -1.5);
  EXPECT_EQ(instron.table.lines[0], 5);
  // testXpert: semicolons, decimal commas, units beside the names.
  const TableReading zwick = read("Standardweg [mm];Standardkraft [N]\n" + rows([](int k) {
                                    return std::to_string(k) + ",5;0," + std::to_string(k) + "\n";
                                  }));
  ASSERT_TRUE(zwick.errors.empty()) << zwick.errors.front().text();
  EXPECT_DOUBLE_EQ(zwick.table[TestQuantity::displacement][3], 3.5e-3);
  EXPECT_DOUBLE_EQ(zwick.table[TestQuantity::force][3], 0.3);
  EXPECT_FALSE(zwick.table.has(TestQuantity::time));
  // MTS: tabs, units below; other columns are not looked at.
  const TableReading mts = read("Running Time\tCrosshead\tLoad\tTime\nsec\tmm\tN\tsec\n" + rows([](int k) {
                                  return "x\t" + std::to_string(k) + "\t2\t" + std::to_string(k) + "\n";
                                }));
  ASSERT_TRUE(mts.errors.empty()) << mts.errors.front().text();
  EXPECT_EQ(mts.table[TestQuantity::time][11], 11);
  // Names of one's own.
  const TableReading own = read("a [um],b [mN]\n" + rows([](int k) { return std::to_string(k) + ",1\n"; }),
                                {{TestQuantity::displacement, true, "a"}, {TestQuantity::force, true, "b"}});
  ASSERT_TRUE(own.errors.empty()) << own.errors.front().text();
  EXPECT_DOUBLE_EQ(own.table[TestQuantity::displacement][2], 2e-6);
}

TEST(TestTable, IsNotMisledBySeparatorsInNotes) {
  for (const char* note : {"Made by us; in May\n", "Made\tby us\n", "\"Made by us; in May\"\n"}) {
    const TableReading reading = read(note + std::string("Extension (mm),Load (N)\n") +
                                      rows([](int k) { return std::to_string(k) + ",1.5,\n"; }));
    ASSERT_TRUE(reading.errors.empty()) << reading.errors.front().text();
    EXPECT_DOUBLE_EQ(reading.table[TestQuantity::force][4], 1.5);
  }
}

TEST(TestTable, IsARegularFile) {
  for (const char* name : {"/dev/zero", "/dev/null"}) {
    const TableReading reading = read_test_table(name, kWanted);
    ASSERT_EQ(reading.errors.size(), 1U);
    EXPECT_EQ(reading.errors.front().message, "cannot be read: it is no regular file");
  }
}

TEST(TestTable, SaysWhatIsWrongAndWhere) {
  const auto error = [](const std::string& text) {
    const TableReading reading = read(text);
    return reading.errors.empty() ? std::string("none") : reading.errors.front().text();
  };
  const std::string good = rows([](int k) { return std::to_string(k) + ",1\n"; });
  EXPECT_NE(error("").find("is empty"), std::string::npos);
  EXPECT_NE(error("Extension (mm),Load\n" + good).find(":1: Load: has no unit"), std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (kg)\n" + good).find("\"kg\""), std::string::npos);
  EXPECT_NE(error("Way (mm),Load (N)\n" + good).find("no row names columns for the displacement"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N),Force (N)\n" + good).find("second column for the force"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n" + good + "13,x\n").find(":14: Load: \"x\" is no number"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n" + good + "13\n").find(":14: Load: has no number"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n1,1\n").find("has 1 rows of numbers"), std::string::npos);
  EXPECT_NE(error(std::string("\xFF\xFE"
                              "a\0",
                              4))
                .find("UTF-16"),
            std::string::npos);
  EXPECT_NE(error("Extension [mm];Load [N]\n" + rows([](int) { return std::string("1.234,5;1\n"); }))
                .find("\"1.234,5\" is no number"),
            std::string::npos);
  const std::string machine = "Extension [mm];Load [N]\n";
  const auto mixed = [](int k) { return k == 7 ? std::string("1.007;1\n") : std::to_string(k) + ",5;1\n"; };
  EXPECT_NE(error(machine + rows(mixed))
                .find(":9: Extension: \"1.007\" has a decimal point, but line 2 a decimal comma"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n" + good + "1,5,2\n")
                .find(":14: has 3 cells, but line 1 names 2 columns"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n" + good + "13,+-1\n").find("\"+-1\" is no number"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n" + good + "nan,1\n").find("\"nan\" is no finite"),
            std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (kN)\n" + good + "13,1e308\n")
                .find(":14: Load: \"1e308\" is no finite number"),
            std::string::npos);
  EXPECT_NE(error(std::string("Extension (mm),Load (N)\n1,\0001\n", 30)).find(":2: has a NUL byte"),
            std::string::npos);
  EXPECT_NE(error(std::string(5000, ',')).find(":1: has more than 1000 columns"), std::string::npos);
  EXPECT_NE(error("Extension (mm),Load (N)\n" + good + std::string(5000, 'x') + "\x1b,1\n")
                .find(std::string(40, 'x') + "..."),
            std::string::npos);
}

}  // namespace
}  // namespace drapeplan
