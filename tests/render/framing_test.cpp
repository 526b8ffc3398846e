#include "film/render/framing.hpp"

#include <gtest/gtest.h>

#include "film/render/camera_path.hpp"
#include "film/render/view.hpp"
#include "render/scaled_pictures.hpp"
#include "render/snapshots.hpp"
#include "support/test_folder.hpp"

namespace weft::render {
namespace {

/// Largest |x| and |y| in the picture (its edges are at 1) over all vertices except those of floors.
Vec2 extent(const frame::FrameSnapshot& snapshot, const frame::Camera& camera, const Vec3& up, double aspect) {
  const View view = make_view(camera, up, aspect, subject_bounds(snapshot), std::nullopt);
  Vec2 largest(0, 0);
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    if (snapshot.surfaces[i]->infinite_floor) continue;
    for (const Vec3& position : snapshot.states[i].positions) {
      const Eigen::Vector4d clip = view.clip_from_world * position.homogeneous();
      EXPECT_GT(clip.w(), 0);
      largest = largest.cwiseMax((clip.head<2>() / clip.w()).cwiseAbs());
    }
  }
  return largest;
}

std::shared_ptr<frame::Stage> stage_with_up(const Vec3& up) {
  auto stage = std::make_shared<frame::Stage>();
  stage->up = up;
  return stage;
}

TEST(Framing, ViewsStraightDownAreThoseFromTheFrontThatAreNearlySo) {
  for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
    const Vec3 front = Vec3::UnitX().cross(up);  // points from the scene to a viewer in front of it
    for (const double offset : {1e-3, 1e-7, 0.0, -1e-7}) {
      const ViewAxes axes = view_axes(-up - offset * front, up);
      EXPECT_LT((axes.right - Vec3::UnitX()).norm(), 1e-6) << up.transpose() << ", " << offset;
      EXPECT_LT((axes.up + front).norm(), 2e-3) << up.transpose() << ", " << offset;
    }
  }
}

// Vertical fields of view. On a sensor 20.25 mm high, a lens of 2,000 mm gives 0.58 degrees, and one of 1 mm 169
// degrees. The angles 0.12 and 177 are beyond this range.
TEST(Framing, LongAndShortLensesKeepTheirAngles) {
  for (const double angle : {0.12, 0.58, 169.0, 177.0}) {
    const View view = make_view(camera_at(Vec3(0, -5, 0), Vec3::Zero(), angle), Vec3::UnitZ(), 1,
                                Box3(Vec3::Constant(-1), Vec3::Constant(1)), std::nullopt);
    EXPECT_NEAR(view.tan_half_height / std::tan(angle * std::numbers::pi / 360), 1, 1e-12) << angle;
  }
}

TEST(Framing, EveryVertexIsInFrameAndTheTighterDirectionReachesTheMargin) {
  for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
    for (const double aspect : {16.0 / 9, 1.0, 0.5}) {
      frame::FrameSnapshot snapshot;
      snapshot.stage = stage_with_up(up);
      add_floor(snapshot);
      add_sphere(snapshot, Vec3(3, 1, 0.5), 0.5, 12);
      add_square(snapshot, frame::ObjectKind::cloth, Vec3(-2, 0, 4), Vec3::UnitY(), Vec3::UnitX(), 1.5);
      const Vec2 largest = extent(snapshot, camera_of(snapshot, "", aspect), up, aspect);
      // The margin is 14 percent of half the picture; the fit is exact except for rounding.
      EXPECT_NEAR(largest.maxCoeff(), 0.86, 1e-9) << up.transpose() << " " << aspect;
    }
  }
}

TEST(Framing, SmallSubjectsReachTheMarginAsWell) {
  for (const auto kind : {frame::Camera::Kind::whole, frame::Camera::Kind::follow}) {
    frame::FrameSnapshot snapshot;
    add_square(snapshot, frame::ObjectKind::cloth, Vec3(0.3, 0, 0), Vec3::UnitY(), Vec3::UnitX(), 0.002);
    frame::Camera camera = automatic_camera();
    camera.kind = kind;
    snapshot.cameras = {camera};
    EXPECT_NEAR(extent(snapshot, camera_of(snapshot, "", 1.5), Vec3::UnitZ(), 1.5).maxCoeff(), 0.86, 1e-9);
  }
}

TEST(Framing, LooksDownOnTheFloorFromTheFrontRight) {
  frame::FrameSnapshot snapshot;
  add_sphere(snapshot, Vec3::Zero(), 1, 8);
  const frame::Camera z_up = camera_of(snapshot, "", 1.5);
  EXPECT_LT(z_up.position.y(), 0);
  EXPECT_GT(z_up.position.z(), 0.5);
  EXPECT_GT(z_up.position.x(), 0);
  snapshot.stage = stage_with_up(Vec3::UnitY());
  const frame::Camera y_up = camera_of(snapshot, "", 1.5);
  EXPECT_GT(y_up.position.z(), 0);
  EXPECT_GT(y_up.position.y(), 0.5);
  EXPECT_GT(y_up.position.x(), 0);
}

TEST(Framing, NothingOrOnePointStillGivesACamera) {
  frame::FrameSnapshot nothing;
  const frame::Camera of_nothing = camera_of(nothing, "", 1.5);
  EXPECT_GT((of_nothing.position - of_nothing.target).norm(), 0.01);
  frame::FrameSnapshot point;
  add_surface(point, frame::ObjectKind::cloth, {Vec3(1, 2, 3)}, {});
  const frame::Camera of_point = camera_of(point, "", 1.5);
  EXPECT_TRUE(of_point.position.allFinite());
  EXPECT_GT((of_point.position - of_point.target).norm(), 0.01);
}

TEST(Framing, InvisibleSurfacesDoNotCount) {
  frame::FrameSnapshot snapshot;
  add_sphere(snapshot, Vec3::Zero(), 1, 8);
  add_sphere(snapshot, Vec3(50, 0, 0), 1, 8).visible = false;
  EXPECT_LT(subject_bounds(snapshot).max().x(), 1.001);
}

// On the right, a red square is 300 m away and hides a blue one 10 cm behind it. On the left, a red square is 20 cm
// away. All have the same size in the picture, so both places must be red.
TEST(Framing, CloseClothIsInViewBeforeDistantThingsThatHideEachOther) {
  for (const bool red_first : {true, false}) {
    frame::FrameSnapshot snapshot;
    snapshot.stage = stage_with_up(Vec3::UnitZ());
    const auto add = [&](double away, double aside, const Vec3& color) {
      add_square(snapshot, frame::ObjectKind::cloth, Vec3(aside * away, away, 0), -Vec3::UnitY(), Vec3::UnitX(),
                 0.1 * away)
          .appearance.color = color;
    };
    const Vec3 red(0.8, 0.1, 0.1), blue(0.1, 0.1, 0.8);
    add(300 + (red_first ? 0 : 0.1), 0.2, red_first ? red : blue);
    add(300 + (red_first ? 0.1 : 0), 0.2, red_first ? blue : red);
    add(0.2, -0.2, red);
    snapshot.cameras = {camera_at(Vec3::Zero(), Vec3::UnitY(), 40)};
    const image::Image image = drawn(snapshot, 1);
    for (const double aside : {-0.2, 0.2}) {
      const int middle = kWidth / 2 + static_cast<int>(aside / std::tan(radians(20)) * kHeight / 2);
      for (int x = middle - 10; x < middle + 10; ++x)
        EXPECT_GT(image.pixel(x, kHeight / 2)[0], image.pixel(x, kHeight / 2)[2] + 50) << aside << ' ' << x;
    }
  }
}

TEST(Framing, CameraIsFoundByNameAndAWrongNameListsThoseThereAre) {
  frame::FrameSnapshot snapshot;
  EXPECT_EQ(find_camera(snapshot, ""), nullptr);
  snapshot.cameras = {camera_at(Vec3::Zero(), Vec3::UnitX(), 30), camera_at(Vec3::UnitX(), Vec3::Zero(), 40)};
  snapshot.cameras[0].name = "front";
  snapshot.cameras[1].name = "side";
  EXPECT_EQ(find_camera(snapshot, "")->name, "front");
  EXPECT_EQ(find_camera(snapshot, "side")->name, "side");
  support::expect_error(ExitCode::usage, "--camera: expected one of the scene's cameras (front, side), got 'top'",
                        [&] { find_camera(snapshot, "top"); });
}

}  // namespace
}  // namespace weft::render
