// Reads materials of assimp's scenes.
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <string>
#include <vector>

#include "film/character/character.hpp"

namespace weft::assets {

/// Base colour and picture of each material. A picture is embedded, or it is a file, searched at the stored path,
/// beside `file`, and in picture folders (such as `textures`) beside `file` or one folder above. Unusable pictures are
/// skipped with a warning.
std::vector<character::Material> read_materials(const aiScene& scene, const std::filesystem::path& file,
                                                std::vector<std::string>& warnings);

/// The set of texture coordinates that the picture of a material uses.
unsigned uv_channel(const aiMaterial& material);

/// Texture coordinates, v upward, where the texture transform of glTF (KHR_texture_transform) places them in the
/// picture.
Vec2 placed_uv(const aiMaterial& material, const Vec2& uv);

}  // namespace weft::assets
