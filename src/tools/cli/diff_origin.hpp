// Differences between the runs that made two pictures.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Describes how scene, program version and drawing settings of two runs differ, from the metadata of their pictures or
/// videos and the effective scenes beside them. Empty if the metadata of either names no scene.
std::string describe_origin_changes(const std::filesystem::path& reference, const std::filesystem::path& test);

}  // namespace weft::cli
