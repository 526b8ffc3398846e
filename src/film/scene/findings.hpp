// Collects the mistakes in a scene and the place of each key while the scene is read.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "film/scene/loader.hpp"

namespace weft::scene {

/// A place in the scene file, or an override of the command line.
struct Place {
  int line = 0, column = 0;  ///< counted from 1; 0: none
  int override_number = 0;   ///< 0: the file; else number of the override, see Findings::add_override()
  int batch = 0;             ///< 0: the file; else number of the list of overrides, see load_batches()
};

/// Place of a node or key of a parsed document. `source`: its source region. If an override gave the node, the path in
/// `source` is the batch and the number of this override, with a space between them; if the file gave it, this path is
/// empty.
Place place_of(const toml::source_region& source);

/// The mistakes and the places of keys. A key path is the whole path of a key, such as cloth.band.size.
class Findings {
 public:
  /// Stores an override "path.to.key=value", and returns its number, counted from 1. Places have the number instead of
  /// the text, which may be long.
  int add_override(const std::string& text);
  /// Stores the place of a key path.
  void set_place(const std::string& key, Place place) { places_.insert_or_assign(key, place); }
  /// Whether the scene gives the key.
  bool has(const std::string& key) const { return places_.contains(key); }
  /// The place of the key or, if none is stored, that of the innermost table around it that has one. If no table around
  /// it has one: line 1, column 1.
  Place place(std::string key) const;
  /// As place(), but ignores places in overrides.
  Place place_in_file(std::string key) const;

  /// Adds a mistake. `text`: what was expected, and what was found.
  void report(const std::string& key, Place place, std::string text);
  /// Adds a mistake at place(key), unless the key already has a mistake.
  void report(const std::string& key, std::string text);
  bool has_mistake(const std::string& key) const { return has_mistake_.contains(key); }

  /// Stores the key path ("cloth.band") of the next entry of a list ("cloth"), for the checks that follow reading.
  void add_entry(const std::string& list, std::string path) { entries_[list].push_back(std::move(path)); }
  const std::string& entry(const std::string& list, std::size_t i) const { return entries_.at(list).at(i); }

  /// Returns and clears the mistakes: first those of the file in its order, then those of overrides. The list has at
  /// most kMaxMistakes mistakes; if there are more, one more entry gives the number of further mistakes.
  std::vector<Mistake> take_mistakes();

 private:
  /// Sorts the mistakes, and removes all after the first kMaxMistakes.
  void keep_first();

  std::vector<Mistake> mistakes_;
  std::size_t dropped_ = 0;  // number of removed mistakes
  std::set<std::string> has_mistake_;
  std::map<std::string, Place> places_;
  std::vector<std::string> overrides_;
  std::map<std::string, std::vector<std::string>> entries_;
};

}  // namespace weft::scene
