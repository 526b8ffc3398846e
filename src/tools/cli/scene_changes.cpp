#include "tools/cli/scene_changes.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/toml.hpp"
#include "film/scene/scene_values.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

KeyedValues read_scene_values(const std::string& text, const fs::path& file) {
  try {
    KeyedValues values;
    scene::list_values(text, [&](const std::string& key, const std::string& value) { values[key] = value; });
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
