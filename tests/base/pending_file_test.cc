#include "softforce/base/pending_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "softforce/base/input_error.h"

namespace softforce::base {
namespace {

namespace fs = std::filesystem;

void Write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string Read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A folder of the running test's own.
fs::path FreshFolder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(testing::TempDir()) / "pending_file_test" / test->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

TEST(PendingFile, KeepsTheExtensionSoThatWritersChooseTheRightFormat) {
  EXPECT_EQ(PendingFile("out/overlay.mp4").temporary(), fs::path("out/overlay.partial.mp4"));
}

TEST(PendingFile, TakesItsNameOnceCommitted) {
  PendingFile file(FreshFolder() / "forces.csv");
  Write(file.temporary(), "frame");
  ASSERT_FALSE(fs::exists(file.path()));

  file.Commit();

  EXPECT_EQ(Read(file.path()), "frame");
  EXPECT_FALSE(fs::exists(file.temporary()));
}

TEST(PendingFile, LeavesAnOlderFileAloneIfNeverCommitted) {
  const fs::path path = FreshFolder() / "forces.csv";
  Write(path, "old");
  fs::path temporary;
  {
    PendingFile file(path);
    temporary = file.temporary();
    Write(temporary, "half of the n");
  }
  EXPECT_EQ(Read(path), "old");
  EXPECT_FALSE(fs::exists(temporary));
}

TEST(PendingFile, HandsItsDutyOverWhenMoved) {
  PendingFile target = [] {
    PendingFile source(FreshFolder() / "forces.csv");
    Write(source.temporary(), "frame");
    return PendingFile(std::move(source));
  }();

  EXPECT_EQ(Read(target.temporary()), "frame");
}

TEST(PendingFile, RefusesToCommitWhatCannotBeRenamed) {
  PendingFile file(FreshFolder() / "never_written.csv");
  EXPECT_THROW(file.Commit(), InputError);
}

}  // namespace
}  // namespace softforce::base
