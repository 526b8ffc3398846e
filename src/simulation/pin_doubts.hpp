// What a scene's pins are about to do that its author may not mean.
#pragma once

#include <string>
#include <vector>

#include "environment/environment.hpp"
#include "scene/scene.hpp"

namespace weft::simulation {

/// A sentence for each pin moved by keys that jumps at the start, and for each, also of those that follow a body, that
/// moves too fast for cloth to follow: "cloth.a.pin.0: ...". For all others nothing is computed.
std::vector<std::string> find_jumps(const scene::Scene& scene, const environment::Environment& environment);

/// Likewise for each obstacle that such a pin enters, with the first time.
std::vector<std::string> find_entries(const scene::Scene& scene, const environment::Environment& environment);

/// Likewise for each two pins on a rectangle of cloth, one of them such a pin, that move farther apart than the cloth
/// between them can be stretched.
std::vector<std::string> find_stretches(const scene::Scene& scene, const environment::Environment& environment);

/// Likewise for each pin that follows a body from farther away than what is worn.
std::vector<std::string> find_far_pins(const scene::Scene& scene, const environment::Environment& environment);

/// Whether there is a pin that keys or a body move.
bool has_moving_pins(const scene::Scene& scene);

}  // namespace weft::simulation
