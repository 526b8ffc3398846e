// Collects the mistakes in a scene while it is read, and the place of each key.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "film/scene/loader.hpp"

namespace weft::scene {

/// A place in the scene file, or an override on the command line.
struct Place {
  int line = 0, column = 0;   ///< counted from 1; 0: none
  std::string override_text;  ///< see Mistake
};

/// Place of a node or key of a parsed document. `source`: of the node or key; its path is the text
/// of the override that gave the node, and empty if the file did.
Place place_of(const toml::source_region& source);

class Findings {
 public:
  /// Stores the place of `key`, a whole path such as cloth.band.size.
  void set_place(const std::string& key, Place place) { places_.insert_or_assign(key, std::move(place)); }
  /// Whether the scene gives the key.
  bool has(const std::string& key) const { return places_.contains(key); }
  /// The place of the key or, if no place is stored for it, of the innermost table around it that
  /// has one; else 1:1.
  Place place(std::string key) const;

  /// Adds a mistake. `text`: what was expected, and what was found.
  void report(const std::string& key, Place place, std::string text);
  /// Adds a mistake at place(key), unless the key already has a mistake.
  void report(const std::string& key, std::string text);
  bool has_mistake(const std::string& key) const { return has_mistake_.contains(key); }

  /// Stores the key path ("cloth.band") of the next entry of a list ("cloth"). Checks use it after reading.
  void add_entry(const std::string& list, std::string path) { entries_[list].push_back(std::move(path)); }
  const std::string& entry(const std::string& list, std::size_t i) const { return entries_.at(list).at(i); }

  /// Returns and clears the mistakes, at most kMaxMistakes: first those of the file in its order,
  /// then those of overrides. If there are more, a last entry gives the number of further mistakes.
  std::vector<Mistake> take_mistakes();

 private:
  /// Sorts the mistakes, and removes those beyond kMaxMistakes.
  void keep_first();

  std::vector<Mistake> mistakes_;
  std::size_t dropped_ = 0;  // number of removed mistakes
  std::set<std::string> has_mistake_;
  std::map<std::string, Place> places_;
  std::map<std::string, std::vector<std::string>> entries_;
};

}  // namespace weft::scene
