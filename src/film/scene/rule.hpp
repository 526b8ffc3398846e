// The scene format as data: tables of rules, with one rule for each TOML key. Reader, the JSON schema and the effective
// scene use these rules, and contain no key, range or default themselves. Defaults are the initialisers of the structs
// that the rules fill.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace weft::scene {

/// A value that is read from TOML or written to it: absent, flag, text, numbers or texts. Numbers: a single one, or one
/// per component; for Type::points, the numbers of all points one after the other.
using Value = std::variant<std::monostate, bool, std::string, std::vector<double>, std::vector<std::string>>;

/// Type of the value of a key.
enum class Type {
  boolean,
  text,
  texts,   ///< a text, or an array of texts
  name,    ///< name of a list entry; becomes part of key paths and file names
  file,    ///< path of an existing file; relative paths start at the scene's folder
  choice,  ///< one of `choices`
  points,  ///< an array of arrays, each with one number for each of `components`
  number,  ///< one number, or an array with one number per component; or one of `choices`, if any
  color,   ///< [r, g, b] from 0 to 1, or "#rrggbb"; sRGB
  table,
  list,  ///< list of tables, [[key]]
  keys,  ///< list of key frames: tables in time order, usually written as keys = [{...}, ...]
};

/// Bounds of each number of a value. Each number has both bounds, so that no scene can cause an overflow.
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

/// Whether a scene must give a key.
enum class Need {
  optional,
  required,
  here_or_in_first_key,  ///< required in the table itself or in the first of its key frames
};

struct Table;

/// The rule of one key of one table. The functions receive a pointer to the struct that the table describes.
struct Rule {
  std::string key;
  Type type = Type::number;
  std::string documentation;

  std::string unit;                     ///< unit of its numbers; empty: none
  Range range;                          ///< bounds of its numbers; list, keys: `high` bounds the number of entries
  bool whole = false;                   ///< integers only
  std::vector<std::string> components;  ///< names of the numbers of an array; empty: a single number
  bool single_fills_all = false;        ///< one number may replace the whole array
  bool nonzero = false;                 ///< not all components may be 0
  std::vector<std::string> choices;

  Need need = Need::optional;
  std::string default_note;  ///< documents the default if the initialiser of the struct does not show it
  std::string excludes;      ///< key that must not be given together with this one; empty: none
  bool simulated = true;     ///< whether the key affects the simulation and its hash

  std::function<Value(void*)> get;  ///< returns monostate if the effective scene omits the key
  std::function<void(void*, const Value&)> set;

  const Table* table = nullptr;                     ///< table, list, keys: the rules of an entry
  std::function<void*(void*)> inner;                ///< table: the struct of the inner table
  std::function<std::size_t(void*)> count;          ///< list, keys: number of entries to write; table: 0 if the
                                                    ///< effective scene omits it (without function: never)
  std::function<void*(void*, std::size_t)> entry;   ///< list, keys: entry i
  std::function<void*(void*, std::size_t)> append;  ///< list, keys: creates entry i with its defaults
};

/// Rules that apply only if the selector of the table has the value `name`, such as the keys of one shape.
struct Variant {
  std::string name;
  std::vector<Rule> rules;
};

/// The rules of one TOML table, in the order of reading and writing.
struct Table {
  std::string documentation;
  std::vector<Rule> rules;
  std::string selector;  ///< key whose value selects the variant; empty: no variants
  std::vector<Variant> variants;
  std::function<std::shared_ptr<void>()> make;  ///< makes the struct with its defaults

  /// The rule of this key in `rules`; null if there is none.
  const Rule* find(std::string_view key) const;
  /// The variant that the selector in the struct `target` selects; null if the table has no selector.
  const Variant* variant_of(void* target) const;
};

/// The rules of a scene.
const Table& scene_rules();

/// Text of the accepted values, such as "a number > 0 m", "[x, y, z] in m, each from -1 to 1", "linear or cubic".
/// `at_root`: whether the key is in the root table, so that a header needs its name alone.
std::string expectation(const Rule& rule, bool at_root = false);
/// Text of the bound that `value` violates, such as "> 0 m" or "<= 100 m"; the whole range if `value` is +∞ or NaN.
std::string violated_bound(const Rule& rule, double value);
/// Text such as "a, b or c".
std::string join_or(const std::vector<std::string>& words);

}  // namespace weft::scene
