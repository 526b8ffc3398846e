#include "film/environment/dynamics.hpp"

#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"

namespace weft::environment {

std::shared_ptr<const model::Dynamics> make_dynamics(const scene::Scene& scene, const scene::Obstacle& obstacle,
                                                     const mesh::Mesh& mesh) {
  try {
    mesh::RigidFrame frame(mesh.topology.triangles, mesh.positions);
    const double mass = obstacle.mass > 0 ? obstacle.mass : obstacle.density * frame.volume();
    const Vec3 turn = std::numbers::pi / 180 * obstacle.spin;
    // Without a release, forces move the obstacle from the start, even in a preroll.
    const double release = obstacle.release > 0 ? obstacle.release : -std::numeric_limits<double>::infinity();
    return std::make_shared<const model::Dynamics>(
        model::Dynamics{std::move(frame), mass, obstacle.velocity, turn, release});
  } catch (const std::invalid_argument& expected) {
    throw Error(ExitCode::scene_invalid,
                "{}:{}:{}: obstacle.{}: expected {} for a body with a mass, whose inertia is that of its interior; got "
                "{} triangles that leave it open; fill its holes in a modelling program, or use a shape",
                scene.file.string(), obstacle.line, obstacle.column, obstacle.name, expected.what(),
                mesh.topology.triangles.size());
  }
}

}  // namespace weft::environment
