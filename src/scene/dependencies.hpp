// The files from which a scene takes shapes, masks, motions, pictures and camera paths.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "scene/scene.hpp"

namespace weft::scene {

/// What a file affects. Files that affect both count as `simulation`.
enum class FileUse { simulation, pictures };

using DependencyVisitor = std::function<void(const std::filesystem::path& file, std::string_view content, FileUse use)>;

/// Calls `each` with the path and content of the files of obstacles, cloths, masks of pins and weights, and characters,
/// then of the pictures of looks and the files of cameras; after each file but masks and pictures, of those named in
/// it: drawings of a sewing pattern, buffers of a glTF file, skeletons, materials. Visits each file once, in an order
/// that depends on the scene and the files alone. Skips unreadable files and files above kMaxDependencyBytes.
void for_each_dependency(const Scene& scene, const DependencyVisitor& each);

}  // namespace weft::scene
