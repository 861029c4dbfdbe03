#include "planner/base/output_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "mapping/error.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What a call refuses with; empty if it does not.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const WrongInput& error) {
    return error.what();
  }
  return "";
}

/// A fresh folder per test, with results below it.
class OutputFolderTest : public testing::Test {
 protected:
  OutputFolderTest()
      : root_(fs::path(testing::TempDir()) /
              ("drapeplan_output_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~OutputFolderTest() override { fs::remove_all(root_); }
  std::string refused(const std::string& verb, const std::string& log = "") const {
    return refusal([&] { OutputFolder(run_, verb, log); });
  }

  fs::path root_, run_ = root_ / "deep" / "run";
};

TEST_F(OutputFolderTest, MakesTheFolderAndTakesItBackIfNothingBegins) {
  {
    const OutputFolder folder(run_, "map");
    EXPECT_TRUE(folder);
    EXPECT_EQ(text_of(run_ / kRunLock).substr(0, 14), "drapeplan map\n");
  }
  EXPECT_TRUE(fs::is_empty(root_));
  OutputFolder(run_, "map").begin();
  EXPECT_TRUE(fs::exists(run_ / kRunLock));
}

TEST_F(OutputFolderTest, ANoFolderIsNothing) {
  OutputFolder none;
  EXPECT_FALSE(none);
  EXPECT_TRUE(none.begin().empty());
}

TEST_F(OutputFolderTest, ASecondRunIsRefusedAndToldWhoWorksThere) {
  OutputFolder first(run_, "plan");
  first.begin();
  const std::string reason = refused("plan");
  EXPECT_NE(reason.find("another run works in this folder"), std::string::npos) << reason;
  EXPECT_NE(reason.find("plan process " + std::to_string(::getpid())), std::string::npos) << reason;
  OutputFolder moved = std::move(first);
  EXPECT_FALSE(refused("plan").empty()) << "a moved owner owns the folder";
  moved = OutputFolder();
  EXPECT_EQ(refused("plan"), "");
}

TEST_F(OutputFolderTest, AKilledOwnerFreesTheFolder) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFolder folder(run_, "plan");
    folder.begin();
    (void)!::write(ready[1], "x", 1);
    for (;;) ::pause();
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_FALSE(refused("plan").empty());
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(refused("plan"), "");
  EXPECT_NE(refused("map").find("holds results of `plan`"), std::string::npos);
}

TEST_F(OutputFolderTest, SetsAsideResultsOfAnEarlierRunAndNothingElse) {
  OutputFolder(run_, "simulate").begin();
  for (const char* name : {"result.json", "ply_020.vtu", "ply.pvd", "schedule.csv.partial",
                           "schedule.csv-metadata.json", "schedule_wide.csv", "schedule_ros2.yaml",
                           "pattern.dxf", "fibres.csv", "fibres.csv-metadata.json", "evaluations.jsonl"})
    write_text(run_ / name, "first");
  write_text(run_ / "notes.txt", "mine");
  {
    OutputFolder second(run_, "simulate");
    EXPECT_TRUE(fs::exists(run_ / "result.json")) << "nothing changes before the run begins";
    EXPECT_EQ(second.begin({"evaluations.jsonl"}), run_ / "earlier-1");
  }
  EXPECT_FALSE(fs::exists(run_ / "result.json"));
  for (const char* name :
       {"result.json", "ply_020.vtu", "ply.pvd", "schedule.csv.partial", "schedule.csv-metadata.json",
        "schedule_wide.csv", "schedule_ros2.yaml", "pattern.dxf", "fibres.csv", "fibres.csv-metadata.json"})
    EXPECT_EQ(text_of(run_ / "earlier-1" / name), "first") << name;
  EXPECT_EQ(text_of(run_ / "notes.txt"), "mine");
  EXPECT_EQ(text_of(run_ / "evaluations.jsonl"), "first");
  write_text(run_ / "result.json", "second");
  EXPECT_EQ(OutputFolder(run_, "simulate").begin(), run_ / "earlier-2");
  EXPECT_EQ(text_of(run_ / "earlier-2" / "result.json"), "second");
  EXPECT_EQ(text_of(run_ / "earlier-1" / "result.json"), "first");
  EXPECT_TRUE(OutputFolder(run_, "simulate").begin().empty()) << "nothing was left";
}

TEST_F(OutputFolderTest, RefusesResultsOfAnotherVerbAndThoseOfNobody) {
  OutputFolder(run_, "plan").begin();
  write_text(run_ / "result.json", "of the plan");
  const std::string lock = text_of(run_ / kRunLock);
  for (const char* verb : {"simulate", "map", "study"})
    EXPECT_NE(refused(verb).find("holds results of `plan`"), std::string::npos) << verb;
  EXPECT_EQ(text_of(run_ / kRunLock), lock);
  fs::remove(run_ / kRunLock);
  EXPECT_NE(refused("plan").find("holds result.json"), std::string::npos);
  EXPECT_NE(refused("plan", "evaluations.jsonl").find("holds result.json"), std::string::npos);
  write_text(run_ / "evaluations.jsonl", "a log");
  EXPECT_EQ(refused("plan", "evaluations.jsonl"), "");
  EXPECT_FALSE(fs::exists(run_ / kRunLock)) << "nothing was begun";
  EXPECT_EQ(text_of(run_ / "result.json"), "of the plan");
}

TEST_F(OutputFolderTest, ALockThatIsNotOursIsLeftAlone) {
  fs::create_directories(run_);
  write_text(run_ / kRunLock, "somebody else's\n");
  EXPECT_NE(refused("map").find("left as it is"), std::string::npos);
  EXPECT_EQ(text_of(run_ / kRunLock), "somebody else's\n");
  fs::remove(run_ / kRunLock);
  write_text(root_ / "target", "");
  fs::create_symlink(root_ / "target", run_ / kRunLock);
  EXPECT_FALSE(refused("map").empty());
  fs::remove(run_ / kRunLock);
  ASSERT_EQ(::mkfifo((run_ / kRunLock).c_str(), 0666), 0);
  EXPECT_FALSE(refused("map").empty());
  EXPECT_TRUE(fs::is_fifo(run_ / kRunLock));
}

TEST_F(OutputFolderTest, PlacesThatCannotBeAFolderAreNamedWithTheReason) {
  write_text(root_ / "file", "");
  fs::create_symlink("loop", root_ / "loop");
  fs::create_symlink("nowhere", root_ / "dangling");
  const auto reason = [](const fs::path& place) { return refusal([&] { OutputFolder(place, "map"); }); };
  EXPECT_NE(reason(root_ / "file").find("is no folder"), std::string::npos);
  EXPECT_NE(reason(root_ / "file" / "run").find("Not a directory"), std::string::npos);
  EXPECT_NE(reason(root_ / "loop" / "run").find("symbolic links"), std::string::npos);
  EXPECT_FALSE(reason(root_ / "dangling").empty());
  EXPECT_NE(reason(root_ / std::string(300, 'x')).find("too long"), std::string::npos);
  EXPECT_NE(reason("/proc/nope").find("/proc/nope"), std::string::npos);
  EXPECT_EQ(reason(root_ / "slash" / ""), "");
  EXPECT_FALSE(fs::exists(root_ / "slash"));
  if (::geteuid() == 0) return;  // who may do everything is not refused
  fs::create_directory(root_ / "read-only");
  fs::permissions(root_ / "read-only", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_NE(reason(root_ / "read-only").find("Permission denied"), std::string::npos);
}

TEST_F(OutputFolderTest, ASingleFileReplacesOnlyItsKindOrNothing) {
  const auto reason = [](const fs::path& file) {
    return refusal([&] { try_output_file(file, "drapeplan state ", "a saved state"); });
  };
  EXPECT_EQ(reason(root_ / "new.state"), "");
  EXPECT_TRUE(fs::is_empty(root_)) << "trying leaves nothing";
  write_text(root_ / "old.state", "drapeplan state 3\n...");
  EXPECT_EQ(reason(root_ / "old.state"), "");
  EXPECT_EQ(text_of(root_ / "old.state"), "drapeplan state 3\n...");
  write_text(root_ / "case.json", "{\"format\": \"drapeplan-case 1\"}");
  write_text(root_ / "empty", "");
  EXPECT_NE(reason(root_ / "case.json").find("is not a saved state"), std::string::npos);
  EXPECT_NE(reason(root_ / "empty").find("is not a saved state"), std::string::npos);
  ASSERT_EQ(::mkfifo((root_ / "pipe").c_str(), 0666), 0);
  fs::create_symlink(root_ / "old.state", root_ / "link");
  for (const fs::path& place : {root_ / "pipe", root_ / "link", root_, fs::path("/dev/null")})
    EXPECT_NE(reason(place).find("no regular file"), std::string::npos) << place;
  EXPECT_NE(reason(root_ / "none" / "x.state").find("No such file"), std::string::npos);
  EXPECT_NE(reason(root_ / "empty" / "x.state").find("Not a directory"), std::string::npos);
  EXPECT_FALSE(reason(root_ / std::string(250, 'x')).empty()) << "no room for the name beside";
}

}  // namespace
}  // namespace drapeplan
