// weft export, as a shell starts it.
#include <gtest/gtest.h>

#include "cli/cached_run.hpp"

namespace weft::cli {
namespace {

class ExportCommand : public CachedRun {
 protected:
  Outcome exported(const Arguments& more) const {
    Arguments arguments{"export"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_weft(arguments, folder_);
  }
  void expect_exported(const Arguments& more) const {
    const Outcome outcome = exported(more);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  }
};

TEST_F(ExportCommand, WritesTheMeshesOfRunAndWhatElseItIsAskedFor) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--meshes", "meshes"});
  expect_exported({"c", "--format", "ply", "-o", "ply"});
  expect_same("meshes", "ply", ".ply", 3 * kFrames);
  expect_exported({"c", "--format", "obj", "-o", "obj", "--frames", "2:21:6"});
  EXPECT_EQ(contents("obj", ".obj").size(), 3U * 4);
  expect_exported({"c", "--format", "obj", "-o", "obj", "--frames", "3:4"});  // beside the same materials
  EXPECT_EQ(contents("obj", ".mtl").size(), 3U);
  expect_exported({"c", "--format", "pc2", "-o", "pc2"});
  EXPECT_EQ(contents("pc2", ".pc2").size(), 3U);
  expect_exported({"c", "--format", "gltf", "-o", "gltf"});
  EXPECT_EQ(contents("gltf", ".glb").size(), 1U);
  expect_exported({"c", "--format", "usd", "-o", "usd"});
  const std::string usd = contents("usd", ".usda").at("s.usda");
  EXPECT_NE(usd.find("def Camera \"camera\""), std::string::npos) << "that which is found where the scene names none";
  expect_exported({"c", "--format", "usdz", "-o", "usdz"});
  EXPECT_NE(contents("usdz", ".usdz").at("s.usdz").find(usd), std::string::npos) << "the same, packed";
  expect_exported({"c", "--format", "blender", "-o", "blender"});
  expect_same("pc2", "blender", ".pc2", 3);
  EXPECT_EQ(contents("blender", ".py").size(), 1U);
}

TEST_F(ExportCommand, RefusesWithTheCodesOfTheContract) {
  expect_well({"simulate", "s.toml", "--cache", "c", "--frames", "0:3"});
  const auto gltf = [&](const Arguments& more) {
    Arguments arguments{"c", "--format", "gltf", "-o", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return exported(arguments);
  };
  EXPECT_EQ(gltf({}).exit_code, 9) << "3 of 21 frames are there";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  EXPECT_EQ(gltf({"--partial"}).exit_code, 0);
  const auto first = contents("out", ".glb");
  const Outcome again = gltf({"--partial"});
  EXPECT_EQ(again.exit_code, 6);
  EXPECT_NE(again.err.find("exists already"), std::string::npos) << again.err;
  EXPECT_EQ(gltf({"--partial", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(contents("out", ".glb"), first);
  EXPECT_EQ(gltf({"--overwrite", "--frames", "0:9"}).exit_code, 9) << "frames that are not there";
  EXPECT_EQ(exported({"c", "--format", "fbx", "-o", "out"}).exit_code, 2);
  EXPECT_EQ(exported({"c", "--format", "ply"}).exit_code, 2);
  EXPECT_EQ(exported({"s.toml", "--format", "ply", "-o", "out"}).exit_code, 4);
}

}  // namespace
}  // namespace weft::cli
