// What of surfaces and floor is in view, for maps that need not hold the rest.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "render/shaded_mesh.hpp"
#include "render/view.hpp"

namespace weft::render {

/// What a picture shows, world space: vertices, and triangles cut off at its borders.
struct InView {
  std::vector<Vec3> places;
  std::vector<std::array<Vec3, 3>> cut;
};

/// Absent where all vertices are in view: then what the picture leaves out is floor that no map holds anyway.
std::optional<InView> in_view_of(const View& view, std::span<const DrawnMesh> meshes,
                                 const std::optional<Floor>& floor);

}  // namespace weft::render
