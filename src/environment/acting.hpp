// From a character of the scene to its key frames.
#pragma once

#include <string>
#include <vector>

#include "environment/key_frames.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// A body that moves by key frames of its vertices, made before the simulation starts.
struct Actor {
  mesh::Mesh mesh;  ///< in the world at time 0
  KeyFrames keys;
  std::vector<std::string> warnings;
};

/// Reads the files of a character and stores its key frames from time 0 to the end of the scene. Throws
/// Error(asset_unreadable, scene_invalid) with scene line, file and part.
Actor make_actor(const scene::Scene& scene, const scene::Character& character);

/// What make_actor would store, without making it, for the plan.
struct KeyFrameCount {
  std::size_t keys = 0, vertices = 0, bytes = 0;
};
KeyFrameCount count_key_frames(const scene::Scene& scene, const scene::Character& character);

}  // namespace weft::environment
