// Materials of assimp's scenes.
#pragma once

#include <assimp/scene.h>

#include <filesystem>
#include <string>
#include <vector>

#include "character/character.hpp"

namespace weft::assets {

/// Base colour and picture of each material: pictures inside of the file, or files that it names, which are looked for
/// below its folder. What cannot be had is left out with a warning.
std::vector<character::Material> read_materials(const aiScene& scene, const std::filesystem::path& file,
                                                std::vector<std::string>& warnings);

/// Which of a mesh's sets of texture coordinates the picture of its material goes by.
unsigned uv_channel(const aiMaterial& material);

}  // namespace weft::assets
