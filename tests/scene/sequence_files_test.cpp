#include "film/scene/sequence_files.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/test_folder.hpp"

namespace weft::scene {
namespace {

class SequenceFiles : public support::TestFolder {
 protected:
  void SetUp() override {
    TestFolder::SetUp();
    for (const char* name : {"run_9.obj", "run_010.obj", "run_11.obj", "run_1.ply", "walk_2.obj"})
      support::write_bytes(folder_ / name, "x");
  }
  std::string names(const std::string& pattern) const {
    std::string text;
    for (const auto& file : sequence_files((folder_ / pattern).string())) text += file.filename().string() + " ";
    return text;
  }
};

TEST_F(SequenceFiles, AreThoseThatFitTheStarInTheOrderOfTheirNumbers) {
  EXPECT_EQ(names("run_*.obj"), "run_9.obj run_010.obj run_11.obj ");
  EXPECT_EQ(names("*.ply"), "run_1.ply ");
}

TEST_F(SequenceFiles, OfAFolderAreAllItsFiles) {
  EXPECT_EQ(names(""), "run_1.ply run_9.obj run_010.obj run_11.obj walk_2.obj ");
}

TEST_F(SequenceFiles, AreNoneWhereNothingFits) {
  EXPECT_EQ(names("jump_*.obj"), "");
  EXPECT_EQ(names("absent/*.obj"), "");
  EXPECT_EQ(names("run_9.obj"), "") << "one file is no sequence";
}

}  // namespace
}  // namespace weft::scene
