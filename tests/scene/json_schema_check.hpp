// A small independent judge of JSON schemas: the part of Draft 2020-12 that the scene schema uses, no more.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace weft::scene {

/// TOML text as JSON; throws what toml++ throws.
nlohmann::json json_of_toml(const std::string& text);

/// The first violation, "key.path: what", or nothing. Throws std::logic_error at a schema keyword it does not know.
std::string schema_violation(const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace weft::scene
