// The commands diff and accept, as users call them: exit codes, messages, and the files that exist afterwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/subprocess.hpp"
#include "film/image/png.hpp"
#include "film/video/encoder.hpp"
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
    EXPECT_TRUE(contains(outcome_.out + outcome_.err, words)) << outcome_.out << outcome_.err;
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
         "b.png: DIFFERS: 768 of 768 pixels differ, 768 by more than 4 levels (limit 1: 2e-05 of all pixels)");
  expect({"diff", "a.png", "wide.png"}, 7, "wide.png: 40x24 pixels, the reference has 32x24");
  expect({"diff", "none.png", "a.png"}, 8, "none.png: the reference does not exist");
  expect({"diff", "a.png", "none.png"}, 4, "none.png: the picture to test does not exist");
  expect({"diff", "a.png", "broken.png"}, 4, "broken.png: cannot be read as PNG");
  expect({"diff", "a.png"}, 2, "TEST is required");
  expect({"diff", "a.png", "b.png", "--pixel-budget", "5"}, 2, "--pixel-budget: expected a number from 0 to 1, got 5");
}

// As a folder without permission, which root has everywhere, a link to itself causes an error that is not "missing".
TEST_F(Diff, FoldersThatCannotBeReadAreUnreadable) {
  write("ref/a.png", 100);
  write("out/a.png", 100);
  std::filesystem::create_symlink("loop", folder_ / "loop");
  expect({"diff", "loop", "out"}, 4, "loop: cannot be read: Too many levels of symbolic links");
  expect({"diff", "ref", "loop"}, 4, "loop: cannot be read: ");
  std::filesystem::create_symlink("default", folder_ / "ref/default");
  expect({"diff", "ref", "out"}, 4, "ref/default: cannot be read: ");
}

TEST_F(Diff, LimitsCanBeWidened) {
  write("a.png", 100);
  write("b.png", 130);
  expect({"diff", "a.png", "b.png", "--pixel-tolerance", "30", "--max-flip", "1", "--max-spot", "1"}, 0, "within");
  expect({"diff", "a.png", "b.png", "--pixel-budget", "1", "--max-flip", "1", "--max-spot", "1"}, 0, "within");
  expect({"diff", "a.png", "b.png", "--pixel-tolerance", "29", "--max-flip", "1", "--max-spot", "1"}, 7, "DIFFERS");
  expect({"diff", "a.png", "b.png", "--pixel-tolerance", "30", "--max-spot", "1"}, 7, "(limit 0.00866)");
}

TEST_F(Diff, FoldersNameWhatIsMissingAndWhatIsSurplus) {
  write("ref/a.png", 1);
  write("ref/gone.png", 1);
  write("out/a.png", 1);
  expect({"diff", "ref", "out"}, 7, "gone.png: missing: the reference ref/gone.png has no counterpart");
  write("out/gone.png", 1);
  write("out/new.png", 1);
  expect({"diff", "ref", "out"}, 8, "new.png: no reference: there is none for out/new.png");
  EXPECT_TRUE(contains(outcome_.out, "2 of 3 match their references")) << outcome_.out;
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

TEST_F(Diff, HeatMapsOfAnEarlierCallInAFolderAreNoPicturesToCompare) {
  write("ref/a.png", 100);
  write("ref/maps/b.png", 100);
  write("out/a.png", 130);
  write("out/maps/b.png", 100);
  for (const char* maps : {"out/differences", "ref/differences"}) {
    expect({"diff", "ref", "out", "--heatmap", maps}, 7, "1 of 2 match their references");
    expect({"diff", "ref", "out", "--heatmap", maps}, 6, "a.png: exists already");
    expect({"diff", "ref", "out", "--heatmap", maps, "--overwrite"}, 7, "1 of 2 match their references");
    std::filesystem::remove_all(folder_ / maps);
  }
  expect({"diff", "ref/a.png", "out/a.png", "--heatmap", "both/maps/a.png"}, 7, "DIFFERS");
  expect({"diff", "both", "both", "--heatmap", "both/maps", "--overwrite"}, 8, "expected pictures or videos");
  write("out/maps/a.png", 1);  // a picture where the command would write a heat map
  expect({"diff", "ref", "out", "--heatmap", "out/maps", "--overwrite"}, 2, "is a picture to test, which is read");
}

// The heat map of an earlier call is the first picture of the folder by name, and its metadata name no machine class.
// The class must be that of the picture to test.
TEST_F(Diff, HeatMapsTellNoClassOfMachinesAndBecomeNoReferences) {
  const auto draw = [&](const char* name) {
    image::Image image(32, 24);
    std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{100});
    std::filesystem::create_directories((folder_ / name).parent_path());
    image::write_png(folder_ / name, image, {{"gl", "llvmpipe (LLVM 15.0.6, 256 bits); OpenGL 4.5 Mesa 22.3.6"}});
  };
  draw("ref/mesa-22.3-256bit/z.png");
  draw("out/z.png");
  write("ref/z.png", 50);
  expect({"diff", "ref", "out", "--heatmap", "out/differences"}, 0, "z.png: same");
  expect({"diff", "ref", "out", "--heatmap", "out/differences", "--overwrite"}, 0, "z.png: same");
  expect({"diff", "ref", "out"}, 0, "z.png: same");
  expect({"accept", "ref", "out", "--reason", "why"}, 0, "z.png: is the same already");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "ref/differences"));
  expect({"accept", "ref", "out/differences/z.png", "--reason", "why"}, 2, "got a heat map of weft diff");
  write("ref/differences/z.png", 100);
  expect({"diff", "ref", "out"}, 7, "differences/z.png: missing: the reference");
}

TEST_F(Diff, EachPairIsOneLineWhateverItsName) {
  write("ref/a\nb.png: same.png", 100);
  write("out/a\nb.png: same.png", 130);
  expect({"diff", "ref", "out"}, 7, "a\\x0ab.png: same.png: DIFFERS");
  EXPECT_EQ(std::ranges::count(outcome_.out, '\n'), 1) << outcome_.out;
  expect({"accept", "ref", "out", "--reason", "why"}, 0, "now as out/a\\x0ab.png: same.png\n");
}

TEST_F(Diff, VideosOfOneNameHaveAHeatMapEach) {
  for (const char* name : {"ref/a.mkv", "ref/a.mov", "out/a.mkv", "out/a.mov"}) {
    video::Encoder encoder(folder_ / name, {.width = 32, .height = 24, .metadata = {}});
    encoder.add(image::Image(32, 24));
    encoder.finish();
  }
  expect({"diff", "ref", "out", "--heatmap", "maps"}, 0, "2 of 2 match their references");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "maps/a.mkv.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "maps/a.mov.png"));
}

TEST_F(Diff, AcceptedPictureIsTheReferenceFromThenOn) {
  write("ref/a.png", 100);
  write("ref/b.png", 100);
  write("out/a.png", 130);
  write("out/b.png", 130);
  expect({"accept", "ref", "out/a.png"}, 2, "--reason is required");
  expect({"accept", "ref", "out/a.png", "--reason", " "}, 2, "--reason: expected a text");
  expect({"accept", "ref/a.png", "out", "--reason", "all"}, 2, "out: a folder cannot become ref/a.png");
  expect({"accept", "ref/a.png", "out/a.png", "out/b.png", "--reason", "two"}, 2, "cannot all become ref/a.png");
  expect({"accept", "ref", "out/a.png", "out/none.png", "--reason", "half"}, 4, "none.png: does not exist");
  expect({"diff", "ref", "out"}, 7, "0 of 2 match their references");
  expect({"accept", "ref", "out/a.png", "--reason", "brighter by design"}, 0, "ref/a.png: now as out/a.png");
  expect({"diff", "ref", "out"}, 7, "a.png: same");
  EXPECT_TRUE(contains(support::read_bytes(folder_ / "ref/accepted.md"), "| brighter by design |"));
  expect({"accept", "ref", "out/a.png", "--reason", "again"}, 0, "ref/a.png: is the same already");
}

TEST_F(Diff, FoldersAreComparedWithAllBelowThem) {
  write("ref/a.png", 1);
  write("ref/front/a.png", 1);
  write("ref/front/deep/b.png", 1);
  write("out/a.png", 1);
  write("out/front/a.png", 9);
  expect({"diff", "ref", "out"}, 7, "front/a.png: DIFFERS");
  EXPECT_TRUE(contains(outcome_.out, "front/deep/b.png: missing: the reference ref/front/deep/b.png"));
  EXPECT_TRUE(contains(outcome_.out, "\n1 of 3 match their references")) << outcome_.out;
  write("out/front/a.png", 1);
  write("out/front/deep/b.png", 1);
  write("out/back/c.png", 1);
  expect({"diff", "ref", "out", "--heatmap", "maps"}, 8, "back/c.png: no reference");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "maps/front/deep/b.png"));
  std::filesystem::remove_all(folder_ / "out/back");
  expect({"diff", "ref", "out"}, 0, "3 of 3 match their references");
  // The name of a machine class (`default`) is no part of the name of a picture.
  std::filesystem::rename(folder_ / "ref/front", folder_ / "front");
  std::filesystem::create_directories(folder_ / "ref/default");
  std::filesystem::rename(folder_ / "front", folder_ / "ref/default/front");
  expect({"diff", "ref", "out"}, 0, "3 of 3 match their references");
}

TEST_F(Diff, LimitsOfSinglePicturesComeFromAFile) {
  for (const char* name : {"a.png", "front/a.png", "front/b.png"}) {
    write(std::string("ref/") + name, 100);
    write(std::string("out/") + name, 130);
  }
  support::write_bytes(folder_ / "limits.toml",
                       "[[picture]]\nname = \"front/*\"\npixel_budget = 1\nmax_flip = 1\nmax_spot = 1\n"
                       "[[picture]]\nname = \"front/b.*\"\npixel_budget = 0\n");
  expect({"diff", "ref", "out", "--limits", "limits.toml"}, 7, "front/a.png: within the limits");
  EXPECT_TRUE(outcome_.out.starts_with("a.png: DIFFERS")) << outcome_.out;
  EXPECT_TRUE(contains(outcome_.out, "front/b.png: DIFFERS")) << outcome_.out;
  const auto broken = [&](const std::string& text, const std::string& words) {
    support::write_bytes(folder_ / "limits.toml", text);
    expect({"diff", "ref", "out", "--limits", "limits.toml"}, 4, words);
  };
  broken("[[picture]]\nmax_flip = 1\n", "limits.toml:1:1: expected a name");
  broken("[[picture]]\nname = \"a\"\nmax_flop = 1\n", "limits.toml:3:12: unknown key max_flop; did you mean max_flip?");
  broken("[[picture]]\nname = \"a\"\nmax_flip = 2\n", "limits.toml:3:12: max_flip: expected a number from 0 to 1");
  broken("picture = 1\n", "expected tables [[picture]]");
  broken("[[picture]]\nname = \"*\"\nmax_flip = 1\n[[picture]]\nname = \"front/c.png\"\nmax_flip = 1\n",
         "limits.toml:4:1: name: expected a name or pattern of a picture that is compared, got \"front/c.png\", which "
         "fits "
         "none of 3; did you mean front/");
}

TEST_F(Diff, JUnitNamesWhatFailedAndWhatIsBroken) {
  write("ref/a.png", 1);
  write("ref/f/b<&>.png", 1);
  write("ref/c.png", 1);
  write("out/a.png", 1);
  write("out/f/b<&>.png", 90);
  write("out/new.png", 90);
  support::write_bytes(folder_ / "out/c.png", "words");
  expect({"diff", "ref", "out", "--junit", "report.xml"}, 4, "");
  const std::string xml = support::read_bytes(folder_ / "report.xml");
  EXPECT_TRUE(
      xml.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                      "<testsuite name=\"weft diff\" tests=\"4\" failures=\"2\" errors=\"1\" skipped=\"0\">\n"
                      "  <testcase classname=\".\" name=\"a.png\"/>\n"
                      "  <testcase classname=\".\" name=\"c.png\">\n    <error type=\"unreadable\" message=\"c.png: "))
      << xml;
  EXPECT_TRUE(contains(xml, "<testcase classname=\"f\" name=\"b&lt;&amp;&gt;.png\">\n    <failure type=\"differs\""))
      << xml;
  EXPECT_TRUE(contains(xml, "<failure type=\"no_reference\"")) << xml;
  expect({"diff", "ref", "out", "--junit", "report.xml"}, 6, "report.xml: exists already");
}

TEST_F(Diff, FoldersAreAcceptedWithAllBelowThem) {
  write("ref/a.png", 1);
  write("ref/gone.png", 1);
  write("out/a.png", 1);
  write("out/front/b.png", 9);
  expect({"accept", "ref", "out", "--reason", "new view"}, 0, "note: gone.png has no counterpart in out; it stays");
  EXPECT_TRUE(contains(outcome_.err, "ref/front/b.png: now as out/front/b.png")) << outcome_.err;
  EXPECT_TRUE(contains(outcome_.err, "ref/a.png: is the same already")) << outcome_.err;
  EXPECT_TRUE(contains(support::read_bytes(folder_ / "ref/accepted.md"), "| front/b.png | none |"));
  expect({"diff", "ref", "out"}, 7, "2 of 3 match their references");
  std::filesystem::create_directories(folder_ / "empty");
  expect({"accept", "ref", "empty", "--reason", "none"}, 4, "empty: holds no pictures or videos");
}

TEST_F(Diff, ReferenceThatCannotBeWrittenIsNotInTheLogOfAcceptance) {
  write("out/front/b.png", 9);
  write("ref/a.png", 1);
  support::write_bytes(folder_ / "ref/front", "a file in the place of the folder");
  expect({"accept", "ref", "out", "--reason", "new view"}, 6, "ref/front");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "ref/accepted.md"));
}

TEST_F(Diff, LogOfAcceptanceThatIsALinkWithoutTargetIsNotReplaced) {
  write("out/a.png", 9);
  write("ref/a.png", 1);
  std::filesystem::create_symlink("none.md", folder_ / "ref/accepted.md");
  expect({"accept", "ref", "out", "--reason", "new view"}, 4, "ref/accepted.md: cannot be read");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "ref/accepted.md"));
  expect({"diff", "ref", "out"}, 7, "a.png: DIFFERS");
}

TEST_F(Diff, OnlyWhatAMaskShowsWhiteIsCompared) {
  const auto with_spot = [&](const std::string& name, int x) {
    image::Image image(32, 24);
    std::fill_n(image.pixel(x, 12), 3, std::uint8_t{255});
    std::filesystem::create_directories((folder_ / name).parent_path());
    image::write_png(folder_ / name, image);
  };
  write("ref/a.png", 0);
  write("ref/b.png", 0);
  with_spot("out/a.png", 4);
  with_spot("out/b.png", 28);
  image::Image mask(32, 24);  // selects the right half
  for (int y = 0; y < 24; ++y) std::fill_n(mask.pixel(16, y), std::size_t{3 * 16}, std::uint8_t{200});
  std::filesystem::create_directories(folder_ / "limits");
  image::write_png(folder_ / "limits/mask.png", mask);
  support::write_bytes(folder_ / "limits/limits.toml", "[[picture]]\nname = \"*\"\nmask = \"mask.png\"\n");
  expect({"diff", "ref", "out", "--limits", "limits/limits.toml"}, 7, "a.png: same\nb.png: DIFFERS: 1 of 384 pixels");
  const auto refused = [&](const std::string& value, const std::string& words) {
    support::write_bytes(folder_ / "limits/limits.toml", "[[picture]]\nname = \"b.png\"\nmask = " + value + "\n");
    expect({"diff", "ref", "out", "--limits", "limits/limits.toml"}, 4, words);
  };
  refused("1", "limits.toml:3:8: mask: expected a picture");
  refused("\"none.png\"", "limits.toml:3:8: mask: limits/none.png does not exist");
  write("limits/wide.png", 255, 40);
  refused("\"wide.png\"", "wide.png: expected a mask of 32x24 pixels, got 40x24");
  write("limits/black.png", 0);
  refused("\"black.png\"", "black.png: expected a mask with white pixels");
  std::filesystem::copy_file(folder_ / "limits/mask.png", folder_ / "limits/own.png");
  support::write_bytes(folder_ / "limits/limits.toml", "[[picture]]\nname = \"*\"\nmask = \"own.png\"\n");
  expect({"diff", "ref", "out", "--limits", "limits/limits.toml", "--html", "limits/own.png", "--overwrite"}, 2,
         "own.png");
}

TEST_F(Diff, PageShowsBeforeAfterAndDifferenceOfWhatDiffers) {
  write("ref/a.png", 1);
  write("ref/f/<b>&.png", 1);
  write("ref/gone.png", 7);
  write("out/a.png", 1);
  write("out/f/<b>&.png", 90);
  expect({"diff", "ref", "out", "--html", "page.html"}, 7, "");
  const std::string page = support::read_bytes(folder_ / "page.html");
  const auto count = [&](const std::string& words) {
    int found = 0;
    for (std::size_t at = 0; (at = page.find(words, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("<h1>1 of 3 match their references</h1>"), 1);
  EXPECT_EQ(count("<h2>f/&lt;b&gt;&amp;.png</h2>"), 1);
  EXPECT_EQ(count("<b>"), 0);
  EXPECT_EQ(count("<figure class=\"before\">"), 2) << "of the one that is missing too";
  EXPECT_EQ(count("<figure class=\"after\">"), 1);
  EXPECT_EQ(count("<figure class=\"difference\">"), 1);
  EXPECT_EQ(count("<li>a.png: same</li>"), 1);
  EXPECT_EQ(count("http"), 1) << "the policy that forbids them, and no address";
  // The page embeds the pictures unchanged.
  const std::string mark = "<figure class=\"after\"><img alt=\"after\" src=\"data:image/png;base64,";
  const std::size_t begin = page.find(mark) + mark.size();
  std::ofstream(folder_ / "after.base64") << page.substr(begin, page.find('"', begin) - begin);
  const std::string decode = "base64 -d '" + (folder_ / "after.base64").string() + "' > '";
  ASSERT_EQ(std::system((decode + (folder_ / "after.png").string() + "'").c_str()), 0);
  EXPECT_EQ(image::read_png(folder_ / "after.png").rgb, image::read_png(folder_ / "out/f/<b>&.png").rgb);
  expect({"diff", "ref", "out", "--html", "page.html"}, 6, "page.html: exists already");
}

TEST_F(Diff, SaysWhatHasChangedInTheSceneBetweenTwoRuns) {
  const auto draw = [&](const char* name, std::uint8_t level, const char* hash, const char* gl,
                        const char* frame = "1") {
    image::Image image(32, 24);
    std::fill(image.rgb.begin(), image.rgb.end(), level);
    std::filesystem::create_directories((folder_ / name).parent_path());
    image::write_png(folder_ / name, image, {{"scene", "s"}, {"scene_hash", hash}, {"gl", gl}, {"frame", frame}});
  };
  draw("ref/00001.png", 100, "1", "Mesa 22");
  draw("out/00001.png", 130, "2", "Mesa 22");
  expect({"diff", "ref", "out"}, 7, "; the scene has changed\n");
  support::write_bytes(folder_ / "ref/s.effective.toml",
                       "[physics]\nwind = [8, 2.5, 0]\n[[cloth]]\nname = \"flag\"\nthickness = 1e-3\n");
  support::write_bytes(
      folder_ / "out/s.effective.toml",
      "[physics]\nwind = [8, 3.5, 0]\n[[cloth]]\nname = \"flag\"\nover = \"shirt\"\nthickness = 1e-3\n");
  expect({"diff", "ref", "out"}, 7,
         "; the scene has changed: cloth.flag.over: none -> \"shirt\"; physics.wind: [8, 2.5, 0] -> [8, 3.5, 0]\n");
  expect({"diff", "ref", "out", "--json"}, 7, "\"origin\": \"the scene has changed: cloth.flag.over");
  draw("out/00001.png", 130, "1", "Mesa 25");
  expect({"diff", "ref", "out"}, 7, "; the scene is the same; gl: Mesa 22 -> Mesa 25\n");
  draw("out/00001.png", 130, "1", "Mesa 22", "2");
  expect({"diff", "ref", "out"}, 7, "; the scene is the same; frame: 1 -> 2\n");
  draw("out/00001.png", 100, "2", "Mesa 22");
  expect({"diff", "ref", "out"}, 0, "00001.png: same\n");
}

TEST_F(Diff, AnnotationsNameTheFilesOfARepository) {
  write("repo/ref/a.png", 1);
  write("repo/ref/b,c.png", 1);
  write("repo/out/a.png", 1);
  write("repo/out/b,c.png", 90);
  write("repo/out/new.png", 90);
  expect({"diff", "repo/ref", "repo/out", "--annotations"}, 7,
         "\n::error file=repo/ref/b%2Cc.png,title=weft diff::b,c.png: DIFFERS: 768 of 768 pixels");
  EXPECT_TRUE(contains(outcome_.out, "\n::error file=repo/out/new.png,title=weft diff::new.png: no reference"))
      << outcome_.out;
  EXPECT_FALSE(contains(outcome_.out, "a.png,")) << "what is as its reference is no error";
  expect({"diff", "repo/ref", "repo/out", "--annotations", "--json"}, 7, "::error file=");
  EXPECT_TRUE(nlohmann::json::accept(outcome_.out)) << outcome_.out;
  ::setenv("GITHUB_ACTIONS", "true", 1);
  ::setenv("GITHUB_WORKSPACE", (folder_ / "repo").c_str(), 1);
  expect({"diff", "repo/ref", "repo/out"}, 7, "\n::error file=ref/b%2Cc.png,");
  ::unsetenv("GITHUB_ACTIONS");
  ::unsetenv("GITHUB_WORKSPACE");
  expect({"diff", "repo/ref", "repo/out"}, 7, "DIFFERS");
  EXPECT_FALSE(contains(outcome_.out, "::error")) << outcome_.out;
}

}  // namespace
}  // namespace weft::cli
