// Lists the parts that the simulation of a scene uses, and warns of settings that its author may not intend.
#pragma once

#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::production {

/// One line of `weft check --plan`: a part of the simulation (a force, a constraint, …), whether this scene uses it,
/// and why.
struct PlanItem {
  std::string part;
  bool used = false;
  std::string reason;
};

/// Lists the parts without building the simulation. Reads the files of characters to find the size of their key frames
/// and the parts that do not collide. Builds cloths from mesh files to find the source of their rest shapes, and cloths
/// from fitted patterns to find their fit. Throws Error(asset_unreadable, scene_invalid) if a file or cloth cannot be
/// used.
std::vector<PlanItem> plan(const scene::Scene& scene);

/// Whether anything in the scene can collide.
bool can_collide(const scene::Scene& scene);

/// One warning for each visible infinite plane after the first, and one for each light after the first
/// frame::kMaxLights. Pictures show neither.
std::vector<std::string> find_undrawn(const scene::Scene& scene);

/// The warnings of `weft check`: those of find_undrawn(), those of pin_warnings.hpp, and with implicit Euler one for
/// each obstacle that can turn freely, because this method slows its rotation. If the scene has moving pins, throws
/// what the constructor of environment::Environment throws.
std::vector<std::string> find_warnings(const scene::Scene& scene);

}  // namespace weft::production
