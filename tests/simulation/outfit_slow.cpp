// Tests garments that are sewn over other sewn garments.
#include <gtest/gtest.h>

#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

// The gallery's outfit with coarser meshes; each layer is sewn over the previous one in its own part of the preroll.
TEST(Outfit, HasNoIntersectionsAndIsSewn) {
  const auto frames =
      support::run_scene(support::scene_of(std::filesystem::path(WEFT_SOURCE_DIR) / "scenes/gallery/outfit.toml",
                                           {"cloth.trousers.edge_length=0.022", "cloth.shirt.edge_length=0.022",
                                            "cloth.jacket.edge_length=0.022", "time.duration=0.6"}));
  ASSERT_EQ(frames.size(), 16u);
  for (const support::MeasuredFrame& frame : frames) {
    EXPECT_EQ(frame.pairs, 0u) << frame.report.frame << ": " << frame.between;
    // The strain of a garment that is not sewn is a third, because the loops of panels around a limb start wider by a
    // third.
    EXPECT_LT(frame.report.max_strain, 0.3) << frame.report.frame;
  }
}

}  // namespace
}  // namespace weft::simulation
