// The program as unpacked from an archive: a loader starts it from its own folder. tests/packaging/ makes a whole
// archive and runs it in an otherwise empty root; in this test, the libraries are those of the system.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "cli/cached_run.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class UnpackedProgram : public CachedRun {
 protected:
  void SetUp() override {
    CachedRun::SetUp();
    const fs::path built(WEFT_PROGRAM);
    for (const char* folder : {"bin", "lib", "libexec"}) fs::create_directories(top_ / folder);
    for (const char* name : {"weft", "weft-tools"}) {
      fs::copy_file(WEFT_START, top_ / "bin" / name);
      fs::copy_file(fs::path(built).replace_filename(name), top_ / "libexec" / name);
    }
    fs::copy_file(kLoader, loader_);
  }

  // Runs the program in the folder of the test, with an empty environment.
  Outcome unpacked(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && exec env -i '" + (top_ / "bin/weft").string() + "' " +
                                arguments + " >out 2>err";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, support::read_bytes(folder_ / "out"),
            support::read_bytes(folder_ / "err")};
  }

  static constexpr const char* kLoader = "/lib64/ld-linux-x86-64.so.2";
  // The name contains characters that are special in lists of folders and to the loader.
  const fs::path top_ = fs::path(::testing::TempDir()) / fmt::format("weft $ORIGIN:{}", ::getpid());
  const fs::path loader_ = top_ / "lib/ld-linux-x86-64.so.2";

  void TearDown() override {
    fs::remove_all(top_);
    CachedRun::TearDown();
  }
};

TEST_F(UnpackedProgram, BecomesItsToolsAndStartsItselfAgain) {
  EXPECT_EQ(unpacked("--version").exit_code, 0);
  expect_exit(unpacked("farm status none"), 4, "none: expected the folder that weft farm submit was given");
  const Outcome sweep =
      unpacked("sweep s.toml --set time.duration=0.08,0.12 -o sweep --size 64x36 --quality draft --threads 1");
  EXPECT_EQ(sweep.exit_code, 0) << sweep.err;
  EXPECT_TRUE(fs::exists(folder_ / "sweep/table.csv"));
}

TEST_F(UnpackedProgram, GoesOnWithTheCacheOfTheBuiltOne) {
  expect_well({"simulate", "s.toml", "--cache", "whole"});
  expect_well({"simulate", "s.toml", "--cache", "a", "--frames", "0:5"});
  expect_exit(unpacked("simulate s.toml --cache a --resume --progress none --size 64x36 --quality draft"), 0);
  EXPECT_EQ(hash_of_frames("a", kFrames), hash_of_frames("whole", kFrames));
}

TEST_F(UnpackedProgram, NamesThePartThatIsMissing) {
  fs::remove(top_ / "libexec/weft-tools");
  const Outcome tools = unpacked("doctor");
  EXPECT_NE(tools.exit_code, 0);
  EXPECT_TRUE(contains(tools.err, "libexec/weft-tools")) << tools.err;
  fs::remove(loader_);
  const Outcome outcome = unpacked("--version");
  expect_exit(outcome, 1, loader_.string());
  EXPECT_TRUE(contains(outcome.err, "unpack the archive as a whole")) << outcome.err;
}

}  // namespace
}  // namespace weft::cli
