// Cameras of the close-ups of `weft thumbnail --start`.
#include "tools/cli/start_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "render/snapshots.hpp"

namespace weft::cli {
namespace {

/// Keeps the cameras of the pictures instead of drawing.
class CameraRecorder : public FramePainter {
 public:
  Picture draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot*) override {
    cameras.push_back(snapshot.cameras.at(0));
    return {.image = image::Image(64, 36)};
  }
  StageTime last_time() const override { return {}; }
  std::string description() const override { return "none"; }

  std::vector<frame::Camera> cameras;
};

// The place of the intersection has 1/50 of the square's width. A close-up shows a tenth of the scene's diagonal,
// but at most 0.1 m.
TEST(StartPicture, CloseUpsOfDollsAreAsNearAsThoseOfPeople) {
  for (const double size : {0.02, 0.5, 2.0}) {
    auto snapshot = std::make_shared<frame::FrameSnapshot>();
    render::add_square(*snapshot, frame::ObjectKind::cloth, Vec3::Zero(), Vec3::UnitZ(), Vec3::UnitX(), size / 2);
    const double side = size / 50;
    simulation::IntersectionPlace place{"sheet", "sheet", 1, Vec3::Zero(), side, {}};
    place.triangles.push_back({Vec3(0, 0, 0), Vec3(side, 0, 0), Vec3(0, side, 0)});
    const production::StartView start{snapshot, {place}, ""};
    CameraRecorder recorder;
    draw_start(start, {}, recorder);
    ASSERT_EQ(recorder.cameras.size(), 2u);
    const frame::Camera& close_up = recorder.cameras[1];
    const double distance = (close_up.position - close_up.target).norm() - side / 2;
    const double height = 2 * distance * std::tan(std::numbers::pi / 12);
    EXPECT_NEAR(height, 0.1 * std::min(1.0, std::sqrt(2.0) * size), 1e-9) << size;
  }
}

}  // namespace
}  // namespace weft::cli
