// Loads a checked Scene from a TOML file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "film/scene/rule.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Maximum number of listed mistakes. A file that is no scene may have millions of them.
inline constexpr std::size_t kMaxMistakes = 200;

struct Mistake {
  /// Counted from 1. If the key is not in the file: of the innermost table around it that is, else
  /// 1:1. 0:0 if the mistake has no place in the file.
  int line = 0, column = 0;
  std::string key;            ///< such as cloth.band.material.thickness; empty: the scene as a whole
  std::string text;           ///< such as "expected > 0 m, got -0.001"
  std::string override_text;  ///< "--set key=value" if an override caused it; else empty
};

struct LoadResult {
  Scene scene;                    ///< values with mistakes have their defaults
  std::vector<Mistake> mistakes;  ///< result of Findings::take_mistakes(); empty: none
  bool ok() const { return mistakes.empty(); }
  /// One line per mistake: `file:line:column: key: text`; for overrides, `--set key=value: key:
  /// text`. Parts that a mistake lacks are left out.
  std::string describe() const;
  std::filesystem::path file;  ///< as given to load() or load_text()
  std::string text;            ///< content of the file, without overrides
};

/// Reads and checks a scene. `overrides`: texts "path.to.key=value", checked like the file. Does not throw, whatever
/// the file and the overrides contain.
LoadResult load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// As load(), for text in memory. `name`: a path that need not exist; its file name gives the name
/// of the scene, and relative paths start at its folder.
LoadResult load_text(std::string_view text, const std::filesystem::path& name,
                     const std::vector<std::string>& overrides = {});

/// The JSON schema (Draft 2020-12) of a format, generated from its rule table.
std::string json_schema(const Table& table = scene_rules(), const std::string& title = "Weft scene");

/// The checked scene as TOML, with its defaults filled in, but without keys whose default means "none".
std::string effective_scene(const Scene& scene);

}  // namespace weft::scene
