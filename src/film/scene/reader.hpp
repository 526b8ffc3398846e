// Reads TOML into structs according to the rule table.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <set>
#include <string>

#include "film/scene/findings.hpp"
#include "film/scene/rule.hpp"

namespace weft::scene {

/// Describes a node for messages, such as `-0.001`, `the text "heavy"` or `an array of 4 values`.
std::string describe_node(const toml::node& node);
/// The beginning of a UTF-8 text: at most `max_bytes` bytes, without a part of a character at the end.
std::string_view beginning_of(std::string_view text, std::size_t max_bytes);
/// Whether a text is UTF-8. The effective scene contains absolute paths, so these must be.
bool is_utf8(const std::string& text);
/// The text in quotes, for messages: at most its first 40 bytes, with escaped ASCII control characters.
std::string in_quotes(std::string_view text);
/// Whether the text is valid as the name of a list entry.
bool is_name(std::string_view text);
/// Text such as "; did you mean mass?" with the nearest of `known` (nearest_name()); empty if none
/// is similar or `name` is longer than 64 bytes.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// Reads one document. Findings receives the mistakes and the places of keys.
class Reader {
 public:
  /// `folder`: base of relative file names.
  Reader(Findings& findings, std::filesystem::path folder) : findings_(findings), folder_(std::move(folder)) {}

  /// Fills `target`, a struct that `rules` describes, from `table`. `path`: key path of the table; empty for the root.
  /// Reports mistakes; a key with a mistake keeps its default.
  void read(const toml::table& table, const Table& rules, void* target, const std::string& path);

 private:
  void read_rule(const toml::table& table, const Rule& rule, void* target, const std::string& path);
  void read_entries(const toml::node& node, const Rule& rule, void* target, const std::string& path);
  /// The key path of a list entry. If the entry has a valid name that is not yet in `names`, the path ends with this
  /// name, and `names` receives the name. Otherwise, the path is `by_index`, which ends with the index. Reports a name
  /// that occurs twice.
  std::string entry_path(const toml::table& table, const Rule& rule, const std::string& path,
                         const std::string& by_index, std::set<std::string>& names);
  void report_unknown(const toml::table& table, const Table& rules, const Variant* variant, const std::string& path);

  Value read_value(const toml::node& node, const Rule& rule, const std::string& path);
  Value read_text(const toml::node& node, const Rule& rule, const std::string& path);
  Value read_texts(const toml::node& node, const Rule& rule, const std::string& path);
  Value read_numbers(const toml::node& node, const Rule& rule, const std::string& path);
  Value read_points(const toml::node& node, const Rule& rule, const std::string& path);
  Value read_color(const toml::node& node, const Rule& rule, const std::string& path);
  bool read_number(const toml::node& node, const Rule& rule, const std::string& path, double& number);
  Value check_file(const toml::node& node, const std::string& text, const std::string& path);

  Value refuse(const toml::node& node, const std::string& path, const std::string& text);
  /// Reports a value whose type is not that of the rule.
  Value refuse_type(const toml::node& node, const Rule& rule, const std::string& path);

  Findings& findings_;
  std::filesystem::path folder_;
};

}  // namespace weft::scene
