// Position, direction and motion of cameras from glTF files.
#include "film/assets/camera_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "assets/small_files.hpp"
#include "core/error.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

class CameraFile : public support::TestFolder {
 protected:
  /// A rig turns by 90 degrees to the left about y in two seconds. The camera on the rig is 3 m from it along z and 1 m
  /// above it.
  nlohmann::json document_ = nlohmann::json::parse(gltf_camera());

  LoadedCamera load(const std::string& object = "") {
    std::ofstream(folder_ / "shot.gltf") << document_;
    return load_camera(folder_ / "shot.gltf", object, "s.toml:1:1: camera.shot");
  }
  void expect_refused(const std::string& reason, const std::string& object = "") {
    try {
      load(object);
      FAIL() << "expected an error that has: " << reason;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::asset_unreadable);
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
      EXPECT_TRUE(std::string(error.what()).starts_with("s.toml:1:1: camera.shot: camera file ")) << error.what();
    }
  }
};

// Tolerance for positions of some metres in single precision [m].
constexpr double kSingle = 1e-6;

TEST_F(CameraFile, GoesAroundWithTheRigThatItIsOn) {
  const LoadedCamera camera = load();
  ASSERT_FALSE(camera.times.empty());
  EXPECT_EQ(camera.times.front(), 0);
  EXPECT_NEAR(camera.times.back(), 2, kSingle);
  for (std::size_t i = 0; i < camera.times.size(); ++i) {
    const double angle = std::numbers::pi / 4 * camera.times[i];
    EXPECT_LT((camera.positions[i] - Vec3(3 * std::sin(angle), 1, 3 * std::cos(angle))).norm(), kSingle) << i;
    EXPECT_LT((camera.forward[i] - Vec3(-std::sin(angle), 0, -std::cos(angle))).norm(), kSingle) << i;
    EXPECT_LT(camera.times[i] - camera.times[i == 0 ? 0 : i - 1], 0.0201);
  }
  EXPECT_NEAR(camera.field_of_view, 28.6478898, 1e-5) << "half a radian, whatever the sides' ratio";
  EXPECT_NEAR(camera.roll, 0, 1e-4);
  document_["cameras"][0]["perspective"].erase("aspectRatio");
  EXPECT_NEAR(load().field_of_view, 28.6478898, 1e-5);
}

TEST_F(CameraFile, MayHaveItsEndingInCapitals) {
  std::ofstream(folder_ / "shot.GLTF") << document_;
  EXPECT_EQ(load_camera(folder_ / "shot.GLTF", "", "").positions.size(), load().positions.size());
}

TEST_F(CameraFile, MayHaveIntegersAsKeys) {
  document_ = nlohmann::json::parse(gltf_camera(true));
  const LoadedCamera camera = load();
  EXPECT_LT((camera.positions.front() - Vec3(0, 1, 3)).norm(), 1e-3);
  EXPECT_LT((camera.positions.back() - Vec3(3, 1, 0)).norm(), 1e-3);
}

TEST_F(CameraFile, StaysAtEachKeyOfStepsUntilTheNext) {
  document_["animations"][0]["samplers"][0]["interpolation"] = "STEP";
  const LoadedCamera camera = load();
  for (std::size_t i = 0; i < camera.times.size(); ++i) {
    if (camera.times[i] >= 1.9985) continue;
    EXPECT_LT((camera.positions[i] - Vec3(0, 1, 3)).norm(), kSingle) << camera.times[i];
  }
  EXPECT_LT((camera.positions.back() - Vec3(3, 1, 0)).norm(), kSingle);
}

// Both keys have tangents of zero: the camera starts and stops smoothly.
TEST_F(CameraFile, FollowsSplines) {
  const float half = std::sqrt(0.5F);
  std::string keys;
  for (const float x : {0.0F, 2.0F,                                                              // times
                        0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F,  // tangent, value, ...
                        0.0F, 0.0F, 0.0F, 0.0F, 0.0F, half, 0.0F, half, 0.0F, 0.0F, 0.0F, 0.0F})
    keys.append(reinterpret_cast<const char*>(&x), sizeof x);
  support::write_bytes(folder_ / "keys.bin", keys);
  document_["buffers"][0] = {{"byteLength", keys.size()}, {"uri", "keys.bin"}};
  document_["bufferViews"][1]["byteLength"] = keys.size() - 8;
  document_["accessors"][1]["count"] = 6;
  document_["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  const LoadedCamera camera = load();
  EXPECT_NEAR(camera.times.back(), 2, kSingle);
  for (std::size_t i = 0; i < camera.times.size(); ++i) {
    const double u = camera.times[i] / 2, part = u * u * (3 - 2 * u), along = part * std::sqrt(0.5);
    const double angle = 2 * std::atan2(along, 1 - part + along);
    EXPECT_LT((camera.positions[i] - Vec3(3 * std::sin(angle), 1, 3 * std::cos(angle))).norm(), 1e-3) << u;
  }
}

TEST_F(CameraFile, StandsStillWithoutAnAnimation) {
  document_.erase("animations");
  const LoadedCamera camera = load("eye");
  ASSERT_EQ(camera.times, std::vector<double>{0});
  EXPECT_LT((camera.positions[0] - Vec3(0, 1, 3)).norm(), kSingle);
}

TEST_F(CameraFile, MayBeAtSeveralNodes) {
  for (const char* list : {"animations", "accessors", "bufferViews", "buffers"}) document_.erase(list);
  const nlohmann::json other = {{"name", "other"}, {"camera", 0}, {"translation", {7, 0, 0}}};
  document_["nodes"].push_back(other);
  document_["nodes"][0]["children"].push_back(2);
  EXPECT_LT((load("eye").positions.at(0) - Vec3(0, 1, 3)).norm(), kSingle);
  EXPECT_LT((load("other").positions.at(0) - Vec3(7, 0, 0)).norm(), kSingle);
  document_["nodes"][2]["name"] = "eye";
  EXPECT_LT((load("eye").positions.at(0) - Vec3(0, 1, 3)).norm(), kSingle);
  EXPECT_LT((load("eye_2").positions.at(0) - Vec3(7, 0, 0)).norm(), kSingle) << "the number of its node";
  expect_refused("choose one of \"eye\", \"eye_2\" by object");
}

// A channel of KHR_animation_pointer has no node. Here, its values are also longer than translations.
TEST_F(CameraFile, DoesNotMoveWithAnimatedColors) {
  const LoadedCamera expected = load();
  const nlohmann::json pointer = {{"pointer", "/materials/0/emissiveFactor"}},
                       target = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", pointer}}}};
  document_["extensionsUsed"] = nlohmann::json::array({"KHR_animation_pointer"});
  document_["animations"][0]["channels"].push_back(nlohmann::json{{"sampler", 0}, {"target", target}});
  EXPECT_EQ(load().positions, expected.positions);
}

// Programs often give a camera and the node above it one name.
TEST_F(CameraFile, MayHaveTheNameOfItsRig) {
  const LoadedCamera expected = load();
  document_["nodes"][0]["name"] = "eye";
  EXPECT_EQ(load().positions, expected.positions);
  document_.erase("animations");
  EXPECT_LT((load("eye").positions.at(0) - Vec3(0, 1, 3)).norm(), kSingle);
}

TEST_F(CameraFile, TellsByHowMuchItIsTilted) {
  document_["nodes"][1]["rotation"] = {0, 0, std::sin(0.05), std::cos(0.05)};
  EXPECT_NEAR(load().roll, 0.1 * 180 / std::numbers::pi, 1e-4);
  document_["nodes"][1]["rotation"] = {0, 0, std::cos(0.05), std::sin(0.05)};
  EXPECT_NEAR(load().roll, 180 - 0.1 * 180 / std::numbers::pi, 1e-4) << "nearly upside down";
}

TEST_F(CameraFile, IsRefusedByNameWhereItIsNotThere) {
  expect_refused("expected a camera \"wide\", got \"eye\"", "wide");
  nlohmann::json second = document_["nodes"][1];
  second["name"] = "other";
  second["camera"] = 1;
  document_["cameras"].push_back(document_["cameras"][0]);
  document_["nodes"].push_back(second);
  document_["nodes"][0]["children"].push_back(2);
  expect_refused("choose one of \"eye\", \"other\" by object");
  document_["cameras"][0]["perspective"]["yfov"] = 3.1;
  expect_refused("expected a vertical field of view of 1 to 170 degrees", "eye");
  document_.erase("cameras");
  for (auto& node : document_["nodes"]) node.erase("camera");
  expect_refused("expected a camera, got none");
}

}  // namespace
}  // namespace weft::assets
