// The files that what a scene shows depends on.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "scene/scene.hpp"

namespace weft::scene {

using DependencyVisitor = std::function<void(const std::filesystem::path& file, std::string_view content)>;

/// Calls `each` with the path and content of every file that the scene names and, right after it, of those which that
/// file names in turn: drawings of a sewing pattern, buffers of a glTF file, skeletons, and materials too, which change
/// nothing. Each file once, in an order that depends on the scene alone. Files that cannot be read are left out.
void for_each_dependency(const Scene& scene, const DependencyVisitor& each);

}  // namespace weft::scene
