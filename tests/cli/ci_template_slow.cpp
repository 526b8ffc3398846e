// The repository that `weft new --template ci` makes, used as its README describes. The script that its workflow runs
// must detect accidental changes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>

#include "cli/subprocess.hpp"
#include "film/image/png.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class CiRepository : public support::TestFolder {
 protected:
  void SetUp() override {
    support::TestFolder::SetUp();
    ASSERT_EQ(run_weft({"new", "repo", "--template", "ci"}, folder_).exit_code, 0);
    repo_ = folder_ / "repo";
  }

  // Runs the script of the workflow, and returns its exit code.
  int check(const std::string& options = "", const std::string& environment = "") {
    const std::string command = fmt::format("cd '{}' && {} WEFT='{}' sh pictures.sh {} >log 2>&1", repo_.string(),
                                            environment, WEFT_PROGRAM, options);
    const int status = std::system(command.c_str());
    log_ = support::read_bytes(repo_ / "log");
    return WEXITSTATUS(status);
  }

  // Applies a change, runs the check and undoes the change. Expects the exit code `code` and all strings of `found` in
  // the log.
  void expect_caught(const char* what, const std::function<void()>& change, int code,
                     const std::vector<std::string>& found, const std::string& options = "",
                     const std::string& environment = "") {
    SCOPED_TRACE(what);
    fs::copy(repo_, folder_ / "kept", fs::copy_options::recursive);
    change();
    EXPECT_EQ(check(options, environment), code) << log_;
    for (const std::string& words : found) EXPECT_TRUE(contains(log_, words)) << words << "\n" << log_;
    fs::remove_all(repo_);
    fs::rename(folder_ / "kept", repo_);
  }

  void replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = support::read_bytes(repo_ / file);
    ASSERT_NE(text.find(from), std::string::npos) << from;
    support::write_bytes(repo_ / file, text.replace(text.find(from), from.size(), to));
  }

  // Replaces the reference of the flag's video by one with a square in one of its frames.
  void change_frame(const char* frame) const {
    ASSERT_EQ(run_weft({"render", "caches/flag", "-o", "all/{frame:05}.png", "--size", "480x270"}, repo_).exit_code, 0);
    image::Metadata metadata;
    image::Image picture = image::read_png(repo_ / "all" / frame, &metadata);
    for (int y = 40; y < 80; ++y) std::fill_n(picture.pixel(40, y), 3 * 40, std::uint8_t{255});
    image::write_png(repo_ / "all" / frame, picture, metadata);
    ASSERT_EQ(run_weft({"join", "all", "-o", "references/flag.mp4", "--overwrite"}, repo_).exit_code, 0);
  }

  // Changes a square in the middle of the picture, on the cloth, by 16 levels.
  void make_hole(const std::string& file) const {
    image::Image picture = image::read_png(repo_ / file);
    for (int i = 0; i < 4; ++i) {
      std::uint8_t* pixel = picture.pixel(240 + i % 2, 130 + i / 2);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(pixel[c] ^ 16);
    }
    image::write_png(repo_ / file, picture);
  }

  // Writes the same picture with other bytes: 16 bits per channel, no metadata.
  void compress_anew(const std::string& file) const {
    const std::string before = support::read_bytes(repo_ / file);
    const image::Image picture = image::read_png(repo_ / file);
    image::Image16 deep{picture.width, picture.height, {}};
    for (const std::uint8_t value : picture.rgb) deep.rgb.push_back(static_cast<std::uint16_t>(257 * value));
    image::write_png(repo_ / file, deep);
    ASSERT_NE(support::read_bytes(repo_ / file), before);
  }

  fs::path repo_;
  std::string log_;
};

TEST_F(CiRepository, CatchesWhatIsChangedAndPassesWhatIsNot) {
  EXPECT_TRUE(
      contains(support::read_bytes(repo_ / ".github/workflows/pictures.yml"), "\n        run: sh pictures.sh\n"));
  EXPECT_EQ(check(), 8) << log_;
  ASSERT_EQ(run_weft({"accept", "references", "out", "--reason", "first pictures"}, repo_).exit_code, 0);
  ASSERT_EQ(check(), 0) << log_;
  EXPECT_TRUE(contains(log_, "\n9 of 9 match their references\n")) << log_;

  // Nine changes that a viewer would see.
  expect_caught("physics", [&] { replace("scenes/flag.toml", "wind = [8, 2, 0]", "wind = [8, 3, 0]"); }, 7,
                {"\nflag/00010.png: DIFFERS", "\nflag.mp4: 30 of 31 frames differ, the first is frame 1; ",
                 "\ndrapes/scarf.mp4: 0 of 21 frames differ"});
  expect_caught("a colour, in a folder", [&] { replace("scenes/drapes/scarf.toml", "b3202c", "b3402c"); }, 7,
                {"\ndrapes/scarf/00000.png: DIFFERS", "\nflag/00030.png: same"});
  expect_caught("the camera", [&] { replace("scenes/flag.toml", "[0, -2.4, 1.1]", "[0, -2.4, 1.12]"); }, 7,
                {"\nflag/00000.png: DIFFERS", "\nflag/00030.png: DIFFERS"});
  expect_caught("a picture that is missing", [&] { replace("scenes/flag.toml", "duration = 1.2", "duration = 1.16"); },
                7, {"\nflag/00030.png: missing", "\nflag.mp4: 30 frames, the reference has 31"});
  expect_caught("a picture that was not there",
                [&] { fs::copy_file(repo_ / "scenes/flag.toml", repo_ / "scenes/drapes/flag.toml"); }, 8,
                {"\ndrapes/flag/00020.png: no reference", "9 of 14 match their references"});
  expect_caught("one frame of a video", [&] { change_frame("00015.png"); }, 7,
                {"worst is frame 15: ", "8 of 9 match their references"});

  expect_caught("a pin that is missing",
                [&] { replace("scenes/flag.toml", "low = [0, 1]\nhigh = [0, 1]", "low = [0, 0]\nhigh = [0, 0]"); }, 7,
                {"\nflag/00010.png: DIFFERS", "\ndrapes/scarf/00020.png: same"});
  expect_caught("a colour, by 2 %", [&] { replace("scenes/flag.toml", "2f5fa8", "2f64a8"); }, 7,
                {"\nflag/00000.png: DIFFERS", "\ndrapes/scarf/00020.png: same"});
  expect_caught("a hole of four pixels", [&] { make_hole("references/drapes/scarf/00020.png"); }, 7,
                {"\ndrapes/scarf/00020.png: DIFFERS: 4 of 129600 pixels differ", "\nflag/00020.png: same"});

  // Four invisible changes.
  expect_caught("a comment", [&] { replace("scenes/flag.toml", "# A flag", "# One flag"); }, 0, {"9 of 9"});
  expect_caught("another compression", [&] { compress_anew("references/flag/00010.png"); }, 0, {"9 of 9"});
  expect_caught(
      "threads", [] {}, 0, {"9 of 9"}, "--threads 1");
  expect_caught(
      "a CPU without AVX", [] {}, 0, {"9 of 9"}, "", "GALLIUM_OVERRIDE_CPU_CAPS=sse4.1");
}

TEST_F(CiRepository, GoesOnAfterASceneThatFails) {
  replace("scenes/drapes/scarf.toml", "\"silk\"", "\"slik\"");
  EXPECT_EQ(check(), 3) << log_;
  EXPECT_TRUE(contains(log_, "did you mean silk?")) << log_;
  EXPECT_TRUE(contains(log_, "pictures.sh: scenes/drapes/scarf.toml failed with exit code 3")) << log_;
  EXPECT_TRUE(contains(log_, "references: the reference does not exist")) << log_;
  EXPECT_TRUE(contains(support::read_bytes(repo_ / "report/stats/flag.json"), "\"exit_code\": 0"));
}

}  // namespace
}  // namespace weft::cli
