// Loads a checked Scene from a TOML file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "film/scene/rule.hpp"
#include "film/scene/scene.hpp"

namespace weft::scene {

/// Maximum number of listed mistakes. A file that is not a scene may have millions of mistakes.
inline constexpr std::size_t kMaxMistakes = 200;

/// A mistake in a scene, with its place.
struct Mistake {
  /// Place of the key, counted from 1. If the file does not contain the key: place of the innermost table around it
  /// that the file contains, else 1:1. If the mistake has no place in the file: 0:0.
  int line = 0, column = 0;
  std::string key;            ///< such as cloth.band.material.thickness; empty: the scene as a whole
  std::string text;           ///< such as "expected > 0 m, got -0.001"
  std::string override_text;  ///< "--set key=value", as it was given, if an override caused it; else empty
};

/// A loaded scene, or the mistakes in it.
struct LoadResult {
  Scene scene;                    ///< a key with a mistake has its default value
  std::vector<Mistake> mistakes;  ///< result of Findings::take_mistakes(); empty: none
  bool ok() const { return mistakes.empty(); }
  /// One line per mistake: `file:line:column: key: text` or, for overrides, `--set key=value: key: text`. Omits parts
  /// that a mistake does not have, and the end of a long override.
  std::string describe() const;
  std::filesystem::path file;  ///< as given to load() or load_text()
  std::string text;            ///< content of the file, without overrides
};

/// Reads and checks a scene. `overrides`: texts "path.to.key=value", which are checked like the file. Mistakes in file
/// or overrides cause no exception.
LoadResult load(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Same as load(), for text in memory. `name`: a path, which need not exist; its file name gives the name of the scene,
/// and relative paths in the scene start at its folder.
LoadResult load_text(std::string_view text, const std::filesystem::path& name,
                     const std::vector<std::string>& overrides = {});

/// Same as load_text(), with lists of overrides that are applied one after the other. Of two keys that exclude each
/// other, that of a later list replaces that of an earlier one; one list must not give both.
LoadResult load_batches(std::string_view text, const std::filesystem::path& name,
                        const std::vector<std::vector<std::string>>& batches);

/// The JSON schema (Draft 2020-12) of a format, generated from its rule table. Ends with a line feed.
std::string json_schema(const Table& table = scene_rules(), const std::string& title = "Weft scene");

/// The checked scene as TOML, with all defaults, but without keys whose default means "none".
std::string effective_scene(const Scene& scene);

}  // namespace weft::scene
