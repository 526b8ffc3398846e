// Warns of pins whose motion the author of a scene may not intend.
#pragma once

#include <string>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/scene/scene.hpp"

namespace weft::production {

/// One warning ("cloth.a.pin.0: ...") for each key-framed pin that jumps at the start, and for each pin, key-framed or
/// following a body, that moves too fast for cloth to follow. Computes nothing if no pin moves.
std::vector<std::string> find_jumps(const scene::Scene& scene, const environment::Environment& environment);

/// One warning for each pair of a key-framed pin and a rigid, not dynamic obstacle that the pin enters; it states when
/// the pin first enters.
std::vector<std::string> find_entries(const scene::Scene& scene, const environment::Environment& environment);

/// One warning for each pair of rigid pins (no `strength`) on a rectangular cloth, at least one of them key-framed,
/// that move farther apart than the cloth between them can stretch.
std::vector<std::string> find_stretches(const scene::Scene& scene, const environment::Environment& environment);

/// One warning for each pin that follows a body, except an infinite floor, from more than 0.1 m away at the start.
std::vector<std::string> find_far_pins(const scene::Scene& scene, const environment::Environment& environment);

/// Whether any pin has keys or follows a body.
bool has_moving_pins(const scene::Scene& scene);

}  // namespace weft::production
