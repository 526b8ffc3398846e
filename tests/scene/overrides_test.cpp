// Tests of --set path.to.key=value.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "film/scene/loader.hpp"

namespace weft::scene {
namespace {

const std::string kScene =
    "[[cloth]]\nname = 'band'\n[[cloth]]\nname = 'sheet'\nsize = [1, 2]\n"
    "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nkeys = [{ time = 0 }, { time = 1 }]\n";

Scene load_with(const std::vector<std::string>& overrides) {
  const LoadResult result = load_text(kScene, "s.toml", overrides);
  EXPECT_EQ(result.describe(), "");
  return result.scene;
}

std::string messages(const std::vector<std::string>& overrides) {
  return load_text(kScene, "s.toml", overrides).describe();
}

TEST(Override, FindsListEntriesByNameAndByIndex) {
  const Scene scene = load_with({"cloth.sheet.material.stretch=1e6", "cloth.0.size=[3, 4]"});
  EXPECT_EQ(scene.cloths[1].material.stretch_weft, 1e6);
  EXPECT_EQ(scene.cloths[0].material.stretch_weft, Material{}.stretch_weft);
  EXPECT_EQ(scene.cloths[0].size, Vec2(3, 4));
  EXPECT_EQ(scene.cloths[1].size, Vec2(1, 2));
}

TEST(Override, ReachesIntoKeysAndTablesThatTheFileLeavesOut) {
  const Scene scene = load_with({"obstacle.ball.keys.1.time=2.5", "time.fps=50", "cloth.band.look.roughness=0.25"});
  EXPECT_EQ(scene.obstacles[0].motion.keys[1].time, 2.5);
  EXPECT_EQ(scene.time.fps, 50);
  EXPECT_EQ(scene.cloths[0].look.roughness, 0.25);
}

TEST(Override, ReplacesOneNumberOfAnArrayAndOneEntryOfAList) {
  const Scene scene = load_with({"cloth.sheet.size.1=5", "obstacle.ball.keys.1.position=[1, 2, 3]",
                                 "obstacle.ball.keys.1.position.2=4", "cloth.0={ name = \"flag\", size = 3 }"});
  EXPECT_EQ(scene.cloths[1].size, Vec2(1, 5));
  EXPECT_EQ(scene.obstacles[0].motion.keys[1].pose.position, Vec3(1, 2, 4));
  EXPECT_EQ(scene.cloths[0].name, "flag");
  EXPECT_EQ(scene.cloths[0].size, Vec2(3, 3));
  EXPECT_EQ(messages({"cloth.sheet.size.1=-5"}),
            "--set cloth.sheet.size.1=-5: cloth.sheet.size: expected > 0 m, got -5\n");
  EXPECT_EQ(messages({"cloth.sheet.size.2=5"}),
            "--set cloth.sheet.size.2=5: cloth.sheet.size.2: expected the name or index of an entry, got 2\n");
}

TEST(Override, TakesPlainWordsAsText) {
  const Scene scene = load_with({"cloth.band.material.fabric=silk", "cloth.sheet.material.fabric=\"wool\"",
                                 "title=two words", "cloth.band.look.color=#ff0000"});
  EXPECT_EQ(scene.cloths[0].material.fabric, "silk");
  EXPECT_EQ(scene.cloths[1].material.fabric, "wool");
  EXPECT_EQ(scene.title, "two words");
  EXPECT_EQ(scene.cloths[0].look.color, Vec3(1, 0, 0));
}

TEST(Override, OfALaterOneWins) {
  EXPECT_EQ(load_with({"time.fps=50", "time.fps=60"}).time.fps, 60);
}

TEST(Override, HashesLikeTheSameValueInTheFile) {
  const auto in_file = load_text(kScene + "[time]\nfps = 50\n", "s.toml").scene.hash;
  EXPECT_EQ(load_with({"time.fps=50"}).hash, in_file);
}

TEST(Override, CanMendWhatTheFileHasWrong) {
  EXPECT_EQ(load_text(kScene + "[time]\nfps = 0\n", "s.toml", {"time.fps=50"}).describe(), "");
}

TEST(Override, OfStepOrToleranceReplacesTheOtherOne) {
  const auto load_time = [](const std::string& in_file, const std::string& override_text) {
    const LoadResult result = load_text(kScene + "[time]\n" + in_file + "\n", "s.toml", {override_text});
    EXPECT_EQ(result.describe(), "");
    return result.scene.time;
  };
  EXPECT_EQ(load_time("step = 0.005", "time.tolerance=1e-4").tolerance, 1e-4);
  EXPECT_EQ(load_time("tolerance = 1e-4", "time.step=0.005").tolerance, std::nullopt);
  EXPECT_EQ(load_time("tolerance = 1e-4", "time.step=0.005").step, 0.005);
  EXPECT_EQ(messages({"time.step=0.005", "time.tolerance=1e-4"}),
            "--set time.step=0.005: time.step: expected either step or tolerance, got both\n"
            "--set time.tolerance=1e-4: time.tolerance: expected either tolerance or step, got both\n");
}

TEST(Override, ReplacesTheKeysOfTheFileThatExcludeItOrThatItExcludes) {
  const LoadResult rope = load_text("rope = [{ name = 'r', points = [[0, 0, 0], [1, 0, 0]] }]\n", "s.toml",
                                    {"rope.r.from=[5, 0, 0]", "rope.r.to=[6, 0, 0]"});
  EXPECT_EQ(rope.describe(), "");
  EXPECT_TRUE(rope.scene.ropes[0].points.empty());
  EXPECT_EQ(rope.scene.ropes[0].from, Vec3(5, 0, 0));
  const LoadResult pin =
      load_text(kScene + "[[cloth]]\nname = 'cape'\npin = [{ keys = [{ time = 0 }, { time = 1 }] }]\n", "s.toml",
                {"cloth.cape.pin.0.follow=ball"});
  EXPECT_EQ(pin.describe(), "");
  EXPECT_TRUE(pin.scene.cloths[2].pins[0].motion.keys.empty());
  EXPECT_EQ(load_text(effective_scene(pin.scene), "s.toml").describe(), "");
}

TEST(Override, IsCheckedLikeTheFile) {
  EXPECT_EQ(messages({"cloth.band.material.stretch=-1"}),
            "--set cloth.band.material.stretch=-1: cloth.band.material.stretch: expected >= 0 N/m, got -1\n");
  EXPECT_EQ(messages({"time.fps=fast"}),
            "--set time.fps=fast: time.fps: expected a number > 0 and <= 1000 Hz, got the text \"fast\"\n");
  EXPECT_EQ(messages({"time.fsp=25"}), "--set time.fsp=25: time.fsp: unknown key; did you mean fps?\n");
  EXPECT_EQ(messages({"tme.fps=25"}), "--set tme.fps=25: tme: unknown key; did you mean time?\n");
  EXPECT_EQ(messages({"cloth.band.size=[1, nan]"}),
            "--set cloth.band.size=[1, nan]: cloth.band.size: expected a number > 0 and <= 10000 m, got nan\n");
  EXPECT_EQ(messages({"cloth.band.name=sheet"}),
            "s.toml:4:8: cloth.1.name: expected a name used once, got \"sheet\" again\n");
}

TEST(Override, ThatLeadsNowhereSaysWhere) {
  EXPECT_EQ(messages({"cloth.bnd.size=1"}),
            "--set cloth.bnd.size=1: cloth.bnd: expected the name or index of an entry, got bnd; did you mean band?\n");
  EXPECT_EQ(messages({"cloth.7.size=1"}),
            "--set cloth.7.size=1: cloth.7: expected the name or index of an entry, got 7; there is band, sheet\n");
  EXPECT_EQ(messages({"cloth.band.name.x=1"}),
            "--set cloth.band.name.x=1: cloth.band.name.x: expected a key of a table\n");
  EXPECT_EQ(messages({"cloth.band=1"}), "--set cloth.band=1: cloth.0: expected a table, got 1\n");
}

TEST(Override, ThatIsNoAssignmentIsRefused) {
  EXPECT_EQ(messages({"time.fps"}), "--set time.fps: expected path.to.key=value\n");
  EXPECT_EQ(messages({"=3"}), "--set =3: expected path.to.key=value\n");
  EXPECT_EQ(messages({"time..fps=3"}), "--set time..fps=3: time..fps: expected a key between the dots\n");
  EXPECT_EQ(messages({"time.fps="}), "--set time.fps=: time.fps: expected a TOML value after =\n");
  EXPECT_EQ(messages({"time.fps=[1"}), "--set time.fps=[1: time.fps: expected a TOML value after =\n");
}

// The letter at byte 77 of "--set time.step=ää..." has two bytes.
TEST(Override, ThatIsLongIsShownWithoutAPartOfALetter) {
  const auto letters = [](int count) {
    std::string text;
    for (int k = 0; k < count; ++k) text += "\xc3\xa4";
    return text;
  };
  EXPECT_EQ(messages({"time.step=" + letters(60)}),
            "--set time.step=" + letters(30) + "...: time.step: expected a number from 1e-07 to 1 s, got the text \"" +
                letters(20) + "...\"\n");
}

TEST(Override, CannotSmuggleInFurtherKeys) {
  EXPECT_FALSE(load_text(kScene, "s.toml", {"time.fps=30\n[render]\nwidth=20"}).ok());
}

TEST(Override, ComesAfterTheMistakesOfTheFile) {
  EXPECT_EQ(load_text(kScene + "[render]\nwidth = 1\n", "s.toml", {"time.fps=0"}).describe(),
            "s.toml:11:9: render.width: expected >= 16, got 1\n--set time.fps=0: time.fps: expected > 0 Hz, got 0\n");
}

}  // namespace
}  // namespace weft::scene
