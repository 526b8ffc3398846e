// Differences between the runs that made two pictures.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Describes how two runs differ, from the metadata of their pictures or videos and the effective scenes beside them:
/// the changes of the scene or, if the scene is the same, those of program version, OpenGL and drawing settings. Empty
/// if the metadata of either has no hash of a scene.
std::string describe_origin_changes(const std::filesystem::path& reference, const std::filesystem::path& test);

}  // namespace weft::cli
