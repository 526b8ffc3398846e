// Differences between two scenes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weft::cli {

using KeyedValues = std::map<std::string, std::string>;  ///< values as text, by key

/// One line for each key whose value differs, in key order: "wind: [8, 2, 0] -> [8, 3, 0]". A missing value is "none".
std::vector<std::string> list_changes(const KeyedValues& before, const KeyedValues& after);

/// The differences of two effective scenes in TOML, as lines of list_changes(). Keys name list entries by their `name`,
/// as in --set. The file names are for messages. Throws Error(asset_unreadable) if a text is not TOML.
std::vector<std::string> scene_changes(const std::string& before, const std::filesystem::path& before_file,
                                       const std::string& after, const std::filesystem::path& after_file);

}  // namespace weft::cli
