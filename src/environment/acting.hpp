// From a character of the scene to its key frames.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "character/parts.hpp"
#include "environment/key_frames.hpp"
#include "mesh/mesh.hpp"
#include "mesh/topology.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// A part of a character that pins follow, or that has a say of its own in contact.
struct Part {
  std::string name;
  character::VertexMask vertices;  ///< of the body's mesh
  bool collide = true;
  std::optional<double> friction;  ///< none: that of the body
  double thickness = 0;            ///< [m]

  bool is_patch() const { return friction || thickness > 0; }
};

/// Particles of a pin that follows a character, at the start. [m]
struct FollowingPin {
  std::string part;  ///< of the character; empty: all of it
  std::vector<Vec3> places;
};

/// A cloth as it is when it is put on.
struct ClothAtStart {
  std::span<const Vec3> x;  ///< places of its particles [m]
  std::span<const mesh::Triangle> triangles;
  double put_on = 0;  ///< time after the start of the run at which it comes [s]
};

/// A body that moves by key frames of its vertices, made before the simulation starts.
struct Actor {
  mesh::Mesh mesh;           ///< in the world at time 0
  KeyFrames keys;            ///< of its vertices and then, of what has bones, of the places of all following pins
  std::vector<Part> parts;   ///< those of the scene, and those that its pins follow
  std::vector<Index> limbs;  ///< that each vertex of the mesh is of, from 0
  std::vector<std::string> warnings;
  std::vector<std::string> notes;                                 ///< for the summary: what was done to the body
  std::shared_ptr<const character::Coloring> coloring = nullptr;  ///< of its file, where that has some
};

/// Reads the files of a character and stores its key frames from time 0 to the end of the scene. Its skin leaves room
/// for the `cloths` that are on it. Throws
/// Error(asset_unreadable, scene_invalid) with scene line, file and part.
Actor make_actor(const scene::Scene& scene, const scene::Character& character,
                 std::span<const FollowingPin> following = {}, std::span<const ClothAtStart> cloths = {});

/// A body with bones as it stands at the start of a scene, before its preroll.
struct Standing {
  mesh::Mesh mesh;                          ///< in the world [m]
  std::vector<std::optional<Vec3>> joints;  ///< of joint_names(), likewise; none: not known
  std::vector<character::Limb> limbs;       ///< of the mesh
};

/// Reads the files of a character, once more than make_actor, which needs the garment. Throws as it does, and
/// Error(scene_invalid) for a sequence of meshes, after `where`.
Standing stand(const scene::Scene& scene, const scene::Character& character, const std::string& where);

/// What make_actor would store, without making it, for the plan.
struct KeyFrameCount {
  std::size_t keys = 0, vertices = 0, bytes = 0;
  std::vector<std::pair<std::string, std::size_t>> left_out = {};  ///< parts that do not collide, and their vertices
};
KeyFrameCount count_key_frames(const scene::Scene& scene, const scene::Character& character);

}  // namespace weft::environment
