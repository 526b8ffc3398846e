// Coordinates of a picture on the surface of an obstacle.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/types.hpp"
#include "film/assets/mesh_file.hpp"
#include "film/scene/scene.hpp"

namespace weft::environment {

/// Picture coordinates (u, v) of the corners of each triangle: 0 to 1 from left to right and from bottom to top; values
/// outside [0, 1] lie in repetitions of the picture.
using PicturePlaces = std::vector<std::array<Vec2, 3>>;

/// Computes where the picture of an obstacle lies. `shape`: made by environment::mesh_of() for this scene. `tile`: size
/// of one repetition, measured along the surface [m]. Without `tile`, the picture lies once around a round shape, once
/// on each flat side, or according to the UVs of a file. Seen from outside, with the front toward −y and z up, pictures
/// are upright; on round shapes, their middle is at the front. A picture that goes around a shape is scaled to a whole
/// number of repetitions. Throws Error(asset_unreadable) with the scene line if a file has no UVs.
PicturePlaces picture_places(const scene::Scene& scene, const scene::Obstacle& obstacle,
                             const assets::LoadedMesh& shape, const std::optional<Vec2>& tile);

}  // namespace weft::environment
