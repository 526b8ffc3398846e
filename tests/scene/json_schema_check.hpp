// A small independent validator of JSON schemas, for the part of Draft 2020-12 that the scene schema uses.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace weft::scene {

/// Converts TOML text to JSON; throws what toml++ throws.
nlohmann::json json_of_toml(const std::string& text);

/// Returns the first violation, "key.path: what", or "". Throws std::logic_error at an unknown schema keyword.
std::string schema_violation(const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace weft::scene
