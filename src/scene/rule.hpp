// What the scene format knows of a key, as data. Reading, checking, the JSON schema and the effective scene all follow
// these rules and know no key, range or default of their own; the defaults are the initialisers of the structs.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace weft::scene {

/// A value between TOML and a struct: absent, a flag, a text, numbers (one, or as many as the rule has components), or
/// texts.
using Value = std::variant<std::monostate, bool, std::string, std::vector<double>, std::vector<std::string>>;

enum class Type {
  boolean,
  text,
  texts,   ///< a text, or an array of texts
  name,    ///< of a list entry: becomes part of key paths and file names
  file,    ///< path of an existing file, relative to the scene's folder
  choice,  ///< one of `choices`
  points,  ///< an array of arrays, each with one number for each of `components`
  number,  ///< one number, or an array with one number for each of `components`; or one of `choices`, if there are any
  color,   ///< [r, g, b] from 0 to 1, or "#rrggbb"; sRGB
  table,
  list,  ///< of tables, [[key]]
  keys,  ///< of tables in time order, usually written as keys = [{...}, ...]
};

/// Bounds of each number of a value. Every number has both, so that no scene can overflow what is computed from it.
struct Range {
  double low = 0, high = 0;
  bool low_open = false;  ///< the lower bound itself is not allowed
};
inline Range within(double low, double high) {
  return {low, high, false};
}
inline Range above(double low, double high) {
  return {low, high, true};
}

enum class Need {
  optional,
  required,
  here_or_in_first_key,  ///< of a thing that stands still or has `keys`
};

struct Table;

/// One key of one table. The functions take the struct that the table describes.
struct Rule {
  std::string key;
  Type type = Type::number;
  std::string documentation;

  std::string unit;                     ///< of its numbers; empty: none
  Range range;                          ///< of its numbers; list, keys: of the number of entries
  bool whole = false;                   ///< numbers without fraction
  std::vector<std::string> components;  ///< names of the numbers of an array; empty: a single number
  bool single_fills_all = false;        ///< one number may stand for the whole array
  bool nonzero = false;                 ///< not all components may be 0
  std::vector<std::string> choices;

  Need need = Need::optional;
  std::string default_note;  ///< says what the default is where the struct's initialiser does not
  std::string excludes;      ///< key that must not be given beside this one
  bool simulated = true;     ///< counts for the simulation; else its change leaves what is simulated as it is

  std::function<Value(void*)> get;  ///< monostate: nothing to write
  std::function<void(void*, const Value&)> set;

  const Table* table = nullptr;                     ///< of a table, list or keys: the rules of an entry
  std::function<void*(void*)> inner;                ///< table: its struct
  std::function<std::size_t(void*)> count;          ///< list, keys: number of entries to write; table: 0 to write none
  std::function<void*(void*, std::size_t)> entry;   ///< list, keys: an entry
  std::function<void*(void*, std::size_t)> append;  ///< list, keys: makes entry i, filled with its defaults
};

/// Rules that hold only for one value of the table's selector, such as the keys of one shape.
struct Variant {
  std::string name;
  std::vector<Rule> rules;
};

/// All keys of one TOML table, in the order of reading and writing.
struct Table {
  std::string documentation;
  std::vector<Rule> rules;
  std::string selector;  ///< key whose text picks the variant; empty: no variants
  std::vector<Variant> variants;
  std::function<std::shared_ptr<void>()> make;  ///< the struct with its defaults

  const Rule* find(std::string_view key) const;
  const Variant* find_variant(std::string_view name) const;
  /// The variant that the struct has now; null where the table has none.
  const Variant* variant_of(void* target) const;
};

/// The whole format.
const Table& scene_rules();

/// "a number > 0 m", "[x, y, z] in m, each from -1 to 1", "linear or cubic": what a rule accepts, for messages.
std::string expectation(const Rule& rule);
/// The part of the range that `value` violates: "> 0 m", "<= 100 m"; the whole of it for what is not finite.
std::string violated_bound(const Rule& rule, double value);
/// "a, b or c"
std::string join_or(const std::vector<std::string>& words);

}  // namespace weft::scene
