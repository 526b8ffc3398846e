// The first frames of each scene, with its main events; every_frame_slow.cpp tests all frames.
#include "validation/every_frame.hpp"

namespace weft::simulation {
namespace {

using testing::SceneRun;

class FirstFrames : public ::testing::TestWithParam<SceneRun> {};

TEST_P(FirstFrames, HaveNoIntersection) {
  testing::expect_no_intersections(GetParam());
}

// Each run includes the main event of its scene: the band has folded, the ball has passed the cloth, the sheet lies on
// the sphere, and the first of the eight sheets have landed. Steps are four times as long as in the scene, which makes
// contacts harder to solve. every_frame_slow.cpp runs all frames, with the scene's step and with twice its step.
INSTANTIATE_TEST_SUITE_P(Of, FirstFrames,
                         ::testing::Values(SceneRun{"falling_band", 4, 36}, SceneRun{"ball_through_cloth", 4, 36},
                                           SceneRun{"sphere_drape", 4, 20}, SceneRun{"multi_sheet", 4, 60}),
                         testing::name_of_run);

}  // namespace
}  // namespace weft::simulation
