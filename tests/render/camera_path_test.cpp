// Cameras that the program computes from all frames of a run.
#include "film/render/camera_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "film/render/view.hpp"
#include "render/snapshots.hpp"

namespace weft::render {
namespace {

using Kind = frame::Camera::Kind;
constexpr double kAspect = 16.0 / 9, kFps = 25;
constexpr int kFrames = 101;

frame::Camera found_camera(Kind kind) {
  frame::Camera camera;
  camera.name = "found";
  camera.kind = kind;
  camera.field_of_view = kind == Kind::track ? 0 : 30;
  return camera;
}

/// A body that walks six metres to the right and moves up and down by 3 cm once a second, under a static banner.
std::vector<frame::FrameSnapshot> walk(const frame::Camera& camera) {
  std::vector<frame::FrameSnapshot> run;
  for (int k = 0; k < kFrames; ++k) {
    frame::FrameSnapshot snapshot;
    snapshot.frame = k;
    snapshot.time = k / kFps;
    const double x = 1.5 * snapshot.time, z = 1 + 0.03 * std::sin(2 * 3.14159265 * snapshot.time);
    add_sphere(snapshot, Vec3(x, 0, z), 0.5, 8).name = "walker";
    auto& walker = const_cast<frame::Surface&>(*snapshot.surfaces.back());
    walker.kind = frame::ObjectKind::character;
    add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 1, 3), -Vec3::UnitY(), Vec3::UnitX(), 0.4).name = "banner";
    snapshot.cameras = {camera};
    run.push_back(std::move(snapshot));
  }
  return run;
}

CameraPath path_of(const std::vector<frame::FrameSnapshot>& run) {
  CameraPath path("", kAspect);
  for (const frame::FrameSnapshot& snapshot : run) path.add_frame(snapshot);
  path.compute_cameras();
  return path;
}

/// Largest |x| or |y| of a surface in the picture; the edges of the picture are at 1.
double extent(const frame::FrameSnapshot& snapshot, const frame::Camera& camera, std::size_t surface) {
  const View view = make_view(camera, Vec3::UnitZ(), kAspect, subject_bounds(snapshot), std::nullopt);
  double largest = 0;
  for (const Vec3& position : snapshot.states[surface].positions) {
    const Eigen::Vector4d clip = view.clip_from_world * position.homogeneous();
    largest = std::max(largest, (clip.head<2>() / clip.w()).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(CameraPath, WholeStandsStillWithAllFramesInViewAndNoFurtherThanTheyNeed) {
  const auto run = walk(found_camera(Kind::whole));
  const CameraPath path = path_of(run);
  double largest = 0;
  for (const frame::FrameSnapshot& snapshot : run) {
    const frame::Camera camera = path.at(snapshot);
    EXPECT_EQ(camera.position, path.at(run[0]).position);
    for (const std::size_t surface : {0, 1}) largest = std::max(largest, extent(snapshot, camera, surface));
  }
  // Cameras leave a margin of 14 % of half the picture; the fit is exact.
  EXPECT_NEAR(largest, 0.86, 1e-9);
}

TEST(CameraPath, FollowKeepsItsSubjectInTheMiddleWithoutTakingOverItsSteps) {
  const auto run = walk(found_camera(Kind::follow));
  const CameraPath path = path_of(run);
  double largest = 0;
  std::vector<Vec3> eyes;
  for (const frame::FrameSnapshot& snapshot : run) {
    const frame::Camera camera = path.at(snapshot);
    largest = std::max(largest, extent(snapshot, camera, 0));
    eyes.push_back(camera.position);
  }
  EXPECT_NEAR(largest, 0.86, 1e-9);
  for (std::size_t k = 1; k + 1 < eyes.size(); ++k) {
    EXPECT_NEAR((eyes[k] - eyes[k - 1]).x(), 1.5 / kFps, 1e-9) << "an even walk is followed evenly, from the start";
    // The camera follows the Gaussian mean (standard deviation 0.5 s) of the walker's height. The mean damps an
    // oscillation of 1 Hz to exp(-pi² / 2) = 0.7 %, and less at both ends of the run.
    const double bend = (eyes[k + 1] - 2 * eyes[k] + eyes[k - 1]).z();
    const double own = 0.03 * std::pow(2 * 3.14159265 / kFps, 2);
    EXPECT_LT(std::abs(bend), 0.1 * own) << k;
  }
}

TEST(CameraPath, CloseComesNearerWhereTheSubjectIsSmallAndNeverCutsIt) {
  auto run = walk(found_camera(Kind::close));
  for (std::size_t k = 50; k < run.size(); ++k)
    for (Vec3& position : run[k].states[0].positions) {
      const Vec3 middle(1.5 * run[k].time, 0, 1);
      position = middle + 0.2 * (position - middle);
    }
  const CameraPath path = path_of(run);
  const auto distance = [&](std::size_t k) { return (path.at(run[k]).position - path.at(run[k]).target).norm(); };
  // From frame 50 on, the walker has a fifth of its size, which alone would allow a fifth of the distance. Its
  // oscillation, which the camera does not follow, needs more.
  EXPECT_LT(distance(100), 0.35 * distance(0));
  for (const frame::FrameSnapshot& snapshot : run) EXPECT_LT(extent(snapshot, path.at(snapshot), 0), 0.86 + 1e-9);
}

TEST(CameraPath, TrackStaysWhereItIsPutAndOpensAsWideAsItsSubjectNeeds) {
  frame::Camera camera = found_camera(Kind::track);
  camera.position = Vec3(3, -4, 1.5);
  const auto run = walk(camera);
  const CameraPath path = path_of(run);
  double largest = 0;
  for (const frame::FrameSnapshot& snapshot : run) {
    const frame::Camera at = path.at(snapshot);
    EXPECT_EQ(at.position, camera.position);
    EXPECT_EQ(at.field_of_view, path.at(run[0]).field_of_view);
    largest = std::max(largest, extent(snapshot, at, 0));
  }
  EXPECT_LT(largest, 0.86 + 1e-9);
  // The field of view is fitted to the bounding box of the ball, whose corners are farther out than the ball.
  EXPECT_GT(largest, 0.6);
}

TEST(CameraPath, TrackStandsUprightWhereverItLooks) {
  frame::Camera camera = found_camera(Kind::track);
  camera.position = Vec3(4, 0, 1);  // not at the default azimuth
  frame::FrameSnapshot snapshot;
  add_square(snapshot, frame::ObjectKind::cloth, Vec3(0, 0, 1), Vec3::UnitX(), Vec3::UnitY(), 1).name = "pole";
  for (Vec3& position : snapshot.states[0].positions) position.y() *= 0.01;
  snapshot.cameras = {camera};
  EXPECT_NEAR(extent(snapshot, path_of({snapshot}).at(snapshot), 0), 0.86, 1e-9);
}

TEST(CameraPath, OrbitGoesAroundAtOneDistanceWithEverythingInView) {
  frame::Camera camera = found_camera(Kind::whole);
  auto run = walk(camera);
  for (frame::FrameSnapshot& snapshot : run) snapshot.cameras[0].azimuth = 33 + 90 * snapshot.time;
  const CameraPath path = path_of(run);
  double largest = 0;
  for (const frame::FrameSnapshot& snapshot : run) {
    const frame::Camera at = path.at(snapshot);
    EXPECT_EQ(at.target, path.at(run[0]).target);
    EXPECT_NEAR((at.position - at.target).norm(), (path.at(run[0]).position - at.target).norm(), 1e-9);
    for (const std::size_t surface : {0, 1}) largest = std::max(largest, extent(snapshot, at, surface));
  }
  EXPECT_NEAR(largest, 0.86, 1e-9);
  // In one second, the azimuth grows by 90 degrees. Seen from above, the directions to the two eyes are perpendicular.
  const Vec3 first = path.at(run[0]).position - path.at(run[0]).target;
  const Vec3 later = path.at(run[25]).position - path.at(run[25]).target;
  EXPECT_NEAR(first.head<2>().dot(later.head<2>()), 0, 1e-9);
}

TEST(CameraPath, WholeLetsClothGoThatFallsForEver) {
  auto run = walk(found_camera(Kind::whole));
  const Vec3 before = path_of(run).at(run[0]).position;
  for (Vec3& position : run[100].states[1].positions) position.z() -= 1000;
  const double distance = (path_of(run).at(run[0]).position - before).norm();
  EXPECT_GT(distance, 1);
  EXPECT_LT(distance, 60);
}

TEST(CameraPath, NamedSubjectsAloneAreFramed) {
  frame::Camera camera = found_camera(Kind::follow);
  camera.subjects = {"banner"};
  const auto run = walk(camera);
  const CameraPath path = path_of(run);
  EXPECT_NEAR(extent(run[100], path.at(run[100]), 1), 0.86, 1e-9);
}

TEST(CameraPath, PlacedCamerasAreTakenAsTheyAre) {
  frame::FrameSnapshot snapshot;
  add_sphere(snapshot, Vec3::Zero(), 1, 8);
  snapshot.cameras = {camera_at(Vec3(0, -5, 1), Vec3::Zero(), 40)};
  EXPECT_FALSE(CameraPath::is_computed(snapshot, ""));
  EXPECT_EQ(CameraPath("", kAspect).at(snapshot).position, Vec3(0, -5, 1));
  snapshot.cameras.clear();
  EXPECT_TRUE(CameraPath::is_computed(snapshot, ""));
}

}  // namespace
}  // namespace weft::render
