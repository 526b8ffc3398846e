// Small scenes for tests, made without scene files.
#pragma once

#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/scene/scene.hpp"

namespace weft::simulation::testing {

inline constexpr scene::Integrator kIntegrators[] = {scene::Integrator::implicit_euler,
                                                     scene::Integrator::implicit_midpoint, scene::Integrator::bdf2};

/// A made-up material, so that expected values of tests do not change when fabrics are measured again.
inline scene::Material test_material() {
  scene::Material material;
  material.density = 0.2;
  material.stretch_weft = material.stretch_warp = 1000;
  material.shear = 100;
  material.bend = 5e-5;
  material.bend_viscosity = 5e-6;
  material.bend_friction = 2e-4;
  material.max_stretch = 0;
  return material;
}

/// A square sheet of the test material, of `size` [m], flat at `height` [m], without air and without contact.
inline scene::Scene sheet_alone(double size, int particles, double height) {
  scene::Scene scene;
  scene.name = "test";
  scene.time = {.duration = 1, .fps = 25, .step = 0.02};
  scene.physics.air_density = 0;
  scene.contact.self = scene.contact.obstacles = false;
  scene::Cloth cloth;
  cloth.name = "sheet";
  cloth.size = {size, size};
  cloth.particles_weft = cloth.particles_warp = particles;
  cloth.pose.position = {0, 0, height};
  cloth.material = test_material();
  scene.cloths.push_back(cloth);
  return scene;
}

/// Sets Newton's method and conjugate gradients to solve down to rounding.
inline void solve_tightly(scene::Scene& scene) {
  scene.solver = {.newton_tolerance = 1e-9, .newton_iterations = 60, .linear_tolerance = 1e-9, .halvings = 0};
}

/// An obstacle without rotation and key frames.
inline scene::Obstacle obstacle(const char* name, scene::Shape shape, const Vec3& position = Vec3::Zero()) {
  scene::Obstacle made;
  made.name = name;
  made.shape = std::move(shape);
  made.pose.position = position;
  return made;
}

/// A patch of 0.2 m on a plane that is inclined about the y axis by `angle` [rad]. There is no air, so only friction
/// holds it.
inline scene::Scene patch_on_slope(double angle, double friction) {
  scene::Scene scene = sheet_alone(0.2, 11, 0);
  scene.time.fps = 50;
  scene.contact.self = scene.contact.obstacles = true;
  scene.solver.newton_tolerance = 1e-4;  // relative to the weight; tests resolve 2 % of friction
  scene.solver.linear_tolerance = 1e-3;
  const Quat turned(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  scene.obstacles.push_back(obstacle("slope", scene::Plane{}));
  scene.obstacles[0].pose.rotation = turned;
  scene.obstacles[0].friction = friction;
  scene::Cloth& cloth = scene.cloths[0];
  cloth.material.friction = friction;
  cloth.material.drag = 0;
  cloth.pose.rotation = turned;
  cloth.pose.position = turned * Vec3(0, 0, 0.5 * cloth.material.thickness);
  return scene;
}

/// Pins two corners of a cloth, those at this height along the warp: 0 or 1.
inline void pin_corners(scene::Cloth& cloth, double height) {
  scene::Pin left, right;
  left.low = left.high = {0, height};
  right.low = right.high = {1, height};
  cloth.pins = {left, right};
}

/// Positions of the first cloth.
inline const std::vector<Vec3>& sheet_of(const frame::SnapshotPtr& snapshot) {
  return snapshot->states[0].positions;
}

/// Height of the lowest particle [m].
inline double lowest(const std::vector<Vec3>& x) {
  double minimum = x.front().z();
  for (const Vec3& point : x) minimum = std::min(minimum, point.z());
  return minimum;
}

/// Two jaws close on a hanging sheet until they overlap, and open. The jaws are thin, so that cloth inside a jaw may be
/// nearer to the back of the jaw than to its front.
inline constexpr const char* kThinJaws = R"(
[time]
duration = 1
[[cloth]]
name = "sheet"
size = [0.4, 0.4]
particles = [11, 11]
position = [0, 0, 0.6]
rotation = [90, 0, 0]
pin = [{ low = [0, 1], high = [1, 1] }]
[[obstacle]]
name = "left"
shape = "box"
size = [0.2, 0.016, 0.2]
interpolation = "linear"
keys = [
  { time = 0.0, position = [0.02, -0.108, 0.55] }, { time = 0.2, position = [0.02, -0.003, 0.55] },
  { time = 0.4, position = [0.02, -0.003, 0.55] }, { time = 0.6, position = [0.02, -0.158, 0.55] },
]
[[obstacle]]
name = "right"
shape = "box"
size = [0.2, 0.016, 0.2]
interpolation = "linear"
keys = [
  { time = 0.0, position = [-0.02, 0.108, 0.53] }, { time = 0.2, position = [-0.02, 0.003, 0.53] },
  { time = 0.4, position = [-0.02, 0.003, 0.53] }, { time = 0.6, position = [-0.02, 0.158, 0.53] },
]
)";

/// Pins move the upper edge of a sheet into a box: the pin lags from frame 4 to 13.
inline constexpr const char* kLaggingPin = R"(
[[cloth]]
name = "sheet"
size = [0.4, 0.4]
particles = [9, 9]
position = [0, 0, 0.6]
rotation = [90, 0, 0]
[[cloth.pin]]
low = [0, 1]
interpolation = "linear"
keys = [{ time = 0 }, { time = 0.2, offset = [0, 0.3, 0] }, { time = 0.3 }, { time = 0.45, offset = [0, 0, 0] }]
[[obstacle]]
name = "box"
shape = "box"
size = [0.6, 0.4, 0.6]
position = [0, 0.35, 0.6]
)";

/// Pattern of a tube skirt of two rectangles, each 0.33 m wide. Text appended to it belongs to its last seam.
inline const std::string kTube = R"(
depth = 0.14
[[panel]]
name = "front"
path = "M -0.165 0 L 0.165 0 L 0.165 0.3 L -0.165 0.3 Z"
edges = "hem right top left"
[[panel]]
name = "back"
side = "back"
path = "M -0.165 0 L 0.165 0 L 0.165 0.3 L -0.165 0.3 Z"
edges = "hem right top left"
[[seam]]
a = "front.left"
b = "back.left"
[[seam]]
a = "front.right"
b = "back.right"
)";

}  // namespace weft::simulation::testing
