// The parts of surfaces and floor that are in view, for maps that can omit the rest.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "render/shaded_mesh.hpp"
#include "render/view.hpp"

namespace weft::render {

/// What a picture shows, in world space: vertices, and triangles clipped at its borders.
struct InView {
  std::vector<Vec3> places;
  std::vector<std::array<Vec3, 3>> cut;
};

/// Absent if all vertices are in view: the picture then excludes only floor, which no map contains anyway.
std::optional<InView> parts_in_view(const View& view, std::span<const DrawnMesh> meshes,
                                    const std::optional<Floor>& floor);

}  // namespace weft::render
