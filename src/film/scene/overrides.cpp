// Applies overrides ("--set path.to.key=value") to the parsed document.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

#include "core/toml.hpp"
#include "film/scene/document.hpp"
#include "film/scene/reader.hpp"

namespace weft::scene {

namespace {

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> parts(1);
  for (const char c : path) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Whether a text that is not a TOML value may be used without quotes.
bool is_plain_word(std::string_view text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c >= 0x80 || std::strchr("_-./# ", c); };
  return !text.empty() && std::all_of(text.begin(), text.end(), plain);
}

/// Parses a value. Returns the table { value = ... }, whose nodes have `source` as source path; nothing if the text is
/// neither a TOML value nor a plain word.
std::optional<toml::table> parse_value(std::string_view text, const std::string& source) {
  const auto parse = [&](const std::string& value) -> std::optional<toml::table> {
    try {
      toml::table table = parse_toml("value = " + value, source);
      // Refuse further keys, which a line break in the text could add.
      if (table.size() != 1) return std::nullopt;
      return table;
    } catch (const toml::parse_error&) {
      return std::nullopt;
    }
  };
  if (auto table = parse(std::string(text))) return table;
  return is_plain_word(text) ? parse(fmt::format("\"{}\"", text)) : std::nullopt;
}

/// Finds the entry of a list with the name `part` or, if no entry has this name, the entry with the index `part`; null
/// if there is neither. If no entry has the name `part`, `names` receives the names of all entries.
toml::node* find_entry(toml::array& list, const std::string& part, std::vector<std::string>& names) {
  for (toml::node& entry : list) {
    const auto* table = entry.as_table();
    const auto name = table != nullptr ? (*table)["name"].value<std::string>() : std::nullopt;
    if (name && *name == part) return &entry;
    if (name) names.push_back(*name);
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const bool is_index = error == std::errc{} && end == part.data() + part.size();
  return is_index ? list.get(index) : nullptr;
}

/// Text that suggests the name most similar to `part` or, if none is similar, all names; empty if there are no names.
std::string suggest_names(const std::string& part, const std::vector<std::string>& names) {
  const std::string nearest = suggestion(part, names);
  return !nearest.empty() || names.empty() ? nearest : fmt::format("; there is {}", fmt::join(names, ", "));
}

}  // namespace

void apply_override(const std::string& override_text, int batch, toml::table& document, Findings& findings) {
  const int number = findings.add_override(override_text);
  // Marks nodes as given by this override; see place_of().
  const std::string source = fmt::format("{} {}", batch, number);
  const auto refuse = [&](const std::string& key, const std::string& text) {
    findings.report(key, {0, 0, number}, text);
  };

  const auto equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) return refuse("", "expected path.to.key=value");
  const std::string path = override_text.substr(0, equals);
  auto parsed = parse_value(std::string_view(override_text).substr(equals + 1), source);
  if (!parsed) return refuse(path, "expected a TOML value after =");

  const std::vector<std::string> parts = split(path);
  if (parts.size() > 16) return refuse(path, "unknown key");
  toml::node* node = &document;
  std::string walked;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    walked += (i > 0 ? "." : "") + parts[i];
    if (parts[i].empty()) return refuse(path, "expected a key between the dots");
    if (toml::table* table = node->as_table()) {
      if (last) {
        (*parsed)["value"].node()->visit([&](auto& value) { table->insert_or_assign(parts[i], std::move(value)); });
        return;
      }
      node = table->get(parts[i]);
      if (node == nullptr) {
        toml::table fresh = *parse_value("{}", source);
        node = &table->insert_or_assign(parts[i], std::move(*fresh["value"].as_table())).first->second;
      }
    } else if (toml::array* list = node->as_array()) {
      std::vector<std::string> names;
      node = find_entry(*list, parts[i], names);
      if (node == nullptr) {
        return refuse(walked, fmt::format("expected the name or index of an entry, got {}{}", parts[i],
                                          suggest_names(parts[i], names)));
      }
      if (last) {
        const auto entry =
            std::find_if(list->cbegin(), list->cend(), [&](const toml::node& each) { return &each == node; });
        (*parsed)["value"].node()->visit([&](auto& value) { list->replace(entry, std::move(value)); });
        return;
      }
    } else {
      return refuse(walked, "expected a key of a table");
    }
  }
}

}  // namespace weft::scene
