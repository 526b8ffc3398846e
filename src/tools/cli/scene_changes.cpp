#include "tools/cli/scene_changes.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/toml.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

std::string scene_value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return json_text(text->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  std::vector<std::string> parts;
  if (const auto* list = node.as_array())
    for (const toml::node& part : *list) parts.push_back(scene_value_text(part));
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

void add_scene_values(const toml::node& node, const std::string& key, KeyedValues& values) {
  const std::string prefix = key.empty() ? "" : key + ".";
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, value] : *table) add_scene_values(value, prefix + std::string(name.str()), values);
    return;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() || !list->front().is_table()) {
    values[key] = scene_value_text(node);
    return;
  }
  std::size_t index = 0;
  for (const toml::node& entry : *list) {
    const toml::table* table = entry.as_table();
    const auto name = table != nullptr ? (*table)["name"].value<std::string>() : std::nullopt;
    add_scene_values(entry, prefix + name.value_or(std::to_string(index++)), values);
  }
}

KeyedValues read_scene_values(const std::string& text, const fs::path& file) {
  try {
    KeyedValues values;
    add_scene_values(parse_toml(text), "", values);
    return values;
  } catch (const toml::parse_error& error) {
    throw Error(ExitCode::asset_unreadable, "{}:{}:{}: expected a scene, got no TOML: {}", file.string(),
                error.source().begin.line, error.source().begin.column, error.description());
  }
}

}  // namespace

std::vector<std::string> list_changes(const KeyedValues& before, const KeyedValues& after) {
  std::map<std::string, std::pair<std::string, std::string>> all;
  for (const auto& [key, value] : before) all[key] = {value, "none"};
  for (const auto& [key, value] : after) all.try_emplace(key, "none", "").first->second.second = value;
  std::vector<std::string> lines;
  for (const auto& [key, pair] : all)
    if (pair.first != pair.second) lines.push_back(fmt::format("{}: {} -> {}", key, pair.first, pair.second));
  return lines;
}

std::vector<std::string> scene_changes(const std::string& before, const fs::path& before_file, const std::string& after,
                                       const fs::path& after_file) {
  return list_changes(read_scene_values(before, before_file), read_scene_values(after, after_file));
}

}  // namespace weft::cli
