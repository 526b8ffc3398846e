// Warns of pins whose motion the author of a scene may not intend.
#pragma once

#include <string>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/scene/scene.hpp"

namespace weft::production {

/// One warning ("cloth.a.pin.0: ...") for each key-framed pin whose keys begin more than 1 mm away from the start
/// positions of its particles, and one for each pin whose targets move faster than cloth can follow
/// (simulation::kMaxHoldSpeed).
std::vector<std::string> find_jumps(const scene::Scene& scene, const environment::Environment& environment);

/// One warning for each pair of a key-framed pin and an obstacle that the pin enters, with the time of the first entry.
/// Tests only rigid obstacles that collide and have no mass, and only if contact.obstacles is true.
std::vector<std::string> find_entries(const scene::Scene& scene, const environment::Environment& environment);

/// One warning for each pair of pins on a rectangular cloth that move farther apart than `max_stretch` of the cloth
/// between them allows. Tests only pins without a `strength`, pairs in which a pin is key-framed or which follow
/// different bodies, and cloth whose `max_stretch` is above 0.
std::vector<std::string> find_stretches(const scene::Scene& scene, const environment::Environment& environment);

/// One warning for each pin that follows a body if all tested particles of the pin (at most 41) start more than 0.1 m
/// away from the surface of the body. Ignores infinite floors.
std::vector<std::string> find_far_pins(const scene::Scene& scene, const environment::Environment& environment);

/// Whether any pin has keys or follows a body.
bool has_moving_pins(const scene::Scene& scene);

}  // namespace weft::production
