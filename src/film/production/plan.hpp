// Lists the parts of a simulation of a scene, and settings that the author of the scene may not intend.
#pragma once

#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::production {

/// One line of `weft check --plan`: a part and whether this scene needs it.
struct PlanItem {
  std::string part;
  bool used = false;
  std::string reason;
};

/// Lists the parts of which a simulation of this scene can consist, without building it. Reads only the files of
/// characters (size of key frames), and of cloths from meshes and fitted patterns (rest shapes). Throws
/// Error(asset_unreadable, scene_invalid) if they cannot be used.
std::vector<PlanItem> plan(const scene::Scene& scene);

/// Whether anything in the scene can collide.
bool can_collide(const scene::Scene& scene);

/// One warning for each visible infinite plane, and for each light, that pictures do not show because there are too
/// many.
std::vector<std::string> find_undrawn(const scene::Scene& scene);

/// Warnings of `weft check`, one text each: settings that may end a run, or that the author hardly intends. If the
/// scene has moving pins, throws as the constructor of SceneSimulation does.
std::vector<std::string> find_warnings(const scene::Scene& scene);

}  // namespace weft::production
