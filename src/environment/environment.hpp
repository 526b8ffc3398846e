// All objects of a scene now (seed, Fig. 1): topology, geometry, positions, velocities, accelerations.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "environment/track.hpp"
#include "mesh/mesh.hpp"
#include "mesh/sheet.hpp"
#include "scene/scene.hpp"

namespace weft::environment {

/// State of the vertices of one object in world space.
struct Motion {
  std::vector<Vec3> positions;      ///< [m]
  std::vector<Vec3> velocities;     ///< [m/s]
  std::vector<Vec3> accelerations;  ///< [m/s²]
};

/// A deformable sheet, of quads or of triangles. The solver owns the truth while it steps and writes it back here.
struct ClothObject {
  std::string name;
  mesh::Grid grid;              ///< of quads
  mesh::Sheet sheet;            ///< of triangles, in the cloth's own coordinates; empty for quads
  mesh::Mesh mesh;              ///< rest shape in the world pose of the start; uv: weft and warp from its corner
  std::vector<Vec2> fractions;  ///< place of each particle in fractions of the rest size along weft and warp
  /// Least distance between particles of a grid [m]; of triangles √2 times the least height, which is the same for the
  /// two halves of a square.
  double spacing = 0;
  Motion motion;
};

/// A rigid body, still or moved by key frames.
struct RigidObject {
  std::string name;
  mesh::Mesh mesh;  ///< in the body's own coordinates; shapes already turned to the scene's up axis
  bool moving = false;
  bool collide = true;
  bool infinite_floor = false;
  Motion motion;
};

/// Rest places of the particles of a rectangle of cloth.
mesh::Grid grid_of(const scene::Cloth& cloth);

class Environment {
 public:
  /// Makes meshes and the state at time 0. Throws Error(asset_unreadable) naming file and scene line.
  explicit Environment(const scene::Scene& scene);

  /// Puts the moving rigid objects where they are at time t [s], with exact velocities and accelerations. Linear in the
  /// vertices of moving objects; allocates nothing.
  void move_to(double t);

  /// Pose of rigid object `rigid` at any time [s], whatever the last move_to was.
  PoseSample pose(std::size_t rigid, double t) const { return tracks_[rigid].at(t); }

  std::vector<ClothObject> cloths;
  std::vector<RigidObject> rigids;  ///< in the order of scene.obstacles

 private:
  std::vector<Track> tracks_;  ///< one per rigid
};

}  // namespace weft::environment
