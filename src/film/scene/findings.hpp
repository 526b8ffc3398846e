// Mistakes found while a scene is read, and the place of each key.
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
  int line = 0, column = 0;
  std::string override_text;  ///< see Mistake
};

/// Place of a node or key of a parsed document. Overrides are parsed with their own text as source path.
Place place_of(const toml::source_region& source);

class Findings {
 public:
  /// Stores where `key` (a whole path such as cloth.band.size) was written.
  void set_place(const std::string& key, Place place) { places_.insert_or_assign(key, std::move(place)); }
  bool has(const std::string& key) const { return places_.contains(key); }
  /// The place of the key, or of the nearest stored table around it; 1:1 if none is stored.
  Place place(std::string key) const;

  void report(const std::string& key, Place place, std::string text);
  /// Reports at the stored place of the key, unless the key already has a mistake.
  void report(const std::string& key, std::string text);
  bool has_mistake(const std::string& key) const { return has_mistake_.contains(key); }

  /// Stores the key path of the next entry of a list ("cloth.band"), for checks after reading.
  void add_entry(const std::string& list, std::string path) { entries_[list].push_back(std::move(path)); }
  const std::string& entry(const std::string& list, std::size_t i) const { return entries_.at(list).at(i); }

  /// Returns at most kMaxMistakes mistakes: first those of the file in its order, then those of overrides. If there are
  /// more, a final entry gives the number of the others. Clears the mistakes.
  std::vector<Mistake> take_mistakes();

 private:
  /// Sorts the mistakes, and drops those beyond kMaxMistakes.
  void keep_first();

  std::vector<Mistake> mistakes_;
  std::size_t dropped_ = 0;
  std::set<std::string> has_mistake_;
  std::map<std::string, Place> places_;
  std::map<std::string, std::vector<std::string>> entries_;
};

}  // namespace weft::scene
