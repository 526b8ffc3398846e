// The files on which a scene depends: shapes, masks, motions, pictures and camera paths.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// What a file affects: the simulation and thus also the pictures, or the pictures alone.
enum class FileUse { simulation, pictures };

using DependencyVisitor = std::function<void(const std::filesystem::path& file, std::string_view content, FileUse use)>;

/// Calls `each` once for each file on which the scene depends, with its path and content. The order depends only on the
/// scene and the files:
/// - first the files of obstacles, the files of cloths and the masks of their pins and weights, the masks of
///   attachments, and the files of characters; then the pictures of looks and the files of cameras;
/// - after each file except masks and pictures, the existing files whose names occur in it:
///   drawings of a sewing pattern, buffers of a glTF file, skeletons, materials.
/// Skips unreadable files and files larger than kMaxDependencyBytes (dependencies.cpp).
void for_each_dependency(const Scene& scene, const DependencyVisitor& each);

}  // namespace weft::scene
