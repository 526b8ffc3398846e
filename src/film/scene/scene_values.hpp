// The values of a scene file by their keys.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace weft::scene {

/// Calls `add` for each value of a scene in TOML, with its key and its text, in the order of the parsed tables. Keys
/// name list entries by their `name`, or by their index if they have none, as in --set. Throws toml::parse_error if the
/// text is not TOML.
void list_values(std::string_view toml,
                 const std::function<void(const std::string& key, const std::string& value)>& add);

}  // namespace weft::scene
