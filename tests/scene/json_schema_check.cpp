#include "scene/json_schema_check.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace weft::scene {

using nlohmann::json;

namespace {

bool has_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  throw std::logic_error("unknown type " + type);
}

class SchemaChecker {
 public:
  std::string violation(const json& schema, const json& value, const std::string& path) {
    if (schema == true) return {};
    for (const auto& [keyword, unused] : schema.items()) {
      if (!kKnown.contains(keyword)) throw std::logic_error("unknown keyword " + keyword);
    }
    const auto at = [&](const std::string& what) { return path + ": " + what; };
    if (schema.contains("type") && !has_type(value, schema["type"])) return at("wrong type");
    if (schema.contains("enum")) {
      const auto& choices = schema["enum"];
      if (std::find(choices.begin(), choices.end(), value) == choices.end()) return at("not one of the choices");
    }
    if (schema.contains("pattern") &&
        !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>()))) {
      return at("wrong pattern");
    }
    if (value.is_number()) {
      if (value < schema.value("minimum", -1e300) || value <= schema.value("exclusiveMinimum", -1e300))
        return at("below minimum");
      if (value > schema.value("maximum", 1e300)) return at("above maximum");
    }
    const auto fits = [&](const json& one) { return violation(one, value, path).empty(); };
    if (schema.contains("anyOf") && std::none_of(schema["anyOf"].begin(), schema["anyOf"].end(), fits))
      return at("none of the choices fits");
    for (const json& condition : schema.value("allOf", json::array())) {
      if (!violation(condition["if"], value, path).empty()) continue;
      const std::string found = violation(condition["then"], value, path);
      if (!found.empty()) return found;
    }
    if (value.is_array()) return array_violation(schema, value, path);
    if (value.is_object()) return object_violation(schema, value, path);
    return {};
  }

 private:
  std::string array_violation(const json& schema, const json& value, const std::string& path) {
    if (value.size() < schema.value("minItems", 0.0) || value.size() > schema.value("maxItems", 1e300)) {
      return path + ": wrong number of items";
    }
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i) {
      const std::string found = violation(schema["items"], value[i], path + "." + std::to_string(i));
      if (!found.empty()) return found;
    }
    return {};
  }

  std::string object_violation(const json& schema, const json& value, const std::string& path) {
    if (!schema.contains("properties")) return {};
    for (const json& key : schema.value("required", json::array())) {
      if (!value.contains(key)) return path + ": " + key.get<std::string>() + " is missing";
    }
    for (const auto& [key, member] : value.items()) {
      const std::string inner = path.empty() ? key : path + "." + key;
      if (schema["properties"].contains(key)) {
        const std::string found = violation(schema["properties"][key], member, inner);
        if (!found.empty()) return found;
      } else if (!schema.value("additionalProperties", true)) {
        return inner + ": unknown property";
      }
    }
    return {};
  }

  const std::set<std::string> kKnown = {
      "$schema", "title",    "description",      "default",    "type",     "enum",
      "pattern", "minimum",  "exclusiveMinimum", "maximum",    "anyOf",    "allOf",
      "items",   "minItems", "maxItems",         "properties", "required", "additionalProperties"};
};

}  // namespace

json json_of_toml(const std::string& text) {
  std::ostringstream out;
  out << toml::json_formatter(toml::parse(std::string_view(text)));
  return json::parse(out.str());
}

std::string schema_violation(const json& schema, const json& value) {
  return SchemaChecker().violation(schema, value, "");
}

}  // namespace weft::scene
