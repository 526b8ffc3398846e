// Bodies that the cloth cannot reach have no influence on it, to the bit.
#include <gtest/gtest.h>

#include <vector>

#include "film/production/scene_simulation.hpp"
#include "simulation/scenes.hpp"

namespace weft::simulation {
namespace {

/// A sheet falls on a ball and slides on to the floor.
scene::Scene sheet_on_ball() {
  scene::Scene scene = testing::sheet_alone(0.5, 17, 0.33);
  scene.time.step = 0.01;
  scene.contact.self = scene.contact.obstacles = true;
  scene.cloths[0].pose.position += Vec3(0.03, 0.02, 0);
  scene.obstacles.push_back(testing::obstacle("ball", scene::Sphere{0.15}, {0, 0, 0.16}));
  scene.obstacles.push_back(testing::obstacle("floor", scene::Plane{}));
  return scene;
}

/// Positions of the sheet in all frames.
std::vector<std::vector<Vec3>> film_of(const scene::Scene& scene, int frames) {
  production::SceneSimulation simulation(scene);
  std::vector<std::vector<Vec3>> film;
  for (int k = 0; k < frames; ++k) {
    simulation.advance();
    film.push_back(testing::sheet_of(simulation.snapshot()));
  }
  return film;
}

TEST(FarBodies, HaveNoInfluence) {
  constexpr int kFrames = 30;
  const auto alone = film_of(sheet_on_ball(), kFrames);
  for (const Vec3& place : {Vec3(20, 0, 3), Vec3(-4000, 700, 3), Vec3(0, 0, 5), Vec3(0, 1.5, 0)}) {
    for (const bool moves : {false, true}) {
      // A moving prop comes first in the scene; at one place, a still prop does.
      for (const bool comes_first : {moves != (place.z() > 4)}) {
        scene::Scene scene = sheet_on_ball();
        scene::Obstacle prop = testing::obstacle("prop", scene::Sphere{0.1}, place);
        prop.pose.rotation = Quat(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
        if (moves) {
          prop.motion.keys = {{0, {place, Quat::Identity()}}, {1.2, {1.3 * place, prop.pose.rotation}}};
          prop.motion.interpolation = scene::Interpolation::linear;
        }
        scene.obstacles.insert(comes_first ? scene.obstacles.begin() : scene.obstacles.end(), prop);
        const auto film = film_of(scene, kFrames);
        for (std::size_t k = 0; k < film.size(); ++k)
          ASSERT_EQ(film[k], alone[k]) << "frame " << k + 1 << ", at " << place.transpose()
                                       << (moves ? ", moving" : "");
      }
    }
  }
}

}  // namespace
}  // namespace weft::simulation
