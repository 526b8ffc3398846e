// A model to simulate, built in memory: cloths and bodies as meshes, with materials and motion.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>
#include <weft/frame.hpp>

namespace weft {

struct Mesh {
  std::vector<Vector> positions{};    ///< per vertex [m]
  std::vector<Triangle> triangles{};  ///< in a cloth, each edge must belong to one or two triangles
};

/// A fabric as a continuum: stiffnesses do not depend on the mesh. The defaults are those of cotton.
struct Material {
  double density = 0.15;       ///< [kg/m²]
  double stretch_weft = 800;   ///< stiffness along weft [N/m]
  double stretch_warp = 2100;  ///< stiffness along warp [N/m]
  double shear = 130;          ///< [N/m]
  double bend = 1e-5;          ///< bending stiffness [N·m]
  double max_stretch = 0.1;    ///< relative extension at which threads lock (stiffen); 0: never
  double max_shear = 0;        ///< change of the angle between weft and warp at which threads lock [degrees]; 0: never
  double stretch_viscosity = 0;  ///< [N·s/m]
  double shear_viscosity = 0;    ///< [N·s/m]
  double bend_viscosity = 1e-6;  ///< [N·m·s]
  double bend_friction = 5e-4;   ///< minimum moment per width that changes the curvature [N]
  double thickness = 0.002;      ///< distance at which two layers of this fabric begin to push each other [m]
  double friction = 0.3;         ///< Coulomb coefficient; a contact uses the geometric mean of both coefficients
  double drag = 1;               ///< air resistance coefficient, for motion normal to the cloth; 0: none
};

/// A sheet of triangles. Its particles are the vertices of the mesh.
struct Cloth {
  std::string name{};
  Mesh mesh{};  ///< shape at the start
  /// Rest coordinates of each particle: its place in the flat fabric, along weft and warp [m]. If `rest` is empty, the
  /// mesh is the rest shape, and the weft of each triangle runs along the projection of the x axis onto the triangle
  /// (but if the triangle is nearly perpendicular to this axis, the warp runs along the projection of the y axis).
  std::vector<RestPoint> rest{};
  Material material{};
  Vector velocity{0, 0, 0};  ///< of all particles at the start [m/s]
};

/// Pose of a body: a rotation about the origin of its coordinates, then a translation.
struct Pose {
  Vector position{0, 0, 0};                    ///< [m]
  std::array<double, 4> rotation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z
};

struct PoseKey {
  double time = 0;  ///< [s]; later than the time of the key before
  Pose pose{};
};

/// A rigid body that cloth may touch.
struct Body {
  std::string name{};
  Mesh mesh{};                  ///< in the coordinates of the body; must be closed if the body has a mass
  Pose pose{};                  ///< pose at the start; a body without mass and keys keeps it
  std::vector<PoseKey> keys{};  ///< poses through which the body moves smoothly; unless empty, `pose` is ignored
  double mass = 0;              ///< [kg]; if it is above 0, forces move the body
  Vector velocity{0, 0, 0};     ///< velocity at the start, of a body with a mass [m/s]
  double friction = 0.3;        ///< Coulomb coefficient
  bool collide = true;          ///< false: nothing touches the body, but pins can follow it
};

/// Holds particles of a cloth in place, or moves them with a body. A particle can be in one pin only.
struct Pin {
  std::string cloth{};
  std::vector<int> particles{};                              ///< indices
  std::string body{};                                        ///< body without mass to follow; empty: stay in place
  double release = std::numeric_limits<double>::infinity();  ///< time from which the particles are free [s]
};

enum class Method { implicit_euler, implicit_midpoint, bdf2 };

/// A model to simulate. All names of cloths and bodies must be different. A Simulation copies the model.
struct Model {
  double fps = 25;     ///< frames per second
  double step = 0.01;  ///< maximum time step [s]; a frame is divided into equal steps that are not longer
  Method method = Method::implicit_euler;
  double newton_tolerance = 0.4;  ///< maximum error of the solver, relative to the local truncation error
  Vector gravity{0, 0, -9.81};    ///< [m/s²]
  Vector wind{0, 0, 0};           ///< velocity of the air [m/s]
  double air_density = 1.2;       ///< [kg/m³]; 0: no air
  bool self_contact = true;       ///< contact of cloth with itself and with other cloths
  std::vector<Cloth> cloths{};
  std::vector<Body> bodies{};
  std::vector<Pin> pins{};
};

}  // namespace weft
