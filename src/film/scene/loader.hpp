// Loads a checked Scene from a TOML file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "film/scene/rule.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Maximum number of listed mistakes; a file that is not a scene may have millions.
inline constexpr std::size_t kMaxMistakes = 200;

/// One mistake in a scene.
struct Mistake {
  int line = 0, column = 0;   ///< 1-based; 1:1 for what the scene lacks; 0 for mistakes outside the text of the file
  std::string key;            ///< such as cloth.band.material.thickness; empty for mistakes of the whole file
  std::string text;           ///< "expected > 0 m, got -0.001"
  std::string override_text;  ///< "--set key=value" if an override caused it; empty for the file
};

struct LoadResult {
  Scene scene;  ///< complete only if there are no mistakes; else values with mistakes have their defaults
  std::vector<Mistake>
      mistakes;  ///< in file order, then those of overrides; at most kMaxMistakes and a count of the rest
  bool ok() const { return mistakes.empty(); }
  /// One line per mistake: `file:line:column: key: text` (overrides: `--set key=value: key: text`).
  std::string describe() const;
  std::filesystem::path file;
  std::string text;  ///< content of the file
};

/// Reads and checks a scene. `overrides`: texts "path.to.key=value", checked like the file itself. Does not throw,
/// whatever the file contains.
LoadResult load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Same as `load`, but from text in memory (tests, fuzzing). `name`: path that the text stands for, which need not
/// exist; it names the scene, and relative paths start at its folder.
LoadResult load_text(std::string_view text, const std::filesystem::path& name,
                     const std::vector<std::string>& overrides = {});

/// The JSON schema (Draft 2020-12) of a format, generated from its rule table.
std::string json_schema(const Table& table = scene_rules(), const std::string& title = "Weft scene");

/// The checked scene with its defaults filled in, as TOML; without keys whose default means "none".
std::string effective_scene(const Scene& scene);

}  // namespace weft::scene
