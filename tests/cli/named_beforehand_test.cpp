// Everything that ends a run, or may end it, is reported before the run starts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cli/subprocess.hpp"
#include "support/test_folder.hpp"

namespace weft::cli {
namespace {

class UnevenCells : public support::TestFolder {};

TEST_F(UnevenCells, AreNamedByCheckAndRunWhereObstaclesAreMet) {
  // Two rows of 0.1 m squares with a row of needle triangles of this height between them.
  const auto needles = [](double height) {
    std::string text;
    for (const double y : {0.0, 0.1, 0.1 + height, 0.2 + height})
      for (int i = 0; i < 3; ++i) text += fmt::format("v {} {} 0\n", 0.1 * i, y);
    for (int j = 0; j < 3; ++j)
      for (int i = 1; i < 3; ++i) {
        const int a = 3 * j + i;
        text += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + 1, a + 4, a, a + 4, a + 3);
      }
    return text;
  };
  const std::string ball = "[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nposition = [0, 0, -1]\n";
  const std::string mesh = "[[cloth]]\nname = 'sheet'\nshape = 'mesh'\nfile = 'needles.obj'\n";
  const std::string graded = "[[cloth]]\nname = 'sheet'\nparticles = 11\ngrading = ";
  const auto check = [&](const std::string& scene) {
    support::write_bytes(folder_ / "uneven.toml", scene);
    return run_weft({"check", "uneven.toml"}, folder_);
  };
  support::write_bytes(folder_ / "needles.obj", needles(0.001));
  const Outcome flat = check(mesh + ball);
  expect_exit(flat, 0, "uneven.toml:1:1: cloth.sheet: mesh file ");
  EXPECT_TRUE(contains(flat.err, "repaired to a sheet: 3 edges of flat triangles collapsed or turned")) << flat.err;
  EXPECT_EQ(check(mesh).exit_code, 0) << "nothing to meet";
  support::write_bytes(folder_ / "needles.obj", needles(0.002));
  EXPECT_EQ(check(mesh + ball).exit_code, 0);

  expect_exit(check(graded + "[100, 1]\n" + ball), 3, "a grading closer to 1");
  EXPECT_EQ(check(graded + "[50, 1]\n" + ball).exit_code, 0);
}

class EnclosedCloth : public support::TestFolder {};

TEST_F(EnclosedCloth, IsNamedByCheckAndByTheRun) {
  const auto is_reported = [&](const std::string& change) {
    support::write_bytes(folder_ / "s.toml",
                         "time = { duration = 0.1, fps = 10, step = 0.1 }\n[[cloth]]\nname = 'c'\nsize = 0.2\n"
                         "particles = 4\n[[obstacle]]\nname = 'b'\n" +
                             change + "\n");
    const Outcome check = run_weft({"check", "s.toml"}, folder_);
    EXPECT_EQ(check.exit_code, 0) << check.err;
    const Outcome run = run_weft({"simulate", "s.toml", "--cache", "c", "--overwrite", "--progress", "none"}, folder_);
    const std::string words = "cloth.c: starts wholly inside obstacle.b";
    EXPECT_EQ(contains(check.out, words), contains(run.err, words)) << change;
    return contains(check.out, words);
  };
  EXPECT_TRUE(is_reported("shape = 'sphere'\nradius = 0.5"));
  EXPECT_TRUE(
      contains(run_weft({"check", "--estimate", "s.toml"}, folder_).out, "note: cloth.c: starts wholly inside"));
  EXPECT_TRUE(is_reported("shape = 'box'\nsize = [1, 1, 1]"));
  EXPECT_FALSE(is_reported("shape = 'sphere'\nradius = 0.5\nposition = [0, 0, -0.6]"));
  EXPECT_FALSE(is_reported("shape = 'sphere'\nradius = 0.5\ncollide = false"));
  EXPECT_FALSE(is_reported("shape = 'plane'\nposition = [0, 0, -0.1]"));
  EXPECT_FALSE(is_reported("shape = 'half_pipe'\nradius = 0.5")) << "open";
}

class MidpointContact : public support::TestFolder {};

TEST_F(MidpointContact, IsSaidToBeDampedByThePlan) {
  support::write_bytes(folder_ / "s.toml",
                       "time = { integrator = 'implicit_midpoint' }\n[[cloth]]\nname = 'c'\nparticles = [4, 4]\n");
  const auto plan = [&](const char* change) {
    return run_weft({"check", "--plan", "s.toml", "--set", change}, folder_).out;
  };
  EXPECT_TRUE(contains(plan("time.step=0.01"), "implicit midpoint, BDF2 where something is near"));
  EXPECT_FALSE(contains(plan("contact.self=false"), "BDF2"));
}

class SlowVideo : public support::TestFolder {};

TEST_F(SlowVideo, IsRefusedBeforeTheSimulation) {
  support::write_bytes(
      folder_ / "s.toml",
      "time = { duration = 400, fps = 0.005, step = 0.1 }\n[[obstacle]]\nname = 'b'\nshape = 'sphere'\n");
  const Outcome outcome = run_weft({"run", "s.toml", "-o", "a.mp4", "--stats", "s.json"}, folder_);
  EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
  EXPECT_EQ(
      outcome.err,
      "weft: fps: expected 0.01 to 1000 frames a second in a video, got 0.005; change fps, or the STEP of --frames, "
      "which divides it, or write pictures\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.json"));
}

}  // namespace
}  // namespace weft::cli
