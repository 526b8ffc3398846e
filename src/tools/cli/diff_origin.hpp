// Differences between the runs that made two pictures.
#pragma once

#include <filesystem>
#include <string>

namespace weft::cli {

/// Describes how two runs differ, from the metadata of their pictures or videos and the effective scenes beside them:
/// the changes of the scene or, if the scene is the same, the changes of program version, OpenGL and drawing settings.
/// At most four changes are listed. Returns an empty text if the metadata of either file contain no scene hash.
std::string describe_origin_changes(const std::filesystem::path& reference, const std::filesystem::path& test);

}  // namespace weft::cli
