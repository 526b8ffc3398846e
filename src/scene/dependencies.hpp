// The files from which a scene takes shapes, masks and motions.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "scene/scene.hpp"

namespace weft::scene {

using DependencyVisitor = std::function<void(const std::filesystem::path& file, std::string_view content)>;

/// Calls `each` with the path and content of the files of obstacles, cloths, masks of pins and weights, and characters;
/// after each file, of those named in it: drawings of a sewing pattern, buffers of a glTF file, skeletons, materials.
/// Pictures of looks and camera files are left out. Visits each file once, in an order that depends on the scene and
/// the files alone. Skips unreadable files and files above kMaxDependencyBytes.
void for_each_dependency(const Scene& scene, const DependencyVisitor& each);

}  // namespace weft::scene
