// The files that determine what a scene shows.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "scene/scene.hpp"

namespace weft::scene {

using DependencyVisitor = std::function<void(const std::filesystem::path& file, std::string_view content)>;

/// Calls `each` with the path and content of every file that the scene names and, directly after it, of the files that
/// this file names: drawings of a sewing pattern, buffers of a glTF file, skeletons, and materials (which change
/// nothing). Visits each file once, in an order that depends on the scene alone. Skips unreadable files.
void for_each_dependency(const Scene& scene, const DependencyVisitor& each);

}  // namespace weft::scene
