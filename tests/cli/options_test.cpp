#include "tools/cli/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "tools/cli/failure.hpp"

namespace weft::cli {
namespace {

using Arguments = std::vector<std::string>;

RunOptions parse_run(Arguments arguments) {
  arguments.insert(arguments.begin(), "run");
  return std::get<RunOptions>(parse_command_line(arguments));
}

// Returns the message of the usage error that these arguments must cause.
std::string refusal(const Arguments& arguments) {
  try {
    parse_command_line(arguments);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
  return "accepted";
}

TEST(Options, MayStandInAnyOrderAndMixWithTheScene) {
  std::vector<Arguments> groups{{"a.toml"},        {"-o", "b.mp4"},      {"--frames", "2:9:3"}, {"--size", "64x36"},
                                {"--set", "k=1"},  {"--quality=draft"},  {"--threads", "3"},    {"--overwrite"},
                                {"--fps", "12.5"}, {"--backend", "egl"}, {"--set", "l=2"}};
  // Tries every rotation, forward and backward: each option is once first, once last, and beside each kind of
  // neighbour.
  for (std::size_t shift = 0; shift < groups.size(); ++shift) {
    std::rotate(groups.begin(), groups.begin() + 1, groups.end());
    for (const bool backward : {false, true}) {
      std::vector<Arguments> order = groups;
      if (backward) std::reverse(order.begin(), order.end());
      Arguments arguments;
      for (const Arguments& group : order) arguments.insert(arguments.end(), group.begin(), group.end());
      const RunOptions run = parse_run(arguments);
      EXPECT_EQ(run.common.scene, "a.toml");
      EXPECT_EQ(run.output, "b.mp4");
      EXPECT_EQ(run.frames.begin, 2);
      EXPECT_EQ(run.frames.end, 9);
      EXPECT_EQ(run.frames.step, 3);
      ASSERT_TRUE(run.common.size);
      EXPECT_EQ(run.common.size->width, 64);
      EXPECT_EQ(run.common.size->height, 36);
      EXPECT_EQ(run.common.quality, render::Quality::draft);
      EXPECT_EQ(run.common.threads, 3);
      EXPECT_TRUE(run.common.overwrite);
      EXPECT_EQ(run.common.fps, 12.5);
      EXPECT_EQ(run.common.backend, render::Backend::egl);
      Arguments sets = run.common.overrides;
      std::sort(sets.begin(), sets.end());
      EXPECT_EQ(sets, (Arguments{"k=1", "l=2"}));
    }
  }
}

TEST(Options, LeftOutLeaveTheChoiceToTheScene) {
  const RunOptions run = parse_run({"a.toml"});
  EXPECT_EQ(run.output, "");
  EXPECT_FALSE(run.frames.begin || run.frames.end);
  EXPECT_FALSE(run.common.size || run.common.fps);
  EXPECT_EQ(run.common.quality, render::Quality::final);
  EXPECT_EQ(run.common.backend, render::Backend::automatic);
  EXPECT_EQ(run.common.threads, 0);
  EXPECT_FALSE(run.common.overwrite);
}

TEST(Options, OverridesKeepTheirOrder) {
  EXPECT_EQ(parse_run({"--set", "a=1", "s.toml", "--set", "a=2", "--set", "b=x=y"}).common.overrides,
            (Arguments{"a=1", "a=2", "b=x=y"}));
}

TEST(Options, UnknownValuesAreRefusedNamingTheAllowedOnes) {
  EXPECT_EQ(refusal({"run", "a.toml", "--quality", "fianl"}),
            "--quality: expected draft or preview or final, got fianl; did you mean final?");
  EXPECT_EQ(refusal({"run", "a.toml", "--backend", "glx"}), "--backend: expected auto or osmesa or egl, got glx");
  EXPECT_EQ(refusal({"run", "a.toml", "--progress", "planin"}),
            "--progress: expected auto or bar or plain or none, got planin; did you mean plain?");
  EXPECT_EQ(refusal({"run", "a.toml", "--size", "1280"}),
            "--size: expected WxH in pixels, each from 16 to 8192, such as 1280x720, got 1280");
  EXPECT_EQ(refusal({"run", "a.toml", "--threads", "0"}), "--threads: expected a whole number from 1 to 1024, got 0");
  EXPECT_EQ(refusal({"run", "a.toml", "--fps", "-5"}),
            "--fps: expected a number of frames a second, above 0 and up to 1000, got -5");
  EXPECT_EQ(refusal({"run", "a.toml", "--fps", "nan"}),
            "--fps: expected a number of frames a second, above 0 and up to 1000, got nan");
  EXPECT_EQ(refusal({"run", "a.toml", "--set", "stretch"}),
            "--set: expected path.to.key=value such as cloth.band.material.stretch=1e6, got stretch");
}

TEST(Options, WordsLongerThanAnyPathAreNotRepeatedWhole) {
  const auto message = [](const std::string& word) {
    return describe_failure(std::make_exception_ptr(Error(ExitCode::usage, "--set: got {} here", word))).text;
  };
  EXPECT_EQ(message(std::string(4096, 'a')).size(), 4096 + 16);
  EXPECT_EQ(message(std::string(60000, 'a')), "--set: got " + std::string(200, 'a') + "... (60000 bytes) here");
  // The 200th byte is the first half of a two-byte character.
  EXPECT_EQ(message(std::string(199, 'a') + std::string(60000, '\xC3')),
            "--set: got " + std::string(199, 'a') + "... (60199 bytes) here");
}

TEST(Options, MisspeltOptionsAndCommandsNameTheNearest) {
  const std::string commands =
      "run, simulate, render, check, new, watch, thumbnail, sheet, join, sweep, farm, schema, doctor, bench, diff, "
      "accept, review, export, completion, man";
  EXPECT_EQ(refusal({"run", "a.toml", "--sise", "64x36"}),
            "weft run: unknown option --sise; did you mean --size?; see weft run --help");
  EXPECT_EQ(refusal({"thumbnial", "a.toml"}),
            "unknown command thumbnial; did you mean thumbnail?; the commands are " + commands);
  EXPECT_EQ(refusal({"frobnicate"}), "unknown command frobnicate; the commands are " + commands);
  EXPECT_EQ(refusal({"a.toml"}), "expected a command before a.toml; did you mean weft run a.toml?");
  EXPECT_EQ(refusal({"--versoin"}),
            "unknown option --versoin before the command; did you mean --version?; see weft --help");
  EXPECT_EQ(refusal({}), "expected a command: " + commands + "; see weft --help");
}

TEST(Options, OfScenesAreRefusedForCachesWithWhatToDo) {
  for (const std::string command : {"render", "export"}) {
    EXPECT_EQ(refusal({command, "c", "--fps", "50"}),
              "weft " + command +
                  ": --fps: the frames of a cache are simulated for one rate; weft simulate SCENE --cache NEW --fps N "
                  "simulates them for another; --frames ::STEP uses fewer frames");
    const std::string no_set = refusal({command, "c", "--set=look.color=[1,0,0]"});
    EXPECT_NE(no_set.find("weft simulate SCENE --cache CACHE --resume --set KEY=VALUE gives them other colours"),
              std::string::npos)
        << no_set;
  }
}

TEST(Options, MissingOrSurplusArgumentsAreRefused) {
  EXPECT_EQ(refusal({"run"}), "weft run: SCENE is required; see weft run --help");
  EXPECT_EQ(refusal({"run", "a.toml", "b.toml"}), "weft run: unexpected argument b.toml; see weft run --help");
  EXPECT_NE(refusal({"run", "a.toml", "--size"}), "accepted");
  EXPECT_NE(refusal({"run", "a.toml", "--size", "64x64", "--size", "64x64"}), "accepted");
}

TEST(Options, OfWatchAreThoseThatItsDrawingTakes) {
  const auto refused = [](Arguments more) {
    more.insert(more.begin(), {"watch", "s.toml"});
    return refusal(more);
  };
  EXPECT_EQ(refused({"--film", "--frame", "3"}), "weft watch: --frame is for a still; expected it without --film");
  EXPECT_EQ(refused({"--film", "--start"}), "weft watch: --start is for a still; expected it without --film");
  EXPECT_EQ(refused({"--frames", "0:3"}), "weft watch: --frames is for a video; expected it with --film");
  EXPECT_EQ(refused({"--start", "--frame", "3"}), "weft watch: expected --start or --frame, got both");
  EXPECT_EQ(refused({"-o", "a.mp4"}), "-o: expected a name ending in .png without --film, got a.mp4");
  EXPECT_TRUE(refused({"-o", "a.png", "--film"}).starts_with("-o: expected one {frame}"));
  EXPECT_EQ(refused({"-o", "{frame}.png", "--film"}), "-o: expected a video with --film, got {frame}.png");
  for (const Arguments& good : {Arguments{"--film", "--frames", "0:3", "-o", "a.mp4"}, {"--start", "-o", "a.png"}})
    EXPECT_EQ(refused(good), "accepted");
}

TEST(Options, OfSpeedAreListsAndForSpeedAlone) {
  const auto bench = [](Arguments arguments) {
    arguments.insert(arguments.begin(), {"bench", "speed"});
    return std::get<BenchOptions>(parse_command_line(arguments));
  };
  const BenchOptions speed = bench({"--sizes", "2,0.5", "--threads", "4,1", "--steps", "1", "--frames", "3:7"});
  EXPECT_EQ(speed.sizes, (std::vector<double>{0.5, 2}));
  EXPECT_EQ(speed.threads, (std::vector<int>{1, 4}));
  EXPECT_EQ(speed.frames.begin, 3);
  EXPECT_FALSE(speed.drawing);
  EXPECT_EQ(bench({"--draw", "preview"}).drawing, render::Quality::preview);
  EXPECT_EQ(bench({"--peer", "p"}).peer, "p");
  for (const char* wrong : {"0", "-1", "1;2", "nan", "1e9"})
    EXPECT_EQ(refusal({"bench", "speed", "--sizes", wrong}),
              std::string("--sizes: expected numbers from 0.01 to 100, got ") + wrong);
  for (const char* wrong : {"1,", ",1", "1,,2"})
    EXPECT_EQ(refusal({"bench", "speed", "--steps", wrong}),
              std::string("--steps: expected numbers such as 1,2,4, got ") + wrong);
  EXPECT_EQ(refusal({"bench", "speed", "--threads", "1,0"}),
            "--threads: expected a whole number from 1 to 1024, got 0");
  for (const char* wrong : {"0:3", "1:9:2"})
    EXPECT_EQ(refusal({"bench", "speed", "--frames", wrong}),
              std::string("--frames: expected A:B with A >= 1 and without a STEP, since frame 0 takes no time and each "
                          "frame needs the one before, got ") +
                  wrong);
  EXPECT_EQ(refusal({"bench", "stability", "--steps", "1,2"}),
            "weft bench: --steps is for weft bench speed or accuracy");
  EXPECT_EQ(refusal({"bench", "sped"}),
            "WHAT: expected stability or accuracy or speed or fabrics, got sped; did you mean speed?");
}

TEST(Options, HelpOfEachCommandShowsItsOptionsAndAnExample) {
  for (const std::string command : {"run", "check", "thumbnail"}) {
    const std::string help = std::get<PrintText>(parse_command_line({command, "--help"})).text;
    EXPECT_NE(help.find("SCENE"), std::string::npos) << help;
    EXPECT_NE(help.find("--set"), std::string::npos) << help;
    EXPECT_NE(help.find("Example"), std::string::npos) << help;
    EXPECT_NE(help.find("weft " + command), std::string::npos) << help;
  }
}

TEST(Size, TakesOnlyTwoPositiveWholeNumbers) {
  EXPECT_EQ(parse_size("16x8192").height, 8192);
  for (const char* text : {"", "x", "1280x", "x720", "15x720", "1280x0", "-16x64", "1280x720x3", "12.5x7", "8193x64",
                           "99999999999x64", "1280X720", " 64x64"}) {
    EXPECT_THROW(parse_size(text), Error) << text;
  }
}

}  // namespace
}  // namespace weft::cli
