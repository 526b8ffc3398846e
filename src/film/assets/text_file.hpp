// OBJ and BVH files as assimp 5.2 can read them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace weft::assets {

/// Text for assimp to read in place of `file`; nullopt if assimp reads the file itself. The text differs from the file
/// in what assimp 5.2 refuses or misreads:
/// - It begins after the byte order mark, which assimp takes for a part of the first line.
/// - OBJ: lines of vertices, faces and lines end before a comment.
/// - BVH: keywords and names of channels have their usual spelling, such as "Frame Time:" for "frametime:", and spaces
///   in names of joints are underscores.
std::optional<std::string> readable_text(const std::filesystem::path& file);

}  // namespace weft::assets
