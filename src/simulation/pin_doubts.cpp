#include "simulation/pin_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "collision/proximity/surface_point.hpp"
#include "mesh/geometry.hpp"
#include "simulation/pins.hpp"

namespace weft::simulation {
namespace {

// Speed of a pin above which a sheet is torn along rather than led [m/s]; a hand reaches 10.
constexpr double kFastest = 20;
// Way of a pin in the first instant that is told of [m].
constexpr double kJump = 1e-3;
// How deep a particle is in an obstacle that it enters [m].
constexpr double kDepth = 1e-3;
// Looks that are taken at each frame.
constexpr int kLooks = 4;

using Held = std::vector<integrator::HeldParticle>;

bool moves(const scene::Pin& pin) {
  return !pin.motion.keys.empty();
}

struct MovingPins {
  Pins pins;
  std::vector<Vec3> start;  // of all particles

  MovingPins(const scene::Scene& scene, const environment::Environment& environment)
      : pins(scene, environment, firsts(environment)) {
    for (const environment::ClothObject& cloth : environment.cloths)
      start.insert(start.end(), cloth.start.begin(), cloth.start.end());
  }
  static std::vector<Index> firsts(const environment::Environment& environment) {
    std::vector<Index> first{0};
    for (const environment::ClothObject& cloth : environment.cloths)
      first.push_back(first.back() + static_cast<Index>(cloth.start.size()));
    return first;
  }
  bool is_moved(const scene::Scene& scene, std::size_t pin) const {
    const Pins::About& about = pins.about(pin);
    return moves(scene.cloths[about.cloth].pins[about.number]);
  }
  std::string name(const scene::Scene& scene, std::size_t pin) const {
    const Pins::About& about = pins.about(pin);
    return fmt::format("cloth.{}.pin.{}", scene.cloths[about.cloth].name, about.number);
  }
};

// Times to look at: some of every frame, and all keys of pins and halves of what is between them.
std::vector<double> times_of(const scene::Scene& scene) {
  std::set<double> times;
  const int looks = kLooks * (scene.frame_count() - 1);
  for (int k = 0; k <= looks; ++k) times.insert(k / (kLooks * scene.time.fps));
  for (const scene::Cloth& cloth : scene.cloths) {
    for (const scene::Pin& pin : cloth.pins) {
      const auto& keys = pin.motion.keys;
      for (std::size_t k = 0; k + 1 < keys.size(); ++k) times.insert(0.5 * (keys[k].time + keys[k + 1].time));
    }
  }
  while (!times.empty() && *times.rbegin() > scene.time.duration) times.erase(std::prev(times.end()));
  return {times.begin(), times.end()};
}

}  // namespace

bool has_moving_pins(const scene::Scene& scene) {
  return std::ranges::any_of(scene.cloths,
                             [](const scene::Cloth& cloth) { return std::ranges::any_of(cloth.pins, moves); });
}

std::vector<std::string> find_jumps(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::string> found;
  if (!has_moving_pins(scene)) return found;
  const MovingPins moving(scene, environment);
  std::set<std::size_t> jumps, fast;
  Held held;
  const double start = -scene.preroll_frames() / scene.time.fps;
  moving.pins.held_at(start, environment, held);
  for (const integrator::HeldParticle& particle : held) {
    const std::size_t pin = moving.pins.of(particle.constraint.particle);
    const double way = (particle.x_end - moving.start[static_cast<std::size_t>(particle.constraint.particle)]).norm();
    if (way > kJump && moving.is_moved(scene, pin) && jumps.insert(pin).second)
      found.push_back(fmt::format(
          "{}: its keys begin {:.3g} m away from where its particles start, and they jump there in the first "
          "step; begin with offset = [0, 0, 0]",
          moving.name(scene, pin), way));
  }
  for (const double t : times_of(scene)) {
    moving.pins.held_at(t, environment, held);
    for (const integrator::HeldParticle& particle : held) {
      const std::size_t pin = moving.pins.of(particle.constraint.particle);
      const double speed = particle.v_end.norm();
      if (speed > kFastest && moving.is_moved(scene, pin) && fast.insert(pin).second)
        found.push_back(fmt::format("{}: moves at {:.3g} m/s at {:.4g} s, which tears cloth along",
                                    moving.name(scene, pin), speed, t));
    }
  }
  return found;
}

std::vector<std::string> find_entries(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::string> found;
  if (!has_moving_pins(scene) || !scene.contact.obstacles) return found;
  const MovingPins moving(scene, environment);
  Held held;
  std::vector<Vec3> x;
  for (std::size_t b = 0; b < environment.bodies.size(); ++b) {
    const environment::BodyObject& body = environment.bodies[b];
    if (!body.collide || body.character) continue;
    std::set<std::size_t> entered, outside;
    x.resize(body.mesh.positions.size());
    for (const double t : times_of(scene)) {
      environment.place(b, t, x);
      const Box3 box = mesh::bounding_box(x);
      moving.pins.held_at(t, environment, held);
      for (const integrator::HeldParticle& particle : held) {
        const std::size_t pin = moving.pins.of(particle.constraint.particle);
        if (entered.contains(pin) || !moving.is_moved(scene, pin)) continue;
        // Of an open surface, as the floor is, what is behind it counts as inside where it was before it first.
        const bool may_be_in = box.contains(particle.x_end) || body.infinite_floor;
        const double height =
            may_be_in ? collision::nearest_point(particle.x_end, body.mesh.topology.triangles, x).height : 1;
        if (height > 0) outside.insert(pin);
        if (height > -kDepth || !outside.contains(pin)) continue;
        entered.insert(pin);
        found.push_back(fmt::format("{}: enters '{}' at {:.4g} s, and will lag behind there", moving.name(scene, pin),
                                    body.name, t));
      }
    }
  }
  return found;
}

}  // namespace weft::simulation
