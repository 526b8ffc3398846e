// From a TOML file to a checked Scene.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/rule.hpp"
#include "scene/scene.hpp"

namespace weft::scene {

/// Mistakes listed at once; a file that is no scene may hold millions.
inline constexpr std::size_t kMaxMistakes = 200;

/// One thing that is wrong with a scene.
struct Mistake {
  int line = 0, column = 0;   ///< 1-based; 0 for a mistake of the command line or of the file as a whole
  std::string key;            ///< such as cloth.band.material.thickness; empty for mistakes of the file as a whole
  std::string text;           ///< "expected > 0 m, got -0.001"
  std::string override_text;  ///< "--set key=value" where the command line brought it; empty for the file
};

struct LoadResult {
  Scene scene;  ///< meaningful only if there are no mistakes
  std::vector<Mistake>
      mistakes;  ///< in file order, then those of the overrides; at most kMaxMistakes and a count of the rest
  bool ok() const { return mistakes.empty(); }
  /// One line a mistake: `file:line:column: key: text` (overrides: `--set key=value: key: text`).
  std::string describe() const;
  std::filesystem::path file;
  std::string text;  ///< of the file
};

/// Reads and checks a scene; `overrides` are "path.to.key=value" texts, checked like the file itself. Never throws for
/// what a file can hold.
LoadResult load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// As `load`, from text already in memory (tests, fuzzing); relative paths are taken from the folder of `name`.
LoadResult load_text(std::string_view text, const std::filesystem::path& name,
                     const std::vector<std::string>& overrides = {});

/// The JSON schema (Draft 2020-12) of a format, made from its rule table.
std::string json_schema(const Table& table = scene_rules(), const std::string& title = "Weft scene");

/// The checked scene with every default filled in, as TOML.
std::string effective_scene(const Scene& scene);

}  // namespace weft::scene
