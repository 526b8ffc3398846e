// All objects of a scene (seed, Fig. 1): topology, geometry, how cloth starts, and where its bodies are at any time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "assets/mesh_file.hpp"
#include "character/character.hpp"
#include "core/types.hpp"
#include "environment/acting.hpp"
#include "environment/dynamics.hpp"
#include "environment/key_frames.hpp"
#include "environment/parents.hpp"
#include "environment/track.hpp"
#include "environment/wearers.hpp"
#include "mesh/mesh.hpp"
#include "mesh/sheet.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// A particle of a part of a cloth, numbered within it.
struct Chosen {
  Index particle = 0;
  double share = 1;    ///< above 0, at most 1: of the strength or mass that the part has for each
  bool faded = false;  ///< around the part of a pin, not of it
};

/// A deformable sheet, of quads or of triangles, as it starts.
struct ClothObject {
  std::string name;
  mesh::Grid grid;              ///< of quads
  mesh::Sheet sheet;            ///< of triangles, in the cloth's own coordinates; empty for quads
  mesh::Mesh mesh;              ///< rest shape in the world pose of the start; uv: weft and warp from its corner
  std::vector<Vec2> fractions;  ///< place of each particle in fractions of the rest size along weft and warp
  std::map<std::string, std::vector<Index>> edges;  ///< of a pattern, by "panel.edge": particles
  std::vector<std::string> panels;                  ///< of a pattern: names
  std::vector<std::int32_t> panel_of;               ///< of a pattern, per triangle: into panels
  std::vector<std::array<Vec2, 3>> paint_uv;  ///< of a pattern, per triangle: corners along the grain of the panel [m]
  /// Least distance between particles of a grid [m]; of triangles √2 times the least height, which is the same for the
  /// two halves of a square.
  double spacing = 0;
  std::vector<std::vector<Chosen>> pins, weights;  ///< particles of each of the scene; of a pin its part comes first
  std::vector<std::vector<Chosen>> attachments;    ///< likewise, of those in scene.attachments that name this cloth
  std::vector<double> lengths;  ///< of a rope: of its pieces at rest [m]; of a closed one as many as particles
  std::vector<Vec3> start;      ///< positions of the particles [m]
  Vec3 velocity{0, 0, 0};       ///< of all of them [m/s]
  double put_on = 0;            ///< time after the start of the simulation, its preroll included, at which it comes [s]
  std::string fitted;           ///< of a pattern that was scaled to its wearer: how
  std::string rest_from;        ///< of a mesh file: what its shape at rest is taken from, and why
  std::vector<std::string> warnings;
};

/// A body: an obstacle, still, moved by keys or moved by forces, or a character.
struct BodyObject {
  std::string name;
  mesh::Mesh
      mesh;  ///< of obstacles in their own coordinates, turned to the scene's up axis; of characters as they start
  bool character = false;
  bool moving = false;
  bool collide = true;
  bool infinite_floor = false;
  double friction = 0.3;
  scene::Look look;
  std::shared_ptr<const character::Coloring> coloring;  ///< of characters whose file has some; else null
  std::vector<Part> parts;                              ///< of characters
  std::shared_ptr<const Dynamics> dynamics;             ///< of obstacles with a mass; else null
  std::vector<Index> limbs;  ///< likewise, of each vertex, from 0: they may come to lie in each other
  /// Of what has bones: a cloth and a pin of it that follows, and the first vertex that Environment::vertex() has for
  /// the particles of the pin, behind those of the mesh.
  struct Follower {
    std::size_t cloth = 0, pin = 0, first_vertex = 0;
  };
  std::vector<Follower> followers;
  std::vector<mesh::Triangle> colliding;     ///< where a part is left out: the others, closed; else none
  std::vector<std::uint8_t> passed_through;  ///< of triangles of the mesh: 1 where they do not collide; empty: all do
  std::span<const mesh::Triangle> colliding_triangles() const {
    return colliding.empty() ? mesh.topology.triangles : colliding;
  }
};

/// The shape of an obstacle in its own coordinates, and the UVs of its file. Throws as Environment() does.
assets::LoadedMesh mesh_of(const scene::Scene& scene, const scene::Obstacle& obstacle);

/// Rest places of the particles of a rectangle of cloth.
mesh::Grid grid_of(const scene::Cloth& cloth);

/// Throws Error(scene_invalid) where the cells of a rectangle are too uneven to meet obstacles. make_cloth() does so,
/// and for triangles of files.
void check_spacing(const scene::Scene& scene, const scene::Cloth& cloth);

/// A cloth as it starts. Throws Error(asset_unreadable, scene_invalid) for what its file holds, naming the scene's
/// line.
ClothObject make_cloth(const scene::Scene& scene, const scene::Cloth& cloth, Wearers& wearers);

struct Followers;

/// Changes by set_motion() alone: who steps through time keeps what it asks for.
class Environment {
 public:
  /// Makes meshes and motions. Throws Error(asset_unreadable, scene_invalid) naming file and scene line.
  explicit Environment(const scene::Scene& scene);

  /// The same with these cloths alone, by ascending number; motions are shared.
  Environment with_cloths(std::span<const std::size_t> numbers) const;

  /// Writes where the vertices of a body are at time t [s], as many as its mesh has. Linear in them, in parallel;
  /// allocates nothing. A body that does not move is where it is at time 0.
  void place(std::size_t body, double t, std::span<Vec3> positions) const;

  /// From now on the obstacle moves so. Only of one that is `moving`, and where it is now must stay the same.
  /// It follows nothing then.
  void set_motion(std::size_t obstacle, const scene::PoseTrack& motion) {
    movers_[obstacle] = std::make_shared<const Mover>(Track(motion));
    if (!parents_.empty()) parents_[obstacle] = {};
  }

  /// Pose of an obstacle at any time [s], and how it changes.
  PoseSample pose(std::size_t obstacle, double t) const {
    PoseSample own = std::get<Track>(*movers_[obstacle]).at(t);
    if (parents_.empty() || !parents_[obstacle].is_any()) return own;
    return compose(pose(parents_[obstacle], t), parents_[obstacle].start, own);
  }
  PoseSample pose(const Parent& parent, double t) const {
    return parent.part ? parent.part->at(t) : pose(parent.obstacle, t);
  }

  /// The same of one vertex of a character, or of what follows it.
  VertexMotion vertex(std::size_t character, std::size_t vertex, double t) const {
    return std::get<KeyFrames>(*movers_[character]).at(t, vertex);
  }

  std::vector<ClothObject> cloths;
  std::vector<BodyObject> bodies;      ///< in the order of scene.obstacles, then of scene.characters
  std::vector<Parent> camera_parents;  ///< one per camera; empty: none has any

 private:
  using Mover = std::variant<Track, KeyFrames>;
  void add_parents(const scene::Scene& scene);
  void add_part_parents(const scene::Scene& scene, const scene::Character& character, const Followers& followers,
                        const KeyFrames& keys);

  std::vector<std::shared_ptr<const Mover>> movers_;  ///< one per body
  std::vector<Parent> parents_;                       ///< one per obstacle; empty: none has any
};

}  // namespace weft::environment
