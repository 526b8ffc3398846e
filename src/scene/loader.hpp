// From a TOML file to a checked Scene.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace weft::scene {

/// Everything that is wrong with a scene, in file order.
struct Mistake {
  int line = 0, column = 0;  ///< 1-based; 0 for a mistake of the command line
  std::string key;           ///< such as cloth.band.thickness; empty for mistakes of the file as a whole
  std::string text;          ///< "expected > 0 m, got -0.001"
};

struct LoadResult {
  Scene scene;                    ///< meaningful only if there are no mistakes
  std::vector<Mistake> mistakes;
  bool ok() const { return mistakes.empty(); }
  /// One line a mistake: `file:line:column: key: text` (overrides: `--set key: text`).
  std::string describe() const;
  std::filesystem::path file;
};

/// Reads and checks a scene; `overrides` are "path.to.key=value" texts, checked like the file itself. Never throws for
/// what a file can hold.
LoadResult load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// As `load`, from text already in memory (tests, fuzzing); relative paths are taken from the folder of `name`.
LoadResult load_text(std::string_view text, const std::filesystem::path& name,
                     const std::vector<std::string>& overrides = {});

/// The JSON schema (Draft 4) of the scene format, made from the rule table.
std::string json_schema();

/// The checked scene with every default filled in, as TOML.
std::string effective_scene(const Scene& scene);

}  // namespace weft::scene
