// Tests of seams that tear: the load that they bear, where they open, and saved states.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/saved_state.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

class Tearing : public support::TestFolder {
 protected:
  static constexpr double kWidth = 0.2, kLower = 0.1, kDensity = 0.3;  // [m], [m], [kg/m²]
  static constexpr double kLoad = kDensity * kLower * 9.81;            // weight below the seam, per length [N/m]

  /// A strip of two panels, pinned at its upper edge, with a seam between them that tears at `load` [N/m]. The cloth
  /// is sewn within 0.2 s. `more`: further keys of the cloth.
  scene::Scene strip(double load, const std::string& more = "") const {
    const std::string file = (folder_ / "strip.toml").string();
    support::write_bytes(file, fmt::format("[[panel]]\nname = 'upper'\nposition = [0, 0.102]\n"
                                           "path = 'M 0 0 L 0.2 0 L 0.2 0.1 L 0 0.1 Z'\nedges = 'low right high left'\n"
                                           "[[panel]]\nname = 'lower'\n"
                                           "path = 'M 0 0 L 0.2 0 L 0.2 0.1 L 0 0.1 Z'\nedges = 'low right high left'\n"
                                           "[[seam]]\na = 'upper.low'\nb = 'lower.high'\ntearing_load = {}\n",
                                           load));
    return support::scene_of_text(
        "[time]\nduration = 1\nstep = 0.01\n[physics]\nair_density = 0\n[[cloth]]\nname = 'strip'\nshape = 'pattern'\n"
        "file = '" +
        file + "'\nedge_length = 0.02\nsewing = 0.2\nposition = [0, 0, 1]\n" +
        fmt::format("material = {{ density = {}, stretch_viscosity = 0.5 }}\n", kDensity) +
        "pin = [{ edge = 'upper.high' }]\n" + more);
  }
};

TEST_F(Tearing, SeamsBearTheWeightThatHangsOnThem) {
  const auto frames = support::run_scene(strip(2 * kLoad), {.counts_intersections = false});
  const simulation::AttachmentLoad& seam = frames.back().report.attachments.at(0);
  EXPECT_EQ(seam.name, "strip: upper.low + lower.high");
  EXPECT_TRUE(seam.holds);
  EXPECT_NEAR(seam.load / (kLoad * kWidth), 1, 0.02);
}

TEST_F(Tearing, SeamsPartAboveTheirLoadAndNotWhileTheyAreSewn) {
  const auto frames = support::run_scene(strip(0.5 * kLoad), {.counts_intersections = false});
  EXPECT_FALSE(frames.back().report.attachments.at(0).holds);
  EXPECT_EQ(frames.back().report.attachments.at(0).load, 0);
  double lowest = 2;
  for (const Vec3& x : frames.back().cloths.at(0)) lowest = std::min(lowest, x.z());
  EXPECT_LT(lowest, 0);  // the lower panel falls for at least half a second
}

TEST_F(Tearing, SeamsPartWhereTheLoadIsFirst) {
  // The weight of 0.1 kg hangs at the left end of the lower edge.
  const scene::Scene scene = strip(30 * kLoad, "weight = [{ edge = 'lower.low', high = [0.3, 1], mass = 0.1 }]\n");
  bool was_torn_in_part = false;
  for (const support::MeasuredFrame& frame :
       support::run_scene(scene, {.counts_intersections = false, .keep_positions = true})) {
    const simulation::AttachmentLoad& seam = frame.report.attachments.at(0);
    double left = 2, right = 2;  // height of the lower corners [m]
    for (const Vec3& x : frame.cloths.at(0)) (x.x() < 0.1 ? left : right) = std::min(x.x() < 0.1 ? left : right, x.z());
    was_torn_in_part |= seam.holds && left < right - 0.01;
  }
  EXPECT_TRUE(was_torn_in_part);
}

TEST_F(Tearing, GoesOnFromSavedStatesAsIfNeverInterrupted) {
  const auto continued = testing::continue_runs(strip(0.5 * kLoad), {16, {4, 8, 12}});
  EXPECT_EQ(continued.difference, "");
}

}  // namespace
}  // namespace weft::simulation
