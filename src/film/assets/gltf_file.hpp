// glTF files as assimp 5.2 can read them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace weft::assets {

/// Bytes of a binary glTF file for assimp to read in place of `file`; nullopt if assimp reads the file itself: if it is
/// no glTF, or has nothing that assimp 5.2 reads wrongly. Such bytes differ from the file in two ways:
/// - Integers in attributes and in channels of animations become floats. assimp copies their bytes into its floats.
/// - Files in binary layout with an ending such as .vrm, which assimp takes for OBJ, are passed on as they are.
/// Throws std::runtime_error for glTF with an extension that it requires and that is not read, such as a compression,
/// and for JSON that is nested too deeply.
std::optional<std::string> readable_gltf(const std::filesystem::path& file);

}  // namespace weft::assets
