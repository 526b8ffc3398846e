// The JSON schema of a format (Draft 2020-12). It uses only features of draft 7, because some editors do not support
// later drafts.
#include <fmt/format.h>

#include "core/json.hpp"
#include "film/scene/loader.hpp"
#include "film/scene/rule.hpp"

namespace weft::scene {

namespace {

using Json = nlohmann::ordered_json;

Json table_schema(const Table& table);

Json number_schema(const Rule& rule) {
  Json number = {{"type", rule.whole ? "integer" : "number"}};
  number[rule.range.low_open ? "exclusiveMinimum" : "minimum"] = rule.range.low;
  number["maximum"] = rule.range.high;
  return number;
}

Json numbers_schema(const Rule& rule) {
  Json number = number_schema(rule);
  if (rule.components.empty()) return number;
  const std::size_t count = rule.components.size();
  const Json array = {{"type", "array"}, {"items", number}, {"minItems", count}, {"maxItems", count}};
  return rule.single_fills_all ? Json{{"anyOf", {number, array}}} : array;
}

Json type_schema(const Rule& rule) {
  switch (rule.type) {
    case Type::boolean:
      return {{"type", "boolean"}};
    case Type::text:
    case Type::file:
      return {{"type", "string"}};
    case Type::texts:
      return {{"anyOf", {{{"type", "string"}}, {{"type", "array"}, {"items", {{"type", "string"}}}}}}};
    case Type::name:
      return {{"type", "string"}, {"pattern", "^[A-Za-z][A-Za-z0-9_-]{0,63}$"}};
    case Type::choice:
      return {{"type", "string"}, {"enum", rule.choices}};
    case Type::color:
      return {{"anyOf", {numbers_schema(rule), {{"type", "string"}, {"pattern", "^#[0-9A-Fa-f]{6}$"}}}}};
    case Type::number:
      if (!rule.choices.empty())
        return {{"anyOf", {numbers_schema(rule), {{"type", "string"}, {"enum", rule.choices}}}}};
      return numbers_schema(rule);
    case Type::points:
      return {{"type", "array"}, {"items", numbers_schema(rule)}, {"minItems", 1}};
    case Type::table:
      return table_schema(*rule.table);
    case Type::list:
    case Type::keys:
      return {{"type", "array"},
              {"items", table_schema(*rule.table)},
              {"maxItems", static_cast<std::int64_t>(rule.range.high)}};
  }
  return {};
}

/// The description of a key, such as "length of the film [s]": documentation, components, unit, default and excluded
/// key.
std::string description(const Rule& rule) {
  std::string text = rule.documentation;
  if ((rule.type == Type::number || rule.type == Type::points) && !rule.components.empty())
    text += fmt::format(": {}", fmt::join(rule.components, ", "));
  if (!rule.unit.empty()) text += fmt::format(" [{}]", rule.unit);
  if (!rule.default_note.empty()) text += "; by default " + rule.default_note;
  if (!rule.excludes.empty()) text += fmt::format("; not beside {}", rule.excludes);
  return text;
}

Json default_of(const Rule& rule, void* defaults) {
  const Value value = rule.get(defaults);
  if (const bool* flag = std::get_if<bool>(&value)) return *flag;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
    return rule.components.empty() ? Json((*numbers)[0]) : Json(*numbers);
  }
  return nullptr;
}

/// Adds the key of one rule to the properties of a table and, if the key is required, to its required keys.
void add_rule(Json& schema, const Rule& rule, void* defaults) {
  Json property = type_schema(rule);
  property["description"] = description(rule);
  const bool has_default = rule.get && rule.need == Need::optional && rule.default_note.empty();
  if (has_default) {
    if (Json value = default_of(rule, defaults); !value.is_null() && value != Json("")) property["default"] = value;
  }
  schema["properties"][rule.key] = std::move(property);
  if (rule.need == Need::required) schema["required"].push_back(rule.key);
}

/// The schema of a table with its common rules and the rules of `variant`. If `variant` is null: only the common rules.
Json variant_schema(const Table& table, const Variant* variant) {
  Json schema = {{"type", "object"}, {"description", table.documentation}, {"properties", Json::object()}};
  const auto defaults = table.make();
  if (variant != nullptr) table.find(table.selector)->set(defaults.get(), variant->name);
  for (const Rule& rule : table.rules) add_rule(schema, rule, defaults.get());
  if (variant != nullptr)
    for (const Rule& rule : variant->rules) add_rule(schema, rule, defaults.get());
  schema["additionalProperties"] = false;
  return schema;
}

/// Whether two schemas allow the same values; their descriptions and defaults may differ.
bool allow_same_values(Json one, Json other) {
  for (Json* schema : {&one, &other}) {
    schema->erase("description");
    schema->erase("default");
  }
  return one == other;
}

/// A schema that a table fulfils if its selector selects this variant.
Json condition(const Table& table, const Variant& variant) {
  Json when = {{"properties", {{table.selector, {{"enum", {variant.name}}}}}}};
  // If the selector is absent, the default variant applies.
  const auto defaults = table.make();
  if (table.find(table.selector)->need == Need::required || table.variant_of(defaults.get()) != &variant)
    when["required"].push_back(table.selector);
  return when;
}

// The schema of a table. Its properties are those of all variants, so that editors can complete them. For each variant,
// a condition gives the allowed keys, so that editors show which key is wrong. If the schema used oneOf, editors would
// only show that the table is wrong.
Json table_schema(const Table& table) {
  Json schema = variant_schema(table, nullptr);
  if (table.variants.empty()) return schema;
  schema.erase("additionalProperties");
  Json& properties = schema["properties"];
  std::vector<Json> variants;
  for (const Variant& variant : table.variants) variants.push_back(variant_schema(table, &variant));
  for (const Json& variant : variants)
    for (const auto& [key, property] : variant["properties"].items()) {
      if (!properties.contains(key)) properties[key] = property;
      if (!allow_same_values(property, properties[key]))
        properties[key] = {{"description", properties[key]["description"]}};
    }
  Json conditions = Json::array();
  for (std::size_t i = 0; i < variants.size(); ++i) {
    for (const char* unused : {"type", "description"}) variants[i].erase(unused);
    // Do not repeat properties that are equal to those of the table.
    for (auto& [key, property] : variants[i]["properties"].items())
      if (property == properties[key]) property = true;
    conditions.push_back({{"if", condition(table, table.variants[i])}, {"then", std::move(variants[i])}});
  }
  schema["allOf"] = std::move(conditions);
  return schema;
}

}  // namespace

std::string json_schema(const Table& table, const std::string& title) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
  schema.update(table_schema(table));
  return json_text(schema, 2) + "\n";
}

}  // namespace weft::scene
