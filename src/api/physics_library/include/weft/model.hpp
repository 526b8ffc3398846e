// A model to simulate, made in memory: cloths and bodies as meshes, with materials and motion.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>
#include <weft/frame.hpp>

namespace weft {

struct Mesh {
  std::vector<Vector> positions{};    ///< per vertex [m]
  std::vector<Triangle> triangles{};  ///< counter-clockwise seen from the front; each edge of a cloth has one or two
};

/// A fabric in continuum units; the defaults are cotton.
struct Material {
  double density = 0.15;         ///< [kg/m²]
  double stretch_weft = 800;     ///< stiffness along weft [N/m]
  double stretch_warp = 2100;    ///< stiffness along warp [N/m]
  double shear = 130;            ///< [N/m]
  double bend = 1e-5;            ///< bending stiffness [N·m]
  double max_stretch = 0.1;      ///< extension at which threads lock [1]; 0: never
  double max_shear = 0;          ///< change of the weft-warp angle at which threads lock [degrees]; 0: never
  double stretch_viscosity = 0;  ///< [N·s/m]
  double shear_viscosity = 0;    ///< [N·s/m]
  double bend_viscosity = 1e-6;  ///< [N·m·s]
  double bend_friction = 5e-4;   ///< moment per width that must be overcome to change the curvature [N]
  double thickness = 0.002;      ///< contact distance between two layers [m]
  double friction = 0.3;         ///< Coulomb coefficient; a contact uses the geometric mean of both objects
  double drag = 1;               ///< air resistance coefficient, for motion normal to the cloth; 0: none
};

/// A sheet of triangles. Its particles are the vertices.
struct Cloth {
  std::string name{};
  Mesh mesh{};  ///< shape at the start
  /// Per particle: its place in the flat fabric, along weft and warp [m]. If empty, the mesh is the rest shape, and the
  /// weft of each triangle runs along the projection of the x axis onto it.
  std::vector<RestPoint> rest{};
  Material material{};
  Vector velocity{0, 0, 0};  ///< of all particles at the start [m/s]
};

/// Pose of a body: a rotation about its origin, then a translation.
struct Pose {
  Vector position{0, 0, 0};                    ///< [m]
  std::array<double, 4> rotation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z
};

struct PoseKey {
  double time = 0;  ///< [s], strictly increasing
  Pose pose{};
};

/// A rigid body that cloth may touch.
struct Body {
  std::string name{};
  Mesh mesh{};                  ///< in its own coordinates; closed if forces move it
  Pose pose{};                  ///< where it stays, or starts if forces move it
  std::vector<PoseKey> keys{};  ///< poses through which it moves smoothly, in place of `pose`; empty: none
  double mass = 0;              ///< [kg]; above 0, forces move it
  Vector velocity{0, 0, 0};     ///< at the start, if forces move it [m/s]
  double friction = 0.3;
  bool collide = true;  ///< false: no contact; pins can still follow the body
};

/// Holds particles of a cloth where they start, or at a body. A particle can be in one pin only.
struct Pin {
  std::string cloth{};
  std::vector<int> particles{};
  std::string body{};                                        ///< body without mass that they follow; empty: they stay
  double release = std::numeric_limits<double>::infinity();  ///< time from which they are free [s]
};

enum class Method { implicit_euler, implicit_midpoint, bdf2 };

/// A model that a Simulation copies. Names differ from each other.
struct Model {
  double fps = 25;     ///< frames per second
  double step = 0.01;  ///< maximum time step [s]; each frame is divided into equal steps no longer than this
  Method method = Method::implicit_euler;
  double newton_tolerance = 0.4;  ///< error that the solver may leave, relative to the local truncation error
  Vector gravity{0, 0, -9.81};    ///< [m/s²]
  Vector wind{0, 0, 0};           ///< velocity of the air [m/s]
  double air_density = 1.2;       ///< [kg/m³]; 0: no air
  bool self_contact = true;       ///< of cloth with itself and other cloths
  std::vector<Cloth> cloths{};
  std::vector<Body> bodies{};
  std::vector<Pin> pins{};
};

}  // namespace weft
