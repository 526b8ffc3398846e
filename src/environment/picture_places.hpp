// Where a picture lies on an obstacle.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "assets/mesh_file.hpp"
#include "core/types.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// Places in a picture of the corners of each triangle: from 0 to 1 from left to right and from the bottom to the top,
/// and on into its repetitions.
using PicturePlaces = std::vector<std::array<Vec2, 3>>;

/// `shape`: as environment::mesh_of() makes it for this scene. `tile`: size of one repetition [m], in which lengths on
/// the surface are measured; none: the picture lies once around the shape, once on each side of a box, and by the UVs
/// of a file. Seen from outside, with the front toward −y and z up, pictures are upright, and their middle is at the
/// front of what is round. Where they go around, their width is changed to a whole number of repetitions.
/// Throws Error(asset_unreadable) after `where` if a file has no UVs.
PicturePlaces picture_places(const scene::Scene& scene, const scene::Obstacle& obstacle,
                             const assets::LoadedMesh& shape, const std::optional<Vec2>& tile);

}  // namespace weft::environment
