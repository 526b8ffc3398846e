// Reads and checks the scene that the command line names.
#pragma once

#include <string>
#include <vector>

#include "film/cache/manifest.hpp"
#include "film/render/renderer.hpp"
#include "film/scene/loader.hpp"
#include "film/scene/scene.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/path_ledger.hpp"

namespace weft::cli {

/// Reads the scene and applies the changes that the command line asks for. Throws Error(scene_invalid) with all
/// mistakes, one per line, and Error(usage) if the scene lacks the camera that `options` names.
scene::Scene load_scene(const SceneOptions& options);

/// Registers the scene file and all files that it names.
void add_inputs(PathLedger& paths, const scene::Scene& scene);

/// The mistakes of a scene, one per line, without a line feed at the end.
std::string mistakes_text(const scene::LoadResult& loaded);

/// Throws Error(usage) with the most similar name if `camera` is not in `names`.
void check_camera(const std::vector<std::string>& names, const std::string& camera);

/// The settings for drawing. `size` and `camera` are the defaults where `options` sets none.
render::Settings render_settings(const PictureSize& size, const std::string& camera, const SceneOptions& options);
render::Settings render_settings(const scene::Scene& scene, const SceneOptions& options);

/// The manifest of a frame cache of the scene, without its objects. `settings`: size and camera with which `weft
/// render` draws the cache by default.
cache::Manifest manifest_of(const scene::Scene& scene, const render::Settings& settings);

/// "1 cloth, 2 obstacles, 2091 particles, 126 frames at 25 fps"; `particles`: of all cloths and ropes.
std::string describe_scene(const scene::Scene& scene, std::size_t particles);

}  // namespace weft::cli
