#include <fmt/format.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "core/log.hpp"
#include "film/cache/names.hpp"
#include "film/environment/environment.hpp"
#include "film/garment/pattern.hpp"
#include "film/production/plan.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/scene/document.hpp"
#include "film/scene/loader.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/enclosed.hpp"
#include "tools/cli/estimate.hpp"
#include "tools/cli/scene_changes.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/standard_output.hpp"
#include "tools/cli/table.hpp"

namespace weft::cli {
namespace {

std::string plan_table(const scene::Scene& scene) {
  std::vector<std::vector<std::string>> rows;
  for (const bool used : {true, false}) {
    for (const production::PlanItem& item : production::plan(scene)) {
      if (item.used == used) rows.push_back({used ? "uses" : "leaves out", item.part, item.reason});
    }
  }
  return format_table(rows, "lll", 2);
}

/// All mistakes of one scene: exit code and messages.
struct Mistakes {
  ExitCode code = ExitCode::ok;
  std::string lines;

  void add(ExitCode of, const std::string& text) {
    if (code != ExitCode::scene_invalid) code = of;
    lines += (lines.empty() ? "" : "\n") + text;
  }
};

/// Checks the patterns that a scene names, even if the scene itself has mistakes.
void check_patterns(const scene::Scene& scene, Mistakes& mistakes) {
  std::set<std::filesystem::path> files;
  for (const scene::Cloth& cloth : scene.cloths)
    if (cloth.shape == scene::ClothShape::pattern && !cloth.file.empty()) files.insert(cloth.file);
  for (const std::filesystem::path& file : files) {
    const garment::ReadPattern read = garment::read_pattern(file);
    if (!read.mistakes.empty())
      mistakes.add(read.only_in_drawings ? ExitCode::asset_unreadable : ExitCode::scene_invalid,
                   fmt::format("{}", fmt::join(read.mistakes, "\n")));
  }
}

/// Number of particles of all cloths and ropes. Builds all of them but rectangles, to count their particles. Adds
/// errors to `mistakes`.
std::size_t count_scene_particles(const scene::Scene& scene, Mistakes& mistakes) {
  std::size_t particles = 0;
  environment::Wearers wearers(scene);
  for (const scene::Cloth& cloth : scene.cloths) try {
      environment::check_spacing(scene, cloth);
      const auto known = static_cast<std::size_t>(rectangle_particles(cloth));
      particles += known > 0 ? known : environment::make_cloth(scene, cloth, wearers).cloth.mesh.positions.size();
    } catch (const Error& error) {
      mistakes.add(error.code(), error.what());
    }
  return particles;
}

/// Text of the effective scene that `against` names: a cache folder, a file of an effective scene, or a scene. Throws
/// Error(scene_invalid) or Error(asset_unreadable).
std::string scene_text_of(const std::filesystem::path& against) {
  const bool is_cache = std::filesystem::is_directory(against);
  if (is_cache || against.string().ends_with(".effective.toml"))
    return read_file(is_cache ? against / cache::kSceneFile : against, scene::kMaxFileSize);
  const scene::LoadResult loaded = scene::load(against);
  if (!loaded.ok()) throw Error(ExitCode::scene_invalid, mistakes_text(loaded));
  return scene::effective_scene(loaded.scene);
}

void print_changes(const std::filesystem::path& file, const scene::Scene& scene, const std::filesystem::path& against) {
  const std::vector<std::string> lines =
      scene_changes(scene_text_of(against), against, scene::effective_scene(scene), file);
  if (lines.empty()) print("{}: the same as {}\n", file.string(), against.string());
  for (const std::string& line : lines) print("{}: changed: {}\n", file.string(), line);
}

ExitCode check_scene(const std::filesystem::path& file, const CheckOptions& options) {
  const scene::LoadResult loaded = scene::load(file, options.overrides);
  Mistakes mistakes;
  if (!loaded.ok()) mistakes.add(ExitCode::scene_invalid, mistakes_text(loaded));
  check_patterns(loaded.scene, mistakes);
  const std::size_t particles = mistakes.lines.empty() ? count_scene_particles(loaded.scene, mistakes) : 0;
  if (!mistakes.lines.empty()) {
    log::info(mistakes.lines);
    return mistakes.code;
  }
  // Prepares the simulation as a run does, to find more mistakes; with --estimate, also simulates some frames.
  std::optional<Estimate> estimate;
  if (options.estimate) estimate = estimate_run(loaded.scene, render_settings(loaded.scene, {}));
  const frame::SnapshotPtr start = estimate ? estimate->start : production::SceneSimulation(loaded.scene).snapshot();
  print("{}: ok: {}\n", file.string(), describe_scene(loaded.scene, particles));
  for (const std::string& warning : production::find_warnings(loaded.scene))
    print("{}: note: {}\n", file.string(), warning);
  for (const std::string& note : find_enclosed(loaded.scene, *start)) print("{}: note: {}\n", file.string(), note);
  if (!options.against.empty()) print_changes(file, loaded.scene, options.against);
  if (options.plan) print("{}", plan_table(loaded.scene));
  if (estimate) print("{}: {}\n", file.string(), describe(*estimate));
  return ExitCode::ok;
}

}  // namespace

ExitCode check(const CheckOptions& options) {
  ExitCode code = ExitCode::ok;
  for (const std::filesystem::path& file : options.scenes) {
    ExitCode of_scene = ExitCode::ok;
    try {
      of_scene = check_scene(file, options);
    } catch (const Error& error) {
      log::info(error.what());
      of_scene = error.code();
    }
    if (code == ExitCode::ok || of_scene == ExitCode::scene_invalid) code = of_scene;
  }
  return code;
}

}  // namespace weft::cli
