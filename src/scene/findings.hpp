// What reading a scene finds out beside its values: mistakes, and where each key was written.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/loader.hpp"

namespace weft::scene {

/// A place in the scene file, or an override of the command line.
struct Place {
  int line = 0, column = 0;
  std::string override_text;  ///< as in Mistake
};

/// Where a node or key of a parsed document was written. Overrides are parsed under their own name as source path.
Place place_of(const toml::source_region& source);

class Findings {
 public:
  /// Remembers where `key` (a whole path such as cloth.band.size) was written.
  void saw(const std::string& key, Place place) { places_.insert_or_assign(key, std::move(place)); }
  bool has(const std::string& key) const { return places_.contains(key); }
  /// The place of the key, or of the nearest table around it that was seen.
  Place place(std::string key) const;

  void report(const std::string& key, Place place, std::string text);
  /// Reports at the place where the key was seen, unless the key has a mistake already.
  void report(const std::string& key, std::string text);
  bool faulty(const std::string& key) const { return faulty_.contains(key); }

  /// Remembers the key path of entry i of a list ("cloth.band"), for checks that follow reading.
  void add_entry(const std::string& list, std::string path) { entries_[list].push_back(std::move(path)); }
  const std::string& entry(const std::string& list, std::size_t i) const { return entries_.at(list).at(i); }

  /// The first kMaxMistakes in file order, then overrides, and a last one that counts the others. Empties this.
  std::vector<Mistake> take_mistakes();

 private:
  /// Sorts, and drops what exceeds kMaxMistakes.
  void keep_first();

  std::vector<Mistake> mistakes_;
  std::size_t dropped_ = 0;
  std::set<std::string> faulty_;
  std::map<std::string, Place> places_;
  std::map<std::string, std::vector<std::string>> entries_;
};

}  // namespace weft::scene
