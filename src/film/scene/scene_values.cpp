#include "film/scene/scene_values.hpp"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "core/json.hpp"
#include "core/toml.hpp"

namespace weft::scene {
namespace {

using Add = std::function<void(const std::string& key, const std::string& value)>;

std::string text_of_value(const toml::node& node) {
  if (const auto* text = node.as_string()) return json_text(text->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  std::vector<std::string> parts;
  if (const auto* list = node.as_array()) {
    for (const toml::node& part : *list) parts.push_back(text_of_value(part));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  return "?";  // dates, which no scene contains
}

void list_values_of(const toml::node& node, const std::string& key, const Add& add) {
  const std::string prefix = key.empty() ? "" : key + ".";
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, value] : *table) list_values_of(value, prefix + std::string(name.str()), add);
    return;
  }
  const toml::array* list = node.as_array();
  if (list == nullptr || list->empty() || !list->front().is_table()) return add(key, text_of_value(node));
  std::size_t index = 0;
  for (const toml::node& entry : *list) {
    const toml::table* table = entry.as_table();
    const auto name = table != nullptr ? (*table)["name"].value<std::string>() : std::nullopt;
    list_values_of(entry, prefix + name.value_or(std::to_string(index++)), add);
  }
}

}  // namespace

void list_values(std::string_view toml, const Add& add) {
  list_values_of(parse_toml(toml), "", add);
}

}  // namespace weft::scene
