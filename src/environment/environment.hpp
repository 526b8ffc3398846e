// All objects of a scene (seed, Fig. 1): topology, geometry, start of cloth, and positions of bodies at any time.
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

/// A particle of a region of a cloth; numbered within the cloth.
struct Chosen {
  Index particle = 0;
  double share = 1;    ///< in (0, 1]: factor on the strength; the mass of a weight is distributed in proportion to it
  bool faded = false;  ///< in the fade around the region of a pin, not in the region itself
};

/// A cloth as it starts: a deformable sheet of quads or triangles, or a rope.
struct ClothObject {
  std::string name;
  mesh::Grid grid;    ///< of quads; of a rope: one row
  mesh::Sheet sheet;  ///< if it is made of triangles, in its own coordinates; else empty
  mesh::Mesh mesh;    ///< rest shape in the world, posed as at the start; uv: along weft and warp from a corner [m]
  std::vector<Vec2> fractions;  ///< position of each particle along weft and warp, in fractions of the rest size
  std::map<std::string, std::vector<Index>> edges;  ///< of a pattern: particles by "panel.edge"
  std::vector<std::string> panels;                  ///< of a pattern: names
  std::vector<std::int32_t> panel_of;               ///< of a pattern: panel number of each triangle
  /// Of cloth sewn from panels: coordinates of the corners of each triangle in its panel (weft, warp) [m].
  std::vector<std::array<Vec2, 3>> paint_uv;
  /// Smallest distance between neighbouring particles of a grid or rope [m]. For triangles, √2 times the smallest
  /// height, which gives the same value for the two halves of a square.
  double spacing = 0;
  /// Particles of each pin and weight of the scene; for a pin, first its region, then its fade.
  std::vector<std::vector<Chosen>> pins, weights;
  std::vector<std::vector<Chosen>> attachments;  ///< particles of each entry of scene.attachments that names this cloth
  /// Of a rope: rest lengths of its pieces [m]. A closed rope has as many pieces as particles.
  std::vector<double> lengths;
  std::vector<Vec3> start;  ///< positions of its particles [m]
  Vec3 velocity{0, 0, 0};   ///< of all particles at the start [m/s]
  double put_on = 0;        ///< time since the start of the run, preroll included, at which it is put on [s]
  std::string fitted;       ///< of a pattern that was scaled to its wearer: describes how
  std::string rest_from;    ///< of a mesh file: what gives the rest shape, and why
  std::vector<std::string> warnings;
};

/// An obstacle (still, moved by keys or moved by forces) or a character.
struct BodyObject {
  std::string name;
  mesh::Mesh
      mesh;  ///< obstacle: in its own coordinates, turned to the scene's up axis; character: in the world at time 0
  bool character = false;
  bool moving = false;
  bool collide = true;
  bool infinite_floor = false;
  double friction = 0.3;
  scene::Look look;
  std::shared_ptr<const character::Coloring> coloring;  ///< from the file of a character; null if there is none
  std::vector<Part> parts;                              ///< of characters
  std::shared_ptr<const Dynamics> dynamics;             ///< of obstacles with a mass; else null
  std::vector<Index> limbs;  ///< of characters: limb of each vertex, from 0; limbs may intersect
  /// A pin that follows a body with bones. For Environment::vertex(), its particles are numbered from `first_vertex`
  /// on, after the vertices of the mesh.
  struct Follower {
    std::size_t cloth = 0, pin = 0, first_vertex = 0;
  };
  std::vector<Follower> followers;
  /// Triangles of the parts that collide, with cuts closed; empty if all parts collide.
  std::vector<mesh::Triangle> colliding;
  std::vector<std::uint8_t> passed_through;  ///< per triangle of the mesh: 1 if it does not collide; empty: all collide
  std::span<const mesh::Triangle> colliding_triangles() const {
    return colliding.empty() ? mesh.topology.triangles : colliding;
  }
};

/// The shape of an obstacle in its own coordinates, and the UVs of its file. Throws as Environment() does.
assets::LoadedMesh mesh_of(const scene::Scene& scene, const scene::Obstacle& obstacle);

/// Rest positions of the particles of a rectangular cloth.
mesh::Grid grid_of(const scene::Cloth& cloth);

/// Throws Error(scene_invalid) if the cells of a rectangle are too uneven for contact with obstacles. make_cloth()
/// calls this, and also checks the triangles of all other cloths.
void check_spacing(const scene::Scene& scene, const scene::Cloth& cloth);

/// Makes a cloth as it starts. Throws Error(asset_unreadable, scene_invalid) with the scene line.
ClothObject make_cloth(const scene::Scene& scene, const scene::Cloth& cloth, Wearers& wearers);

struct Followers;

/// All objects of a scene. Only set_motion() changes their motion, so results for one time stay valid.
class Environment {
 public:
  /// Makes meshes and motions. Throws Error(asset_unreadable, scene_invalid) with file and scene line.
  explicit Environment(const scene::Scene& scene);

  /// A copy with these cloths alone (ascending numbers); motions are shared.
  Environment with_cloths(std::span<const std::size_t> numbers) const;

  /// Writes the positions of all vertices of a body at time t [s]; `positions` has the size of its mesh. Takes time
  /// linear in the vertices, in parallel; allocates nothing. A body that does not move has its pose of time 0.
  void place(std::size_t body, double t, std::span<Vec3> positions) const;

  /// Replaces the motion of an obstacle, which from then on follows nothing. The obstacle must be `moving`, and its
  /// current pose must stay the same.
  void set_motion(std::size_t obstacle, const scene::PoseTrack& motion) {
    movers_[obstacle] = std::make_shared<const Mover>(Track(motion));
    if (!parents_.empty()) parents_[obstacle] = {};
  }

  /// Pose of an obstacle at time t [s], with velocities and accelerations.
  PoseSample pose(std::size_t obstacle, double t) const {
    PoseSample own = std::get<Track>(*movers_[obstacle]).at(t);
    if (parents_.empty() || !parents_[obstacle].is_any()) return own;
    return compose(pose(parents_[obstacle], t), parents_[obstacle].start, own);
  }
  PoseSample pose(const Parent& parent, double t) const {
    return parent.part ? parent.part->at(t) : pose(parent.obstacle, t);
  }

  /// Motion of one vertex of a character, or of a particle that follows it, at time t [s].
  VertexMotion vertex(std::size_t character, std::size_t vertex, double t) const {
    return std::get<KeyFrames>(*movers_[character]).at(t, vertex);
  }

  std::vector<ClothObject> cloths;
  std::vector<BodyObject> bodies;      ///< in the order of scene.obstacles, then of scene.characters
  std::vector<Parent> camera_parents;  ///< one per camera; empty: no camera follows anything

 private:
  using Mover = std::variant<Track, KeyFrames>;
  void add_parents(const scene::Scene& scene);
  void add_part_parents(const scene::Scene& scene, const scene::Character& character, const Followers& followers,
                        const KeyFrames& keys);

  std::vector<std::shared_ptr<const Mover>> movers_;  ///< one per body
  std::vector<Parent> parents_;                       ///< one per obstacle; empty: no obstacle follows anything
};

}  // namespace weft::environment
