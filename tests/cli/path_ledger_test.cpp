#include "tools/cli/path_ledger.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class Ledger : public support::TestFolder {
 protected:
  void SetUp() override {
    support::TestFolder::SetUp();
    support::write_bytes(folder_ / "in", "x");
    fs::create_directories(folder_ / "cache");
    support::write_bytes(folder_ / "cache/frame", "x");
    fs::create_directories(folder_ / "runs");
    paths_.reads(folder_ / "in", "the scene");
    paths_.reads_folder(folder_ / "cache", "the cache");
    paths_.searches(folder_ / "runs", "a folder of runs");
    paths_.writes("-o", folder_ / "out");
    paths_.register_output_folder("--cache", folder_ / "made");
  }
  void expect_refused(const fs::path& path, std::string_view words) {
    support::expect_error(ExitCode::usage, words, [&] { paths_.writes("--stats", path); });
  }

  PathLedger paths_;
};

TEST_F(Ledger, KnowsOneFileByAllItsNames) {
  expect_refused(folder_ / "in", "--stats: " + (folder_ / "in").string() + " is the scene, which is read");
  expect_refused(folder_ / "new/../runs/./../in", "is the scene, which is read");
  fs::create_symlink(folder_ / "in", folder_ / "link");
  fs::create_symlink("link", folder_ / "link_to_link");
  fs::create_hard_link(folder_ / "in", folder_ / "hard");
  fs::create_hard_link(folder_ / "cache/frame", folder_ / "hard_frame");
  fs::create_directory_symlink(folder_, folder_ / "runs/up");
  for (const char* name : {"link", "link_to_link", "hard", "runs/up/in", "runs/up/up/../in"})
    expect_refused(folder_ / name, "is the scene");
  expect_refused(folder_ / "hard_frame", "is the cache, which is read");
  expect_refused(folder_ / "out", "is what -o writes");
  expect_refused(folder_ / "runs/up/out", "is what -o writes");
}

TEST_F(Ledger, RefusesWhatLiesInOrAroundAnotherPlace) {
  expect_refused(folder_ / "out/stats", "lies in what -o writes");
  expect_refused(folder_ / "in/stats", "lies in the scene");
  expect_refused(folder_ / "cache/deep/stats", "lies in the cache");
  expect_refused(folder_ / "made/stats", "lies in what --cache fills");
  expect_refused(folder_, "holds ");
  expect_refused(folder_ / "runs", "is a folder of runs");
  EXPECT_NO_THROW(paths_.writes("--stats", folder_ / "runs/stats"));
  EXPECT_NO_THROW(paths_.writes("--log-json", folder_ / "outer"));
}

TEST_F(Ledger, RefusesWhatExistsUnlessItMayBeReplaced) {
  EXPECT_NO_THROW(paths_.check_absent(false));
  support::write_bytes(folder_ / "out", "x");
  support::expect_error(ExitCode::output_failed, "exists already; give --overwrite",
                        [&] { paths_.check_absent(false); });
  EXPECT_NO_THROW(paths_.check_absent(true));
  const std::set<std::string> own{"-o " + fs::canonical(folder_ / "out").string()};
  EXPECT_NO_THROW(paths_.check_absent(false, own, [](const fs::path&) { return true; }));
  support::expect_error(ExitCode::output_failed, "exists already",
                        [&] { paths_.check_absent(false, own, [](const fs::path&) { return false; }); });
  support::expect_error(ExitCode::output_failed, "exists already", [&] { paths_.check_absent(false, {"-o other"}); });
  fs::remove(folder_ / "out");
  fs::create_symlink("nothing", folder_ / "out");
  support::expect_error(ExitCode::output_failed, "exists already", [&] { paths_.check_absent(false); });
  fs::remove(folder_ / "out");
  fs::create_directories(folder_ / "out");
  support::expect_error(ExitCode::output_failed, "is a folder", [&] { paths_.check_absent(true); });
}

// For example, the name of a film has the maximum length of 255 bytes, and that of its effective scene is longer.
TEST_F(Ledger, RefusesNamesThatAreTooLongBeforeTheWork) {
  EXPECT_NO_THROW(paths_.writes("--stats", folder_ / std::string(255, 'x')));
  EXPECT_NO_THROW(paths_.check_absent(false));
  paths_.writes("-o, for the effective scene,", folder_ / std::string(256, 'x'));
  for (const bool overwrite : {false, true})
    support::expect_error(ExitCode::usage, "its name is too long", [&] { paths_.check_absent(overwrite); });
}

TEST_F(Ledger, LeavesAFileThatHoldsTheSameAlready) {
  support::write_bytes(folder_ / "effective", "same");
  paths_.writes_content("-o", folder_ / "effective", "same");
  EXPECT_NO_THROW(paths_.check_absent(false));
  support::write_bytes(folder_ / "effective", "else");
  support::expect_error(ExitCode::output_failed, "exists already", [&] { paths_.check_absent(false); });
}

}  // namespace
}  // namespace weft::cli
