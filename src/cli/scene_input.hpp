// From the scene named on the command line to a checked Scene.
#pragma once

#include <string>
#include <vector>

#include "cache/manifest.hpp"
#include "cli/options.hpp"
#include "cli/path_ledger.hpp"
#include "render/renderer.hpp"
#include "scene/loader.hpp"
#include "scene/scene.hpp"

namespace weft::cli {

/// Reads the scene with the changes of the command line. Throws Error(scene_invalid) with all mistakes, one a line, and
/// Error(usage) for a camera that the scene does not have.
scene::Scene load_scene(const SceneOptions& options);

/// The scene's own file and all that it names.
void add_inputs(PathLedger& paths, const scene::Scene& scene);

/// The mistakes of a scene, one a line, without a line feed at the end.
std::string mistakes_text(const scene::LoadResult& loaded);

/// Throws Error(usage) with the nearest name where `camera` is none of `names`.
void check_camera(const std::vector<std::string>& names, const std::string& camera);

/// `size` and `camera` hold where the options say nothing.
render::Settings render_settings(const PictureSize& size, const std::string& camera, const SceneOptions& options);
render::Settings render_settings(const scene::Scene& scene, const SceneOptions& options);

/// What a frame cache of the scene says of itself; the objects are not known yet. Its pictures are drawn with
/// `settings` where `weft render` is told nothing else.
cache::Manifest manifest_of(const scene::Scene& scene, const render::Settings& settings);

/// "1 cloth, 2 obstacles, 2091 particles, 126 frames at 25 fps"; `particles`: of all cloths.
std::string describe_scene(const scene::Scene& scene, std::size_t particles);

}  // namespace weft::cli
