// Rewrites OBJ and BVH files that assimp 5.2 refuses or misreads.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace weft::assets {

/// Returns the text that assimp shall read instead of `file`, or nullopt if assimp can read `file` itself. The text
/// differs from the file as follows:
/// - All formats: it has no byte order mark, which assimp would read as a part of the first line.
/// - OBJ: it has no comments in lines of numbers (vertices, UVs, normals, faces, line elements,
///   points).
/// - BVH: keywords and names of channels have their usual spelling, such as "Frame Time:" for
///   "frametime:", and spaces in names of joints are underscores. Of joints with equal names, the first keeps its name,
///   and others end with underscores. Joints with some channels of positions have all six channels: assimp skips the
///   positions of others.
std::optional<std::string> readable_text(const std::filesystem::path& file);

/// Throws std::runtime_error if a BVH file has no frames, which assimp 5.2 takes for 2^32 frames, or several skeletons,
/// which it refuses as a missing word "MOTION".
void check_bvh(const std::filesystem::path& file);

}  // namespace weft::assets
