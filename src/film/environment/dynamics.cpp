#include "film/environment/dynamics.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"

namespace weft::environment {

std::shared_ptr<const model::Dynamics> make_dynamics(const scene::Scene& scene, const scene::Obstacle& obstacle,
                                                     const mesh::Mesh& mesh) {
  try {
    mesh::RigidFrame frame(mesh.topology.triangles, mesh.positions);
    const double mass = obstacle.mass > 0 ? obstacle.mass : obstacle.density * frame.volume();
    const Vec3 angular_velocity = kDegree * obstacle.spin;
    // If the scene sets no release, or one before the start of the run, forces move the obstacle from this start on.
    const double no_release = -std::numeric_limits<double>::infinity(), release = obstacle.release.value_or(no_release);
    return std::make_shared<const model::Dynamics>(
        model::Dynamics{std::move(frame), mass, obstacle.velocity, angular_velocity,
                        release > scene.start_time() ? release : no_release});
  } catch (const std::invalid_argument& expected) {
    throw Error(ExitCode::scene_invalid,
                "{}:{}:{}: obstacle.{}: expected {} for a body with a mass, whose inertia is that of its interior; got "
                "{} triangles that leave it open or flat, face different ways or divide its interior; mend it in a "
                "modelling program, or use a shape",
                scene.file.string(), obstacle.line, obstacle.column, obstacle.name, expected.what(),
                mesh.topology.triangles.size());
  }
}

}  // namespace weft::environment
