#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

#include "physics/mesh/ply.hpp"
#include "support/ply.hpp"
#include "support/test_folder.hpp"

namespace weft::support {
namespace {

struct Outcome {
  int exit_code;
  std::string text;  // standard output and error
};

class JudgeToolTest : public TestFolder {
 protected:
  // Writes one face with its lowest corner at height z over the inside of the face of write_floor().
  void write_spike(const std::string& name, double z) {
    mesh::write_ply(folder_ / name, std::vector<Vec3>{{0.25, 0.25, z}, {0.25, 0.25, z + 1}, {0.5, 0.25, z + 1}},
                    std::vector<std::array<Index, 3>>{{0, 1, 2}});
  }
  void write_floor(const std::string& name) {
    mesh::write_ply(folder_ / name, std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                    std::vector<std::array<Index, 3>>{{0, 1, 2}});
  }
  Outcome run(const std::string& arguments) const {
    const auto program = std::filesystem::path(WEFT_PROGRAM).parent_path() / "weft_judge";
    const auto output = folder_ / "output.txt";
    const std::string command =
        fmt::format("'{}' '{}' {} > '{}' 2>&1", program.string(), folder_.string(), arguments, output.string());
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(output)};
  }
};

TEST_F(JudgeToolTest, CountsByFrameAndByObjects) {
  for (const char* frame : {"00000", "00001"}) write_floor(fmt::format("big_sheet_{}.ply", frame));
  write_spike("ball_00000.ply", 0.1);
  write_spike("ball_00001.ply", -0.1);
  const Outcome all = run("--obstacle ball --list");
  EXPECT_EQ(all.exit_code, 1);
  EXPECT_EQ(all.text,
            "frame 0: 0 intersecting pairs\n"
            "frame 1: 1 intersecting pairs, ball-big_sheet 1\n"
            "  ball face 0, big_sheet face 0\n"
            "2 frames: 1 intersecting pairs\n");
  const Outcome first = run("--frames 0:1 --obstacle ball");
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_EQ(first.text, "frame 0: 0 intersecting pairs\n1 frames: 0 intersecting pairs\n");
}

TEST_F(JudgeToolTest, ObstaclesAreNotHeldAgainstEachOther) {
  write_floor("half_pipe_00000.ply");
  write_spike("ball_00000.ply", -0.1);
  EXPECT_EQ(run("").exit_code, 1);
  EXPECT_EQ(run("--obstacle ball --obstacle half_pipe").exit_code, 0);
}

// The first face of the hand crosses the sheet. If it is marked as passed through, write_ply() writes it last, and the
// tool does not test it.
TEST_F(JudgeToolTest, FacesThatClothPassesThroughAreLeftOut) {
  write_floor("sheet_00000.ply");
  const std::vector<Vec3> places{{0.25, 0.25, -0.1}, {0.25, 0.25, 1}, {0.5, 0.25, 1}, {0.25, 0.5, 1}};
  const std::vector<std::array<Index, 3>> faces{{0, 1, 2}, {1, 2, 3}};
  const auto write_hand = [&](const std::vector<std::uint8_t>& passed_through) {
    mesh::write_ply(folder_ / "hand_00000.ply", places, faces, {.passed_through = passed_through});
  };
  write_hand({});
  EXPECT_EQ(run("--obstacle hand").exit_code, 1);
  write_hand({0, 1});
  EXPECT_EQ(run("--obstacle hand").exit_code, 1);
  write_hand({1, 0});
  EXPECT_EQ(run("--obstacle hand").text, "frame 0: 0 intersecting pairs\n1 frames: 0 intersecting pairs\n");
  const PlyMesh read = read_ply(folder_ / "hand_00000.ply");
  EXPECT_EQ(read.passed_through, 1u);
  EXPECT_EQ(read.triangles, (std::vector<std::array<Index, 3>>{{1, 2, 3}, {0, 1, 2}}));
}

TEST_F(JudgeToolTest, WhatCannotBeJudgedIsNoPass) {
  const auto refuses = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.text;
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
  };
  refuses("", "no <object>_<frame>.ply of these frames");
  write_floor("sheet_00000.ply");
  refuses("--obstacle bal", "--obstacle bal: there is no such object");
  refuses("--frames 5:9", "no <object>_<frame>.ply of these frames");
  refuses("--frames 5", "expected A:B");
  write_floor("sheet_00001.ply");
  write_spike("ball_00001.ply", 1);
  refuses("", "frame 1 has other objects than the first frame");
  write_bytes(folder_ / "ball_00000.ply", "ply\n");
  refuses("", "ball_00000.ply");
}

}  // namespace
}  // namespace weft::support
