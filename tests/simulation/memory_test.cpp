// Tests the memory of a simulation per particle.
#include <gtest/gtest.h>
#include <malloc.h>

#include <filesystem>

#include "film/production/scene_simulation.hpp"
#include "support/scene_runs.hpp"

namespace weft::simulation {
namespace {

// Measured after the frame in which the sheet meets the sphere, because near pairs take memory, too.
TEST(Simulation, TakesLessThanFiveKilobytesAParticle) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer has its own malloc";
#endif
  const auto bytes_in_use = [] {
    const auto info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd);
  };
  const scene::Scene scene = support::scene_of(std::filesystem::path(WEFT_SOURCE_DIR) / "scenes/sphere_drape.toml",
                                               {"cloth.sheet.position=[0.003,0.002,0.413]"});
  const double before = bytes_in_use();
  production::SceneSimulation simulation(scene);
  for (int k = 0; k < 3; ++k) simulation.advance();
  EXPECT_LT((bytes_in_use() - before) / static_cast<double>(simulation.particles()), 4800);
}

}  // namespace
}  // namespace weft::simulation
