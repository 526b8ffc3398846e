// All frames of each scene.
#include "validation/every_frame.hpp"

namespace weft::simulation {
namespace {

using testing::SceneRun;

class EveryFrame : public ::testing::TestWithParam<SceneRun> {};

TEST_P(EveryFrame, HasNoIntersection) {
  testing::expect_no_intersections(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Of, EveryFrame,
                         ::testing::Values(SceneRun{"falling_band", 1, -1}, SceneRun{"falling_band", 2, -1},
                                           SceneRun{"falling_band", 4, -1}, SceneRun{"ball_through_cloth", 1, -1},
                                           SceneRun{"ball_through_cloth", 2, -1}, SceneRun{"ball_through_cloth", 4, -1},
                                           SceneRun{"sphere_drape", 1, -1}, SceneRun{"sphere_drape", 2, -1},
                                           SceneRun{"sphere_drape", 4, -1}, SceneRun{"multi_sheet", 1, -1},
                                           SceneRun{"multi_sheet", 2, -1}, SceneRun{"multi_sheet", 4, -1}),
                         testing::name_of_run);

}  // namespace
}  // namespace weft::simulation
