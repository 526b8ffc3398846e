#include "core/temporary_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.hpp"

namespace weft {
namespace {

namespace fs = std::filesystem;

class TemporaryFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / fmt::format("weft_{}_{}", info->test_suite_name(), info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(TemporaryFileTest, NothingAppearsUnderTheFinalNameBeforeCommit) {
  const fs::path file = folder_ / "deep" / "a.txt";
  TemporaryFile temporary(file);
  std::ofstream(temporary.path()) << "half";
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(temporary.path().parent_path(), folder_ / "deep");
  temporary.commit();
  EXPECT_EQ(content(file), "half");
}

TEST_F(TemporaryFileTest, FoldersAndDevicesAreNeverReplaced) {
  for (const fs::path& name : {folder_, folder_ / "", fs::path("/dev/null")}) {
    try {
      TemporaryFile temporary(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::output_failed);
      EXPECT_EQ(error.what(), name.string() + ": expected the name of a file to write, got a folder or a device");
    }
  }
}

TEST_F(TemporaryFileTest, LeavesNothingBehindWithoutCommit) {
  {
    TemporaryFile temporary(folder_ / "a.txt");
    std::ofstream(temporary.path()) << "half";
    EXPECT_EQ(entries(), 1u);
  }
  EXPECT_EQ(entries(), 0u);
}

TEST_F(TemporaryFileTest, TheSignalHandlersSweepRemovesWhatIsOpenAndKeepsWhatIsWhole) {
  write_file(folder_ / "whole.txt", "whole");
  TemporaryFile temporary(folder_ / "half.txt");
  std::ofstream(temporary.path()) << "half";
  remove_temporary_files();
  EXPECT_EQ(entries(), 1u);
  EXPECT_EQ(content(folder_ / "whole.txt"), "whole");
}

TEST_F(TemporaryFileTest, ReplacesAnOlderFileInOneGo) {
  write_file(folder_ / "a.txt", "old");
  write_file(folder_ / "a.txt", "new");
  EXPECT_EQ(content(folder_ / "a.txt"), "new");
  EXPECT_EQ(entries(), 1u);
}

TEST_F(TemporaryFileTest, SaysWhyAFolderCannotBeMade) {
  write_file(folder_ / "plain", "");
  try {
    write_file(folder_ / "plain" / "a.txt", "x");
    FAIL() << "wrote below a plain file";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::output_failed);
    EXPECT_EQ(error.what(), (folder_ / "plain" / "a.txt").string() + ": cannot make the folder: Not a directory");
  }
}

TEST_F(TemporaryFileTest, SaysWhyADiskCannotTakeTheData) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  TemporaryFile temporary(folder_ / "a.txt");
  fs::create_symlink("/dev/full", temporary.path());
  EXPECT_THROW(write_file(folder_ / "a.txt", "x"), Error);  // the same temporary name, hence the full device
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
}

}  // namespace
}  // namespace weft
