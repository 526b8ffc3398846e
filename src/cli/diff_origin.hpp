// Differences between the runs that made two pictures.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Lists the differences of scene and program, from the metadata of the pictures or videos and from the effective
/// scenes beside them. Empty if a scene is not known.
std::string describe_origin_changes(const std::filesystem::path& reference, const std::filesystem::path& test);

}  // namespace weft::cli
