// diff and accept as their users call them: exit codes, what is said, and the files that are there afterwards.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/subprocess.hpp"
#include "image/png.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

class Diff : public support::TestFolder {
 protected:
  void write(const std::string& name, std::uint8_t level, int width = 32) const {
    image::Image image(width, 24);
    std::fill(image.rgb.begin(), image.rgb.end(), level);
    std::filesystem::create_directories((folder_ / name).parent_path());
    image::write_png(folder_ / name, image);
  }

  void expect(const std::vector<std::string>& arguments, int exit_code, const std::string& words) {
    outcome_ = run_weft(arguments, folder_);
    EXPECT_EQ(outcome_.exit_code, exit_code) << outcome_.out << outcome_.err;
    EXPECT_NE((outcome_.out + outcome_.err).find(words), std::string::npos) << outcome_.out << outcome_.err;
  }

  Outcome outcome_;
};

TEST_F(Diff, ExitCodesTellEqualDifferentMissingAndUnreadable) {
  write("a.png", 100);
  write("b.png", 130);
  write("wide.png", 100, 40);
  support::write_bytes(folder_ / "broken.png", "words");
  expect({"diff", "a.png", "a.png"}, 0, "a.png: same");
  expect({"diff", "a.png", "b.png"}, 7,
         "b.png: DIFFERS: 768 of 768 pixels differ, 768 by more than 4 levels (limit 0)");
  expect({"diff", "a.png", "wide.png"}, 7, "wide.png: 40x24 pixels, the reference has 32x24");
  expect({"diff", "none.png", "a.png"}, 8, "none.png: the reference does not exist");
  expect({"diff", "a.png", "none.png"}, 4, "none.png: the picture to test does not exist");
  expect({"diff", "a.png", "broken.png"}, 4, "broken.png: cannot be read as PNG");
  expect({"diff", "a.png"}, 2, "TEST is required");
  expect({"diff", "a.png", "b.png", "--pixel-budget", "5"}, 2, "--pixel-budget: expected a number from 0 to 1, got 5");
}

TEST_F(Diff, LimitsCanBeWidened) {
  write("a.png", 100);
  write("b.png", 130);
  expect({"diff", "a.png", "b.png", "--pixel-tolerance", "30", "--max-flip", "1", "--max-spot", "1"}, 0, "within");
  expect({"diff", "a.png", "b.png", "--pixel-budget", "1", "--max-flip", "1", "--max-spot", "1"}, 0, "within");
  expect({"diff", "a.png", "b.png", "--pixel-tolerance", "29", "--max-flip", "1", "--max-spot", "1"}, 7, "DIFFERS");
  expect({"diff", "a.png", "b.png", "--pixel-tolerance", "30", "--max-spot", "1"}, 7, "(limit 0.0005)");
}

TEST_F(Diff, FoldersNameWhatIsMissingAndWhatIsSurplus) {
  write("ref/a.png", 1);
  write("ref/gone.png", 1);
  write("out/a.png", 1);
  expect({"diff", "ref", "out"}, 7, "gone.png: missing: the reference ref/gone.png has no counterpart");
  write("out/gone.png", 1);
  write("out/new.png", 1);
  expect({"diff", "ref", "out"}, 8, "new.png: no reference: there is none for out/new.png");
  EXPECT_NE(outcome_.out.find("2 of 3 are as their references"), std::string::npos) << outcome_.out;
  expect({"diff", "ref", "out/a.png"}, 0, "a.png: same");
  expect({"diff", "ref/a.png", "out"}, 0, "a.png: same");
}

TEST_F(Diff, HeatMapAndJsonTellWhereAndHowMuch) {
  write("ref/a.png", 100);
  write("out/a.png", 104);
  expect({"diff", "ref", "out", "--heatmap", "maps", "--json"}, 7, "");
  const auto json = nlohmann::json::parse(outcome_.out);
  EXPECT_EQ(json["exit_code"], 7);
  const auto& result = json["results"][0];
  EXPECT_EQ(result["name"], "a.png");
  EXPECT_EQ(result["outcome"], "differs");
  EXPECT_EQ(result["pixels_changed"], 768);
  EXPECT_EQ(result["pixels_over"], 0);
  EXPECT_EQ(result["largest"], 4);
  EXPECT_EQ(result["heatmap"], "maps/a.png");
  EXPECT_EQ(image::read_png(folder_ / "maps/a.png").width, 32);
  expect({"diff", "ref/a.png", "out/a.png", "--heatmap", "one.png"}, 7, "");
  EXPECT_EQ(image::read_png(folder_ / "one.png").height, 24);
  expect({"diff", "ref", "out", "--heatmap", "one.png"}, 2, "--heatmap: expected a folder");
}

TEST_F(Diff, AcceptedPictureIsTheReferenceFromThenOn) {
  write("ref/a.png", 100);
  write("ref/b.png", 100);
  write("out/a.png", 130);
  write("out/b.png", 130);
  expect({"accept", "ref", "out/a.png"}, 2, "--reason is required");
  expect({"accept", "ref", "out/a.png", "--reason", " "}, 2, "--reason: expected words");
  expect({"accept", "ref", "out", "--reason", "all"}, 2, "out: expected a picture");
  expect({"accept", "ref/a.png", "out/a.png", "out/b.png", "--reason", "two"}, 2, "cannot all become ref/a.png");
  expect({"accept", "ref", "out/a.png", "out/none.png", "--reason", "half"}, 4, "none.png: does not exist");
  expect({"diff", "ref", "out"}, 7, "0 of 2 are as their references");
  expect({"accept", "ref", "out/a.png", "--reason", "brighter by design"}, 0, "ref/a.png: now as out/a.png");
  expect({"diff", "ref", "out"}, 7, "a.png: same");
  EXPECT_NE(support::read_bytes(folder_ / "ref/accepted.md").find("| brighter by design |"), std::string::npos);
  expect({"accept", "ref", "out/a.png", "--reason", "again"}, 0, "ref/a.png: is the same already");
}

}  // namespace
}  // namespace weft::cli
