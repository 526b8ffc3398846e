// weft export, as a shell starts it.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/cached_run.hpp"

namespace weft::cli {
namespace {

/// Removes the texture coordinates of the vertices from a PLY file.
std::string without_uv(const std::string& ply) {
  const std::string_view words = "property float s\nproperty float t\n", end = "end_header\n";
  const std::size_t at = ply.find(words), body = ply.find(end) + end.size();
  if (at > body) return ply;
  const std::size_t vertices = std::stoul(ply.substr(ply.find("element vertex ") + 15));
  std::string plain = ply.substr(0, at) + ply.substr(at + words.size(), body - at - words.size());
  const std::size_t value = ply.find("property float strain\n") < body ? 4 : 0, size = 32 + value;
  for (std::size_t v = 0; v < vertices; ++v)
    plain += ply.substr(body + size * v, 24) + ply.substr(body + size * v + 32, value);
  return plain + ply.substr(body + size * vertices);
}

class ExportCommand : public CachedRun {
 protected:
  Outcome exported(const Arguments& more) const { return run_weft(joined({"export"}, more), folder_); }
  void expect_exported(const Arguments& more) const { expect_exit(exported(more), 0); }
};

TEST_F(ExportCommand, WritesTheMeshesOfRunAndWhatElseItIsAskedFor) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--meshes", "meshes"});
  expect_exported({"c", "--format", "ply", "-o", "ply"});
  const auto meshes = contents("meshes", ".ply"), exported = contents("ply", ".ply");
  EXPECT_EQ(exported.size(), 3U * kFrames);
  for (const auto& [name, bytes] : exported) EXPECT_EQ(without_uv(bytes), meshes.at(name)) << name;
  expect_exported({"c", "--format", "obj", "-o", "obj", "--frames", "2:21:6"});
  EXPECT_EQ(contents("obj", ".obj").size(), 3U * 4);
  expect_exported({"c", "--format", "obj", "-o", "obj", "--frames", "3:4"});  // the material files exist already, with
                                                                              // the same content
  EXPECT_EQ(contents("obj", ".mtl").size(), 3U);
  expect_exported({"c", "--format", "pc2", "-o", "pc2"});
  EXPECT_EQ(contents("pc2", ".pc2").size(), 3U);
  expect_exported({"c", "--format", "gltf", "-o", "gltf"});
  EXPECT_EQ(contents("gltf", ".glb").size(), 1U);
  expect_exported({"c", "--format", "usd", "-o", "usd"});
  const std::string usd = contents("usd", ".usda").at("s.usda");
  EXPECT_TRUE(contains(usd, "def Camera \"camera\"")) << "that which is found where the scene names none";
  expect_exported({"c", "--format", "usdz", "-o", "usdz"});
  EXPECT_TRUE(contains(contents("usdz", ".usdz").at("s.usdz"), usd)) << "the same, packed";
  expect_exported({"c", "--format", "blender", "-o", "blender"});
  expect_same("pc2", "blender", ".pc2", 3);
  EXPECT_EQ(contents("blender", ".py").size(), 1U);
}

// A camera read from an exported glTF file equals the camera of the scene, with either axis up.
TEST_F(ExportCommand, CamerasOfGltfFilesAreTakenByScenes) {
  const std::string film = R"([time]
duration = 0.4
fps = 25
[[obstacle]]
name = "ball"
shape = "sphere"
[[camera]]
name = "shot"
)";
  const std::string keys = R"(interpolation = "linear"
keys = [{ time = 0, position = [3, -4, 2], target = [0, 0, 0.5], field_of_view = 40 },
  { time = 0.4, position = [5, -1, 1], target = [0, 1, 0.5] }]
)";
  for (const std::string up : {"z", "y"}) {
    std::ofstream(folder_ / "a.toml") << ("up = \"" + up + "\"\n" + film + keys);
    std::ofstream(folder_ / "b.toml") << ("up = \"" + up + "\"\n" + film +
                                          "kind = \"file\"\nfile = \"a/a.glb\"\nobject = \"shot\"\n");
    const auto cameras = [&](const std::string& name) {
      expect_well({"simulate", name + ".toml", "--cache", name + "c", "--overwrite"});
      expect_exported({name + "c", "--format", "gltf", "-o", name, "--overwrite"});
      expect_exported({name + "c", "--format", "blender", "-o", name, "--overwrite"});
      const std::string text = contents(name, ".py").at(name + ".py");
      const auto start = text.find("r\"\"\"") + 4;
      return nlohmann::json::parse(text.substr(start, text.find("\"\"\"", start) - start))["cameras"][0]["frames"];
    };
    const auto given = cameras("a").flatten(), taken = cameras("b").flatten();
    ASSERT_EQ(given.size(), taken.size());
    for (const auto& [place, value] : given.items())
      EXPECT_NEAR(taken[place].get<double>(), value.get<double>(), 1e-6 + 1.2e-7 * std::abs(value.get<double>()))
          << up << place;
  }
}

TEST_F(ExportCommand, InterruptedSaysHowFarItIsAndLeavesWholeFiles) {
  std::ofstream(folder_ / "a.toml") << "[time]\nduration = 8\n[[obstacle]]\nname = \"ball\"\nshape = \"sphere\"\n";
  expect_well({"simulate", "a.toml", "--cache", "c"});
  Subprocess weft({"export", "c", "--format", "obj", "-o", "out"}, folder_);
  for (int i = 0; i < 60'000 && !std::filesystem::exists(folder_ / "out/ball_00000.obj"); ++i) ::usleep(1000);
  weft.send(SIGTERM);
  const Outcome outcome = weft.wait();
  if (outcome.exit_code == 0) GTEST_SKIP() << "it was done before the signal came";
  EXPECT_EQ(outcome.exit_code, 75) << outcome.err;
  const auto files = contents("out", ".obj");
  const std::string words =
      "interrupted after " + std::to_string(files.size()) + " of 201 frames; export again with --overwrite";
  EXPECT_TRUE(contains(outcome.err, words)) << outcome.err;
  EXPECT_TRUE(contents("out", ".tmp").empty());
  EXPECT_EQ(files.rbegin()->second, files.at("ball_00000.obj"));
}

TEST_F(ExportCommand, RefusesWithTheCodesOfTheContract) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", "0:3"});
  const auto gltf = [&](const Arguments& more) {
    return exported(joined({"c", "--format", "gltf", "-o", "out"}, more));
  };
  EXPECT_EQ(gltf({}).exit_code, 9) << "3 of 21 frames are there";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  EXPECT_EQ(gltf({"--partial"}).exit_code, 0);
  const auto first = contents("out", ".glb");
  expect_exit(gltf({"--partial"}), 6, "exists already");
  EXPECT_EQ(gltf({"--partial", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(contents("out", ".glb"), first);
  EXPECT_EQ(gltf({"--overwrite", "--frames", "0:9"}).exit_code, 9) << "frames that are not there";
  EXPECT_EQ(exported({"c", "--format", "fbx", "-o", "out"}).exit_code, 2);
  EXPECT_EQ(exported({"c", "--format", "ply"}).exit_code, 2);
  EXPECT_EQ(exported({"s.toml", "--format", "ply", "-o", "out"}).exit_code, 4);
}

}  // namespace
}  // namespace weft::cli
