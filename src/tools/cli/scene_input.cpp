#include "tools/cli/scene_input.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/version.hpp"
#include "tools/cli/option_values.hpp"
#include "tools/cli/system_info.hpp"

namespace weft::cli {
namespace {

std::vector<std::string> camera_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Camera& camera : scene.cameras) names.push_back(camera.name);
  return names;
}

std::string counted(std::size_t count, const char* singular, const char* plural) {
  return fmt::format("{} {}", count, count == 1 ? singular : plural);
}

}  // namespace

void check_camera(const std::vector<std::string>& names, const std::string& camera) {
  if (std::find(names.begin(), names.end(), camera) != names.end()) return;
  if (names.empty()) throw Error(ExitCode::usage, "--camera: the scene names no cameras, got {}", camera);
  throw Error(ExitCode::usage, "--camera: expected {}, got {}{}", fmt::join(names, " or "), camera,
              did_you_mean(camera, names));
}

scene::Scene load_scene(const SceneOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  // Passes the frame rate as an override, so that scenes with different rates get different hashes.
  if (options.fps) overrides.push_back(fmt::format("time.fps={}", *options.fps));
  // Unlike other looks, `strain` shows values that the simulation must record, so it becomes a change of the scene.
  if (options.look == frame::Stage::Look::strain) overrides.emplace_back("render.look=\"strain\"");
  scene::LoadResult loaded = scene::load(options.scene, overrides);
  if (!loaded.ok()) throw Error(ExitCode::scene_invalid, mistakes_text(loaded));
  if (!options.camera.empty()) check_camera(camera_names(loaded.scene), options.camera);
  // The field of view of a lens depends on the sides of the picture. The hash of the scene does not contain --size.
  if (options.size) {
    loaded.scene.render.width = options.size->width;
    loaded.scene.render.height = options.size->height;
  }
  return std::move(loaded.scene);
}

void add_inputs(PathLedger& paths, const scene::Scene& scene) {
  paths.reads(scene.file, "the scene");
  for (const std::filesystem::path& file : scene.files) paths.reads(file, "a file of the scene");
}

std::string mistakes_text(const scene::LoadResult& loaded) {
  std::string text = loaded.describe();
  text.erase(text.find_last_not_of('\n') + 1);
  return text;
}

render::Settings render_settings(const PictureSize& size, const std::string& camera, const SceneOptions& options) {
  render::Settings settings;
  settings.width = options.size ? options.size->width : size.width;
  settings.height = options.size ? options.size->height : size.height;
  settings.quality = options.quality;
  settings.look = options.look;
  settings.motion_blur = options.motion_blur;
  settings.backend = options.backend;
  settings.camera = options.camera.empty() ? camera : options.camera;
  settings.threads = options.threads;
  return settings;
}

render::Settings render_settings(const scene::Scene& scene, const SceneOptions& options) {
  return render_settings({scene.render.width, scene.render.height}, scene.render.camera, options);
}

cache::Manifest manifest_of(const scene::Scene& scene, const render::Settings& settings) {
  cache::Manifest manifest;
  manifest.scene = scene.name;
  manifest.title = scene.title;
  manifest.scene_hash = scene.hash;
  manifest.simulation_hash = scene.simulation_hash;
  manifest.fps = scene.time.fps;
  manifest.frame_count = scene.frame_count();
  manifest.preroll_frames = scene.preroll_frames();
  manifest.width = settings.width;
  manifest.height = settings.height;
  manifest.camera = settings.camera;
  manifest.cameras = camera_names(scene);
  manifest.weft_version = kVersion;
  manifest.cpu_target = WEFT_CPU;
  manifest.program = program_fingerprint();
  return manifest;
}

std::string describe_scene(const scene::Scene& scene, std::size_t particles) {
  std::string bodies = counted(scene.obstacles.size(), "obstacle", "obstacles");
  if (!scene.characters.empty()) bodies += ", " + counted(scene.characters.size(), "character", "characters");
  std::string cloths = counted(scene.cloths.size() - scene.ropes.size(), "cloth", "cloths");
  if (!scene.ropes.empty()) cloths += ", " + counted(scene.ropes.size(), "rope", "ropes");
  return fmt::format("{}, {}, {}, {} at {:.4g} fps", cloths, bodies, counted(particles, "particle", "particles"),
                     counted(static_cast<std::size_t>(scene.frame_count()), "frame", "frames"), scene.time.fps);
}

}  // namespace weft::cli
