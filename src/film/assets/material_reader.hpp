// Reads the materials of a file from assimp (aiScene).
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <string>
#include <vector>

#include "film/character/character.hpp"

namespace weft::assets {

/// Reads base colour and picture of each material. A picture is embedded in `file` or a separate file. A separate file
/// is searched at the stored path (relative to the folder of `file`), beside `file`, and in picture folders (such as
/// `textures`) beside `file` or beside its folder. Skips unusable pictures with a warning.
std::vector<character::Material> read_materials(const aiScene& scene, const std::filesystem::path& file,
                                                std::vector<std::string>& warnings);

/// Index of the set of texture coordinates that the picture of a material uses; 0 if it has no picture.
unsigned uv_channel(const aiMaterial& material);

/// Applies the texture transform of glTF (KHR_texture_transform) to texture coordinates, v upward. Returns the
/// coordinates of other formats unchanged.
Vec2 placed_uv(const aiMaterial& material, const Vec2& uv);

}  // namespace weft::assets
