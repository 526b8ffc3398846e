// Makes the key frames of a character of the scene: the positions of its vertices at each key.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "film/character/parts.hpp"
#include "film/scene/scene.hpp"
#include "physics/mesh/mesh.hpp"
#include "physics/mesh/topology.hpp"
#include "physics/motion/key_frames.hpp"

namespace weft::environment {

using motion::KeyFrames;

/// A part of a character that has its own contact settings, or that pins, obstacles or cameras follow.
struct Part {
  std::string name;
  character::VertexMask vertices;  ///< vertices of the body that belong to the part
  bool collide = true;
  std::optional<double> friction;  ///< coefficient; absent: that of the body
  double thickness = 0;            ///< thickness of padding on the skin [m]
  bool only_followed = false;      ///< whether the scene has no settings for the part; `collide` is then ignored

  /// Whether the part becomes a contact patch (model::Patch).
  bool is_patch() const { return friction || thickness > 0; }
};

/// Start positions [m] of points that follow a character: of the particles of a pin, or of the four points that define
/// the frame of an obstacle or camera (parents.hpp).
struct FollowerPoints {
  std::string part;  ///< part of the character that the points follow; empty: the whole character
  std::vector<Vec3> places;
};

/// The shape of a cloth at the time when it is put on.
struct ClothAtStart {
  std::span<const Vec3> x;  ///< positions of its particles [m]
  std::span<const mesh::Triangle> triangles;
  double put_on = 0;  ///< time at which the cloth is put on, counted from the start of the run [s]
};

/// A body that moves by key frames of its vertices. They are computed before the simulation starts.
struct Actor {
  mesh::Mesh mesh;           ///< mesh in world coordinates at time 0 [m]
  KeyFrames keys;            ///< positions of the vertices and, if the body has bones, of all FollowerPoints
  std::vector<Part> parts;   ///< see parts_of() (body_parts.hpp)
  std::vector<Index> limbs;  ///< per vertex: number by shells_of_limbs() or, for mesh sequences, of the component
  std::vector<std::string> warnings;
  std::vector<std::string> notes;                                 ///< changes made to the body, for the summary
  std::shared_ptr<const character::Coloring> coloring = nullptr;  ///< from its file; null if the file has none
};

/// Reads the files of a character and computes its key frames. The first key is at or just before the time at which the
/// character begins to grow or move. The last key is just after the end of the scene or, if the character only grows,
/// just after it has grown. A character that neither grows nor moves has one key. If a body with bones plays a clip,
/// its skin leaves space for `cloths` near it (character::LimbClearance). Throws Error(asset_unreadable, scene_invalid)
/// that names the scene line, the file, and the mesh, bone or clip.
Actor make_actor(const scene::Scene& scene, const scene::Character& character,
                 std::span<const FollowerPoints> following = {}, std::span<const ClothAtStart> cloths = {});

/// A body with bones at the start of the run, which is the start of the preroll.
struct StandingBody {
  mesh::Mesh mesh;                          ///< mesh in world coordinates [m]
  std::vector<std::optional<Vec3>> joints;  ///< positions of joint_names() in the world [m]; absent: unknown
  std::vector<character::Limb> limbs;       ///< limb of each vertex of the mesh
};

/// Makes the body without key frames. Sewing a garment needs this body of its wearer; make_actor() runs later, because
/// it needs the garments. Throws as make_actor() does. For a sequence of meshes, throws Error(scene_invalid) that
/// begins with `where`.
StandingBody make_standing_body(const scene::Scene& scene, const scene::Character& character, const std::string& where);

/// How far the rest pose of a character is moved from its place in its file (floor_offset()), in the coordinates of the
/// body [m]. Reads the file. Zero for other characters, and without a motion of another file.
Vec3 offset_in_file(const scene::Scene& scene, const scene::Character& character);

/// Size of the key frames of a character, for `weft check --plan`.
struct KeyFrameCount {
  std::size_t keys = 0, vertices = 0, bytes = 0;
  /// Names of the parts that do not collide, with their numbers of vertices.
  std::vector<std::pair<std::string, std::size_t>> left_out = {};
};
/// Counts the key frames without sampling the motion.
KeyFrameCount count_key_frames(const scene::Scene& scene, const scene::Character& character);

}  // namespace weft::environment
