#include "film/scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/json.hpp"
#include "core/nearest.hpp"

namespace weft::scene {

namespace {

constexpr std::size_t kMaxShownCharacters = 40;

std::string join_path(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

/// Place of a key. If an override gives the key, toml++ stores no place for it; the result is then the place of its
/// value.
Place place_of_key(const toml::key& key, const toml::node& node) {
  return key.source().begin.line > 0 ? place_of(key.source()) : place_of(node.source());
}

/// Batch of a value; see Place.
int batch_of(const toml::node& node) {
  return place_of(node.source()).batch;
}

/// Whether another key replaces the key of `rule`: the two keys exclude each other, and the other one is in a later
/// batch. For example, the file gives the key of `rule`, and --set gives the other one.
bool is_replaced(const toml::table& table, const Rule& rule, const std::vector<Rule>& rules) {
  const toml::node* node = table.get(rule.key);
  return node != nullptr && std::ranges::any_of(rules, [&](const Rule& other) {
           if (other.excludes != rule.key && rule.excludes != other.key) return false;
           const toml::node* given = table.get(other.key);
           return given != nullptr && batch_of(*given) > batch_of(*node);
         });
}

}  // namespace

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto allowed = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  return !text.empty() && text.size() <= 64 && letter(text[0]) && std::all_of(text.begin(), text.end(), allowed);
}

std::string_view beginning_of(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  // Move the end back over continuation bytes.
  std::size_t end = max_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

bool is_utf8(const std::string& text) {
  const std::string valid = parse_json(json_text(text));  // replaces bytes that are not UTF-8
  return valid == text;
}

std::string in_quotes(std::string_view text) {
  std::string shown = "\"";
  const bool cut = text.size() > kMaxShownCharacters;
  for (const char c : beginning_of(text, kMaxShownCharacters)) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte < 0x20 || byte == 0x7F ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return shown + (cut ? "...\"" : "\"");
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  // A longer name is probably not a misspelt key, and the search would be slow.
  if (name.size() > 64) return {};
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

std::string describe_node(const toml::node& node) {
  if (const auto* text = node.as_string()) return "the text " + in_quotes(text->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return fmt::format("{}", flag->get());
  if (const auto* array = node.as_array()) {
    return fmt::format("an array of {} value{}", array->size(), array->size() == 1 ? "" : "s");
  }
  return node.is_table() ? "a table" : "a date or time";
}

Value Reader::refuse(const toml::node& node, const std::string& path, const std::string& text) {
  findings_.report(path, place_of(node.source()), text);
  return {};
}

Value Reader::refuse_type(const toml::node& node, const Rule& rule, const std::string& path) {
  return refuse(node, path,
                fmt::format("expected {}, got {}", expectation(rule, path == rule.key), describe_node(node)));
}

void Reader::read(const toml::table& table, const Table& rules, void* target, const std::string& path) {
  const auto read_rules = [&](const std::vector<Rule>& own) {
    for (const Rule& rule : own)
      if (!is_replaced(table, rule, own)) read_rule(table, rule, target, path);
  };
  read_rules(rules.rules);
  const Variant* variant = rules.variant_of(target);
  // If the selector has a mistake, report only this mistake, and accept the keys of all variants.
  const bool undecided = !rules.selector.empty() && findings_.has_mistake(join_path(path, rules.selector));
  if (variant != nullptr && !undecided) read_rules(variant->rules);
  report_unknown(table, rules, undecided ? nullptr : variant, path);
}

void Reader::read_rule(const toml::table& table, const Rule& rule, void* target, const std::string& path) {
  const std::string key = join_path(path, rule.key);
  const toml::node* node = table.get(rule.key);
  if (node == nullptr) {
    const bool in_first_key = rule.need == Need::here_or_in_first_key && table["keys"][0][rule.key];
    if (rule.need != Need::optional && !in_first_key) {
      const std::string where = rule.need == Need::required ? "" : ", here or in the first of its keys";
      findings_.report(key, findings_.place(path), fmt::format("expected {}{}, got none", expectation(rule), where));
    }
    return;
  }
  findings_.set_place(key, place_of(node->source()));

  // If two keys exclude each other, the one of the later batch replaces the other one. If one batch gives both, report
  // a mistake.
  const toml::node* excluded = rule.excludes.empty() ? nullptr : table.get(rule.excludes);
  if (excluded != nullptr && batch_of(*node) == batch_of(*excluded)) {
    findings_.report(key, place_of(node->source()),
                     fmt::format("expected either {} or {}, got both", rule.key, rule.excludes));
    return;
  }
  if (rule.type == Type::table) {
    if (const auto* inner = node->as_table()) {
      read(*inner, *rule.table, rule.inner(target), key);
    } else {
      refuse_type(*node, rule, key);
    }
  } else if (rule.type == Type::list || rule.type == Type::keys) {
    read_entries(*node, rule, target, key);
  } else if (const Value value = read_value(*node, rule, key); !std::holds_alternative<std::monostate>(value)) {
    rule.set(target, value);
  }
}

void Reader::read_entries(const toml::node& node, const Rule& rule, void* target, const std::string& path) {
  const toml::array* entries = node.as_array();
  if (entries == nullptr) {
    refuse_type(node, rule, path);
    return;
  }
  if (static_cast<double>(entries->size()) > rule.range.high) {
    refuse(node, path, fmt::format("expected at most {} entries, got {}", rule.range.high, entries->size()));
    return;
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < entries->size(); ++i) {
    const toml::node& element = *entries->get(i);
    const toml::table* table = element.as_table();
    const std::string by_index = join_path(path, std::to_string(i));
    if (table == nullptr) {
      refuse(element, by_index, "expected a table, got " + describe_node(element));
      // Append an entry with defaults instead, so that indices match those of the list in the file.
      findings_.add_entry(path, by_index);
      rule.append(target, i);
      continue;
    }
    const std::string entry = entry_path(*table, rule, path, by_index, names);
    findings_.set_place(entry, place_of(element.source()));
    findings_.add_entry(path, entry);
    read(*table, *rule.table, rule.append(target, i), entry);
  }
}

std::string Reader::entry_path(const toml::table& table, const Rule& rule, const std::string& path,
                               const std::string& by_index, std::set<std::string>& names) {
  const auto name = table["name"].value<std::string>();
  if (rule.table->find("name") == nullptr || !name || !is_name(*name)) return by_index;
  if (names.insert(*name).second) return join_path(path, *name);
  findings_.report(join_path(by_index, "name"), place_of(table["name"].node()->source()),
                   fmt::format("expected a name used once, got {} again", in_quotes(*name)));
  return by_index;
}

void Reader::report_unknown(const toml::table& table, const Table& rules, const Variant* variant,
                            const std::string& path) {
  std::vector<std::string> known;
  for (const Rule& rule : rules.rules) known.push_back(rule.key);
  for (const Variant& each : rules.variants) {
    if (variant != nullptr && &each != variant) continue;
    for (const Rule& rule : each.rules) known.push_back(rule.key);
  }
  for (auto&& [key, node] : table) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;

    // Name the most probable cause: a key of another variant, else a key of an inner table, else a misspelling.
    std::string text = "unknown key";
    std::vector<std::string> owners;
    for (const Variant& each : rules.variants) {
      for (const Rule& rule : each.rules) {
        if (rule.key == name) owners.push_back(each.name);
      }
    }
    std::string inner;
    for (const Rule& rule : rules.rules) {
      if (rule.type == Type::table && rule.table->find(name) != nullptr) inner = join_path(rule.key, name);
    }
    if (!owners.empty() && variant != nullptr) {
      text = fmt::format("unknown key of a {}; it belongs to {}", variant->name, join_or(owners));
    } else if (!inner.empty()) {
      text += fmt::format("; did you mean {}?", inner);
    } else if (const std::string near = suggestion(name, known); !near.empty()) {
      text += near;
    } else {
      text += "; known here: " + fmt::format("{}", fmt::join(known, ", "));
    }
    const std::string shown = name.size() > kMaxShownCharacters || !is_name(name) ? in_quotes(name) : name;
    findings_.report(join_path(path, shown), place_of_key(key, node), text);
  }
}

}  // namespace weft::scene
