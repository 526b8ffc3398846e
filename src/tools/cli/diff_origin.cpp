#include "tools/cli/diff_origin.hpp"

#include <fmt/format.h>

#include <vector>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "film/scene/document.hpp"
#include "tools/cli/own_files.hpp"
#include "tools/cli/scene_changes.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

/// The effective scene that the run has written beside its output; empty if there is none.
fs::path effective_scene_file(const fs::path& picture, const std::string& scene) {
  for (const std::string& name : {picture.stem().string(), scene}) {
    fs::path file = picture.parent_path() / (name + ".effective.toml");
    if (!name.empty() && fs::is_regular_file(file)) return file;
  }
  return {};
}

std::string join_some(const std::vector<std::string>& lines) {
  constexpr std::size_t kMaxListedChanges = 4;  // since one line holds the figures and all changes
  if (lines.size() <= kMaxListedChanges) return fmt::format("{}", fmt::join(lines, "; "));
  return fmt::format("{}; and {} more", fmt::join(lines.begin(), lines.begin() + kMaxListedChanges, "; "),
                     lines.size() - kMaxListedChanges);
}

}  // namespace

std::string describe_origin_changes(const fs::path& reference, const fs::path& test) {
  KeyedValues before = metadata_of(reference), after = metadata_of(test);
  if (!before.contains("scene_hash") || !after.contains("scene_hash")) return "";
  if (before["scene_hash"] != after["scene_hash"]) {
    const fs::path old_scene = effective_scene_file(reference, before["scene"]);
    const fs::path new_scene = effective_scene_file(test, after["scene"]);
    if (old_scene.empty() || new_scene.empty()) return "the scene has changed";
    try {
      const std::vector<std::string> lines = scene_changes(read_file(old_scene, scene::kMaxFileSize), old_scene,
                                                           read_file(new_scene, scene::kMaxFileSize), new_scene);
      return lines.empty() ? "a file of the scene has changed" : "the scene has changed: " + join_some(lines);
    } catch (const Error& error) {
      return fmt::format("the scene has changed; {}", error.what());
    }
  }
  // The scene is the same, so compares program and drawing settings.
  KeyedValues old_program, new_program;
  for (const char* key :
       {"weft_version", "gl", "quality", "look", "camera", "camera_frames", "motion_blur", "state", "frame", "frames"})
    if (before[key] != after[key]) old_program[key] = before[key], new_program[key] = after[key];
  if (old_program.empty()) return "the scene is the same";
  return "the scene is the same; " + join_some(list_changes(old_program, new_program));
}

}  // namespace weft::cli
