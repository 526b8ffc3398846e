// Cameras that follow a body, cuts of cameras, and focal lengths in millimetres, as they appear in snapshots.
#include "film/production/camera_mounts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "film/production/snapshots.hpp"
#include "support/scene_runs.hpp"

namespace weft::production {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A box moves to (3, 0, 1) within a second and makes a quarter turn about z; cameras are mounted on it.
const std::string kRide = R"(
[time]
duration = 1

[[obstacle]]
name = "box"
shape = "box"
interpolation = "linear"
keys = [{ time = 0, position = [1, 0, 0] }, { time = 1, position = [3, 0, 1], rotation = [0, 0, 90] }]

[[camera]]
name = "turning"
position = [1, -4, 1]
target = [1, 0, 0]
follow = "box"

[[camera]]
name = "level"
position = [1, -4, 1]
target = [1, 0, 0]
follow = "box"
follow_rotation = false

[[camera]]
name = "standing"
position = [1, -4, 1]
target = [1, 0, 0]
)";

frame::SnapshotPtr last_frame(const scene::Scene& scene) {
  const environment::Environment environment(scene);
  return SnapshotMaker(scene, environment).make(25, 1, environment.model, {}, {});
}

TEST(CameraThatFollows, MovesWithTheBody) {
  const frame::SnapshotPtr end = last_frame(support::scene_of_text(kRide));
  // Tolerance [m]: rounding of the rigid fit to some vertices.
  constexpr double kRounding = 1e-12;
  EXPECT_LT((end->cameras[0].position - Vec3(7, 0, 2)).norm(), kRounding);
  EXPECT_LT((end->cameras[0].target - Vec3(3, 0, 1)).norm(), kRounding);
  EXPECT_LT((end->cameras[1].position - Vec3(3, -4, 2)).norm(), kRounding);
  EXPECT_LT((end->cameras[1].target - Vec3(3, 0, 1)).norm(), kRounding);
  EXPECT_EQ(end->cameras[2].position, Vec3(1, -4, 1));
}

TEST(CameraThatFollows, IsTheSameInFramesOfACache) {
  const scene::Scene scene = support::scene_of_text(kRide);
  const frame::SnapshotPtr end = last_frame(scene);
  frame::FrameSnapshot stored = *end;
  stored.cameras.clear();
  const frame::SnapshotPtr shown = SnapshotMaker(scene, environment::Environment(scene)).with_looks(stored);
  ASSERT_EQ(shown->cameras.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(shown->cameras[c].position, end->cameras[c].position);
}

TEST(CameraThatFollows, APartOfACharacterGoesWithIt) {
  const scene::Scene scene = support::scene_of_text(R"(
[time]
duration = 2

[[character]]
name = "man"
source = "mannequin"
edge_length = 0.08
walk = 2

[[camera]]
name = "face"
position = [0, -1, 1.6]
target = [0, 0, 1.6]
follow = "man.head"
)");
  const environment::Environment environment(scene);
  const SnapshotMaker maker(scene, environment);
  const frame::SnapshotPtr start = maker.make(0, 0, environment.model, {}, {}),
                           end = maker.make(50, 2, environment.model, {}, {});
  EXPECT_LT((start->cameras[0].position - Vec3(0, -1, 1.6)).norm(), 1e-9);
  const auto middle = [](const frame::FrameSnapshot& frame) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& x : frame.states[0].positions) sum += x;
    return Vec3(sum / static_cast<double>(frame.states[0].positions.size()));
  };
  const Vec3 displacement = middle(*end) - middle(*start), ridden = end->cameras[0].target - start->cameras[0].target;
  EXPECT_GT(displacement.norm(), 0.5);
  EXPECT_LT((ridden - displacement).norm(), 0.1) << "the head and the body as a whole";
}

TEST(CameraCuts, AreCountedWhereTheCameraJumpsWithinAFrame) {
  const auto shots = [](const std::string& keys) {
    const scene::Scene scene = support::scene_of_text(
        "[[obstacle]]\nname = 'box'\nshape = 'box'\n[[camera]]\nname = 'c'\ntarget = [0, 0, 0]\n"
        "interpolation = 'linear'\nkeys = [" +
        keys + "]\n");
    const environment::Environment environment(scene);
    const SnapshotMaker maker(scene, environment);
    std::vector<int> list;
    for (const int frame : {0, 24, 25, 26, 50})
      list.push_back(maker.make(frame, frame / 25.0, environment.model, {}, {})->cameras[0].shot);
    return list;
  };
  const std::vector<int> one_shot{0, 0, 0, 0, 0}, two_shots{0, 0, 1, 1, 1};
  const std::string before = "{ time = 0, position = [3, 0, 0] }, ",
                    after = ", { time = 1, position = [0, 3, 0] }, { time = 2, position = [0, 3, 1] }";
  EXPECT_EQ(shots(before + "{ time = 0.96, position = [2.5, 0, 0] }" + after), two_shots) << "from frame to frame";
  EXPECT_EQ(shots(before + "{ time = 0.999, position = [2.5, 0, 0] }" + after), two_shots) << "as steps of files";
  EXPECT_EQ(
      shots(before + "{ time = 0.96, position = [2.5, 0, 0] }, { time = 0.97, position = [1.9, 0.7, 0] }" + after),
      two_shots)
      << "in two parts";
  EXPECT_EQ(shots(before + "{ time = 0.5, position = [2.5, 0, 0] }" + after), one_shot) << "a fast move";
  std::string dense;  // the camera starts at rest and accelerates, with keys every 10 ms
  for (int k = 0; k <= 200; ++k)
    dense += fmt::format("{}{{ time = {}, position = [3, {}, 0] }}", k > 0 ? ", " : "", 0.01 * k, 1e-4 * k * k);
  EXPECT_EQ(shots(dense), one_shot);
}

TEST(FocalLength, GivesTheAngleThatTheSensorSees) {
  const std::string camera =
      "[[obstacle]]\nname = 'box'\nshape = 'box'\n[[camera]]\nname = 'c'\nposition = [1, 2, 3]\n"
      "target = [0, 0, 0]\n";
  const auto angle = [&](const std::string& more, double time = 0) {
    const scene::Scene scene = support::scene_of_text(camera + more);
    const environment::Environment environment(scene);
    return SnapshotMaker(scene, environment).make(0, time, environment.model, {}, {})->cameras[0].field_of_view *
           kDegree;
  };
  // 1280 pixels span a width of 36 mm, so 720 pixels span a height of 20.25 mm.
  EXPECT_NEAR(angle("focal_length = 50\n"), 2 * std::atan(20.25 / 100), 1e-12);
  EXPECT_NEAR(angle("focal_length = 50\nsensor_width = 24\n"), 2 * std::atan(13.5 / 100), 1e-12);
  EXPECT_NEAR(angle("focal_length = 50\n[render]\nwidth = 720\nheight = 1280\n"), 2 * std::atan(36.0 / 100), 1e-12);
  // Linear keys interpolate the focal length, not the angle.
  EXPECT_NEAR(
      angle("interpolation = 'linear'\nkeys = [{ time = 0, focal_length = 30 }, { time = 1, focal_length = 70 }]\n",
            0.5),
      2 * std::atan(20.25 / 100), 1e-12);
}

TEST(FocalLength, OpensTheLensByItsNumber) {
  const scene::Scene scene = support::scene_of_text(
      "[[obstacle]]\nname = 'box'\nshape = 'box'\n[[camera]]\nname = 'c'\nposition = [1, 2, 3]\ntarget = [0, 0, 0]\n"
      "focal_length = 50\naperture = 2\n");
  const environment::Environment environment(scene);
  const frame::Camera camera = SnapshotMaker(scene, environment).make(0, 0, environment.model, {}, {})->cameras[0];
  // Aperture diameter = focal length / f-number. With a picture 24 mm high, the focal length is 12 mm / tan(angle / 2).
  EXPECT_NEAR(12 / std::tan(camera.field_of_view * kDegree / 2) / camera.aperture, 25, 1e-9);
}

}  // namespace
}  // namespace weft::production
