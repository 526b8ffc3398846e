#include "film/production/pin_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "physics/collision/proximity/surface_point.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/simulation/pins.hpp"

namespace weft::production {
namespace {

// A pin gets a warning if its keys begin farther than this from its particles [m].
constexpr double kMinJump = 1e-3;
// Maximum distance without a warning between a pin and the body that it follows, at the start [m]. Pins of capes start
// up to 0.05 m away.
constexpr double kMaxPinDistance = 0.1;
// A particle counts as inside an obstacle from this depth below its surface on [m].
constexpr double kEntryDepth = 1e-3;
// Number of times per frame at which the positions of pins are tested.
constexpr int kSamplesPerFrame = 4;
// Maximum number of particles of a pin that are tested; held_regions() adds the last particle of the pin.
constexpr std::size_t kMaxSampledParticles = 41;

using simulation::kMaxHoldSpeed;
using HeldParticles = std::vector<integrator::HeldParticle>;

bool has_keys(const scene::Pin& pin) {
  return !pin.motion.keys.empty();
}

bool follows(const scene::Pin& pin) {
  return !pin.follow.empty();
}

bool any_pin(const scene::Scene& scene, bool (*is)(const scene::Pin&)) {
  return std::ranges::any_of(scene.cloths,
                             [&](const scene::Cloth& cloth) { return std::ranges::any_of(cloth.pins, is); });
}

std::string pin_name(const scene::Cloth& cloth, std::size_t number) {
  return fmt::format("{}.{}.pin.{}", cloth.rope ? "rope" : "cloth", cloth.name, number);
}

// The pins of a scene with the start positions of all particles.
struct MovingPins {
  std::vector<Index> first;  // first particle of each cloth, then the number of all particles
  simulation::Pins pins;
  std::vector<Vec3> start;  // start positions of all particles [m]

  explicit MovingPins(const environment::Environment& environment)
      : first(firsts(environment)), pins(environment.model, first) {
    for (const model::Cloth& cloth : environment.model.cloths)
      start.insert(start.end(), cloth.start.begin(), cloth.start.end());
  }
  static std::vector<Index> firsts(const environment::Environment& environment) {
    std::vector<Index> first{0};
    for (const model::Cloth& cloth : environment.model.cloths)
      first.push_back(first.back() + static_cast<Index>(cloth.start.size()));
    return first;
  }
  const scene::Pin& pin(const scene::Scene& scene, std::size_t number) const {
    const simulation::Pins::Info& info = pins.info(number);
    return scene.cloths[info.cloth].pins[info.number];
  }
  bool is_moved(const scene::Scene& scene, std::size_t number) const { return has_keys(pin(scene, number)); }
  std::string name(const scene::Scene& scene, std::size_t pin) const {
    const simulation::Pins::Info& info = pins.info(pin);
    return pin_name(scene.cloths[info.cloth], info.number);
  }
};

// Tested particles of one pin. Only for pins without a strength, on rectangular cloth.
struct HeldRegion {
  std::vector<Vec3> x;     // positions at one time [m]
  std::vector<Vec2> rest;  // rest coordinates [m]
};

// Returns one region per pin, at the time t [s]. The regions of pins with a strength, and of pins on cloth that is not
// rectangular, are empty.
std::vector<HeldRegion> held_regions(const scene::Scene& scene, const environment::Environment& environment,
                                     const MovingPins& moving, const HeldParticles& held, double t) {
  std::vector<HeldRegion> regions(moving.pins.size());
  std::vector<std::size_t> seen(moving.pins.size(), 0);
  for (const integrator::HeldParticle& particle : held) {
    const std::size_t pin = moving.pins.pin_of(particle.constraint.particle, t);
    const simulation::Pins::Info& info = moving.pins.info(pin);
    const scene::Cloth& cloth = scene.cloths[info.cloth];
    const std::size_t every = (info.particles + kMaxSampledParticles - 1) / kMaxSampledParticles, number = seen[pin]++;
    if (info.strength || rectangle_particles(cloth) == 0 || (number % every != 0 && number + 1 != info.particles))
      continue;
    const auto at = static_cast<std::size_t>(particle.constraint.particle - moving.first[info.cloth]);
    regions[pin].x.push_back(particle.x_end);
    regions[pin].rest.push_back(environment.cloths[info.cloth].fractions[at].cwiseProduct(cloth.size));
  }
  return regions;
}

// Whether any particle belongs to both pins. `a`, `b`: indices of the pins within the cloth.
bool overlap(const model::Cloth& cloth, std::size_t a, std::size_t b) {
  const std::vector<model::WeightedParticle>& others = cloth.pins[b].particles;
  return std::ranges::any_of(cloth.pins[a].particles, [&](const model::WeightedParticle& chosen) {
    return std::ranges::find(others, chosen.particle, &model::WeightedParticle::particle) != others.end();
  });
}

// Largest ratio of distance to rest distance between particles of two regions.
double stretch_between(const HeldRegion& a, const HeldRegion& b) {
  double max_ratio = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i)
    for (std::size_t j = 0; j < b.x.size(); ++j)
      max_ratio = std::max(max_ratio, (a.x[i] - b.x[j]).norm() / (a.rest[i] - b.rest[j]).norm());
  return max_ratio;
}

// The times to test [s]: kSamplesPerFrame in each frame, and the middle between each two neighbouring keys of a pin.
std::vector<double> times_of(const scene::Scene& scene) {
  std::set<double> times;
  const int samples = kSamplesPerFrame * (scene.frame_count() - 1);
  for (int k = 0; k <= samples; ++k) times.insert(k / (kSamplesPerFrame * scene.time.fps));
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
  return any_pin(scene, has_keys) || any_pin(scene, follows);
}

std::vector<std::string> find_jumps(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::string> found;
  if (!has_moving_pins(scene)) return found;
  const MovingPins moving(environment);
  std::set<std::size_t> jumps, fast;
  HeldParticles held;
  const double start = scene.start_time();
  moving.pins.held_at(start, environment.model, held);
  for (const integrator::HeldParticle& particle : held) {
    const std::size_t pin = moving.pins.pin_of(particle.constraint.particle, start);
    const double distance =
        (particle.x_end - moving.start[static_cast<std::size_t>(particle.constraint.particle)]).norm();
    if (distance > kMinJump && moving.is_moved(scene, pin) && jumps.insert(pin).second)
      found.push_back(fmt::format(
          "{}: its keys begin {:.3g} m away from where its particles start, and they jump there in the first "
          "step; begin with offset = [0, 0, 0]",
          moving.name(scene, pin), distance));
  }
  std::vector<Vec3> before = moving.start;
  double last = start;
  for (const double t : times_of(scene)) {
    moving.pins.held_at(t, environment.model, held);
    for (const integrator::HeldParticle& particle : held) {
      const std::size_t number = moving.pins.pin_of(particle.constraint.particle, t);
      Vec3& x = before[static_cast<std::size_t>(particle.constraint.particle)];
      // Also tests the mean speed since the previous time: if a target jumps between two times, its velocities at these
      // times do not show the jump.
      const double mean = t > last && last >= 0 ? (particle.x_end - x).norm() / (t - last) : 0;
      const double speed = std::max(particle.v_end.norm(), mean);
      x = particle.x_end;
      const scene::Pin& pin = moving.pin(scene, number);
      if (speed <= kMaxHoldSpeed || !fast.insert(number).second) continue;
      std::string reason;
      if (follows(pin))
        reason = fmt::format(
            "; '{}', which it follows, moves or jumps there: keys farther apart make it slower, and a "
            "jump needs a scene of its own on either side",
            pin.follow);
      else if (!has_keys(pin))
        reason = "; it takes over particles that an earlier pin has moved and releases";
      found.push_back(fmt::format("{}: moves at {:.3g} m/s at {:.4g} s, where cloth can follow at {:g} m/s{}",
                                  moving.name(scene, number), speed, t, kMaxHoldSpeed, reason));
    }
    last = t;
  }
  return found;
}

std::vector<std::string> find_far_pins(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::string> found;
  if (!any_pin(scene, follows)) return found;
  const double start = scene.start_time();
  std::vector<Vec3> x;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    for (std::size_t p = 0; p < scene.cloths[c].pins.size(); ++p) {
      const std::string name = scene::followed(scene.cloths[c].pins[p].follow).body;
      const auto body = std::ranges::find(environment.model.bodies, name, &model::Body::name);
      const std::vector<model::WeightedParticle>& chosen = environment.model.cloths[c].pins[p].particles;
      if (body == environment.model.bodies.end() || body->infinite_floor || chosen.empty()) continue;
      x.resize(body->mesh.positions.size());
      environment.model.place(static_cast<std::size_t>(body - environment.model.bodies.begin()), start, x);
      const std::size_t every = (chosen.size() + kMaxSampledParticles - 1) / kMaxSampledParticles;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < chosen.size(); k += every) {
        const Vec3& place = environment.model.cloths[c].start[static_cast<std::size_t>(chosen[k].particle)];
        nearest = std::min(nearest, collision::nearest_point(place, body->mesh.topology.triangles, x).height);
      }
      if (nearest > kMaxPinDistance && std::isfinite(nearest))
        found.push_back(
            fmt::format("{}: follows '{}' from {:.3g} m away at the start, where what is worn lies on it; {} nearer",
                        pin_name(scene.cloths[c], p), scene.cloths[c].pins[p].follow, nearest,
                        scene.cloths[c].rope ? "its points bring it" : "position of the cloth brings it"));
    }
  return found;
}

std::vector<std::string> find_stretches(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::string> found;
  if (!has_moving_pins(scene)) return found;
  const MovingPins moving(environment);
  struct Stretch {
    double from = 0, max_ratio = 0, at = 0;  // `from`, `at`: times [s]; `max_ratio`: length / length at rest
  };
  std::map<std::pair<std::size_t, std::size_t>, Stretch> stretches;
  HeldParticles held;
  for (const double t : times_of(scene)) {
    moving.pins.held_at(t, environment.model, held);
    const std::vector<HeldRegion> regions = held_regions(scene, environment, moving, held, t);
    for (std::size_t b = 1; b < regions.size(); ++b)
      for (std::size_t a = 0; a < b; ++a) {
        const std::size_t cloth = moving.pins.info(a).cloth;
        const bool follow_different_bodies = moving.pin(scene, a).follow != moving.pin(scene, b).follow;
        const bool can_move_apart = follow_different_bodies || moving.is_moved(scene, a) || moving.is_moved(scene, b);
        if (cloth != moving.pins.info(b).cloth || !can_move_apart) continue;
        const double limit = scene.cloths[cloth].material.max_stretch, ratio = stretch_between(regions[a], regions[b]);
        if (limit == 0 || ratio <= 1 + limit) continue;
        Stretch& stretch = stretches.try_emplace({a, b}, Stretch{t}).first->second;
        if (ratio > stretch.max_ratio) stretch.max_ratio = ratio, stretch.at = t;
      }
  }
  for (const auto& [pins, stretch] : stretches) {
    const simulation::Pins::Info &a = moving.pins.info(pins.first), &b = moving.pins.info(pins.second);
    found.push_back(fmt::format(
        "{}: stretches the cloth between it and pin {} beyond its max_stretch from {:.4g} s on, by {:.3g} % at {:.4g} "
        "s{}",
        moving.name(scene, pins.second), a.number, stretch.from, 100 * (stretch.max_ratio - 1), stretch.at,
        overlap(environment.model.cloths[a.cloth], a.number, b.number)
            ? fmt::format("; pin {} holds the particles that both select", a.number)
            : ""));
  }
  return found;
}

std::vector<std::string> find_entries(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::string> found;
  if (!any_pin(scene, has_keys) || !scene.contact.obstacles) return found;
  const MovingPins moving(environment);
  HeldParticles held;
  std::vector<Vec3> x;
  for (std::size_t b = 0; b < environment.model.bodies.size(); ++b) {
    const model::Body& body = environment.model.bodies[b];
    if (!body.collide || body.deforms() || body.dynamics) continue;
    std::set<std::size_t> entered, outside;
    x.resize(body.mesh.positions.size());
    Box3 box;
    const auto sample_at = [&](double t) {
      environment.model.place(b, t, x);
      box = mesh::bounding_box(x);
      moving.pins.held_at(t, environment.model, held);
    };
    const auto height_of = [&](const Vec3& p) {
      const bool may_be_in = box.contains(p) || body.infinite_floor;
      return may_be_in ? collision::nearest_point(p, body.mesh.topology.triangles, x).height : 1;
    };
    // Also tests the start positions, because keys may begin inside the body.
    const double start = scene.start_time();
    sample_at(start);
    for (const integrator::HeldParticle& particle : held)
      if (height_of(moving.start[static_cast<std::size_t>(particle.constraint.particle)]) > 0)
        outside.insert(moving.pins.pin_of(particle.constraint.particle, start));
    for (const double t : times_of(scene)) {
      sample_at(t);
      for (const integrator::HeldParticle& particle : held) {
        const std::size_t pin = moving.pins.pin_of(particle.constraint.particle, t);
        if (entered.contains(pin) || !moving.is_moved(scene, pin)) continue;
        // A pin enters a body only if the pin was outside before. An open surface, such as a floor, has no inside: a
        // pin that has always been behind the surface has not entered it.
        const double height = height_of(particle.x_end);
        if (height > 0) outside.insert(pin);
        if (height > -kEntryDepth || !outside.contains(pin)) continue;
        entered.insert(pin);
        found.push_back(fmt::format("{}: enters '{}' at {:.4g} s, and will lag behind its target there",
                                    moving.name(scene, pin), body.name, t));
      }
    }
  }
  return found;
}

}  // namespace weft::production
