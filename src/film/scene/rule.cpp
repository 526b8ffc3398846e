#include "film/scene/rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft::scene {

const Rule* Table::find(std::string_view key) const {
  for (const Rule& rule : rules) {
    if (rule.key == key) return &rule;
  }
  return nullptr;
}

const Variant* Table::variant_of(void* target) const {
  if (selector.empty()) return nullptr;
  const auto selected = std::get<std::string>(find(selector)->get(target));
  const auto found = std::ranges::find(variants, selected, &Variant::name);
  return found == variants.end() ? nullptr : &*found;
}

std::string join_or(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

namespace {

std::string with_unit(const std::string& text, const Rule& rule) {
  return rule.unit.empty() ? text : text + " " + rule.unit;
}

std::string range_text(const Rule& rule) {
  if (rule.range.low_open) {
    return with_unit(fmt::format("> {} and <= {}", rule.range.low, rule.range.high), rule);
  }
  return with_unit(fmt::format("from {} to {}", rule.range.low, rule.range.high), rule);
}

}  // namespace

std::string violated_bound(const Rule& rule, double value) {
  const auto& [low, high, low_open] = rule.range;
  if (value < low || (low_open && value == low)) {
    return with_unit(fmt::format("{} {}", low_open ? ">" : ">=", low), rule);
  }
  if (std::isfinite(value) && value > high) return with_unit(fmt::format("<= {}", high), rule);
  return "a number " + range_text(rule);
}

std::string expectation(const Rule& rule, bool at_root) {
  switch (rule.type) {
    case Type::boolean:
      return "true or false";
    case Type::text:
      return "a text";
    case Type::texts:
      return "a text or an array of texts";
    case Type::name:
      return "a name of letters, digits, _ and -, starting with a letter, at most 64 long";
    case Type::file:
      return "the path of a file";
    case Type::choice:
      return join_or(rule.choices);
    case Type::color:
      return "[r, g, b], each from 0 to 1, or \"#rrggbb\"";
    case Type::table:
      if (!at_root) return fmt::format("a table ({} = {{ ... }})", rule.key);
      return fmt::format("a table ([{}])", rule.key);
    case Type::list:
      if (!at_root) return fmt::format("a list of tables ({} = [{{ ... }}, ...])", rule.key);
      return fmt::format("a list of tables ([[{}]])", rule.key);
    case Type::keys:
      return fmt::format("a list of tables ({} = [{{ time = 0, ... }}, ...])", rule.key);
    case Type::points:
      return fmt::format("[[{}], ...], each {}", fmt::join(rule.components, ", "), range_text(rule));
    case Type::number:
      break;
  }
  const std::string number = rule.whole ? "a whole number" : "a number";
  if (rule.components.empty())
    return (rule.choices.empty() ? "" : fmt::format("{} or ", fmt::join(rule.choices, ", "))) + number + " " +
           range_text(rule);
  const std::string array = fmt::format("[{}], each {}", fmt::join(rule.components, ", "), range_text(rule));
  return rule.single_fills_all ? number + " or " + array : array;
}

}  // namespace weft::scene
