#include "cli/scene_input.hpp"

#include "core/error.hpp"
#include "core/nearest.hpp"

namespace weft::cli {
namespace {

void check_camera(const scene::Scene& scene, const std::string& camera) {
  std::vector<std::string> names;
  for (const scene::Camera& known : scene.cameras) {
    if (known.name == camera) return;
    names.push_back(known.name);
  }
  if (names.empty()) throw Error(ExitCode::usage, "--camera: the scene names no cameras, got {}", camera);
  const std::string nearest = nearest_name(camera, names);
  throw Error(ExitCode::usage, "--camera: expected {}, got {}{}", fmt::join(names, " or "), camera,
              nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
}

std::string counted(std::size_t count, const char* singular, const char* plural) {
  return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

}  // namespace

scene::Scene load_scene(const SceneOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  // As an override, so that the scene's hash tells runs at other frame times apart.
  if (options.fps) overrides.push_back(fmt::format("time.fps={}", *options.fps));
  scene::LoadResult loaded = scene::load(options.scene, overrides);
  if (!loaded.ok()) throw Error(ExitCode::scene_invalid, mistakes_text(loaded));
  if (!options.camera.empty()) check_camera(loaded.scene, options.camera);
  return std::move(loaded.scene);
}

std::string mistakes_text(const scene::LoadResult& loaded) {
  std::string text = loaded.describe();
  text.erase(text.find_last_not_of('\n') + 1);
  return text;
}

render::Settings render_settings(const scene::Scene& scene, const SceneOptions& options) {
  render::Settings settings;
  settings.width = options.size ? options.size->width : scene.render.width;
  settings.height = options.size ? options.size->height : scene.render.height;
  settings.quality = options.quality;
  settings.backend = options.backend;
  settings.camera = options.camera.empty() ? scene.render.camera : options.camera;
  settings.threads = options.threads;
  return settings;
}

std::string describe_scene(const scene::Scene& scene, std::size_t particles) {
  std::string bodies = counted(scene.obstacles.size(), "obstacle", "obstacles");
  if (!scene.characters.empty()) bodies += ", " + counted(scene.characters.size(), "character", "characters");
  return fmt::format("{}, {}, {}, {} at {:.4g} fps", counted(scene.cloths.size(), "cloth", "cloths"), bodies,
                     counted(particles, "particle", "particles"),
                     counted(static_cast<std::size_t>(scene.frame_count()), "frame", "frames"), scene.time.fps);
}

}  // namespace weft::cli
