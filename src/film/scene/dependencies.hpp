// The files from which a scene takes shapes, masks, motions, pictures and camera paths.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "film/scene/scene.hpp"

namespace weft::scene {

/// Results that a file affects. A file that affects both simulation and pictures counts as `simulation`.
enum class FileUse { simulation, pictures };

using DependencyVisitor = std::function<void(const std::filesystem::path& file, std::string_view content, FileUse use)>;

/// Calls `each` once for each file on which the scene depends, with its path and content: first the files of obstacles,
/// of cloths with the masks of their pins and weights, of masks of attachments, and of characters; then the pictures of
/// looks and the files of cameras. Each file except masks and pictures is followed by the files that it names: drawings
/// of a sewing pattern, buffers of a glTF file, skeletons, materials. The order depends only on the scene and the
/// files. Skips unreadable files and files above kMaxDependencyBytes.
void for_each_dependency(const Scene& scene, const DependencyVisitor& each);

}  // namespace weft::scene
