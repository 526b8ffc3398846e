// A model to simulate, built in memory: cloths and bodies as meshes, with materials and motion.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>
#include <weft/frame.hpp>

namespace weft {

struct Mesh {
  std::vector<Vector> positions{};    ///< of the vertices [m]
  std::vector<Triangle> triangles{};  ///< in a cloth, each edge must belong to one or two triangles
};

/// A fabric as a continuum: its values do not depend on the mesh. The defaults are those of cotton.
struct Material {
  double density = 0.15;         ///< [kg/m²]
  double stretch_weft = 800;     ///< stiffness along weft [N/m]
  double stretch_warp = 2100;    ///< stiffness along warp [N/m]
  double shear = 130;            ///< twice the shear modulus of linear elasticity [N/m]
  double bend = 1e-5;            ///< bending stiffness [N·m]
  double max_stretch = 0.1;      ///< relative extension at which threads lock (stiffen); 0: never
  double max_shear = 0;          ///< deviation of the angle between weft and warp from 90° at which
                                 ///< threads lock [degrees]; 0: never
  double stretch_viscosity = 0;  ///< force per width and strain rate, along weft and along warp [N·s/m]
  double shear_viscosity = 0;    ///< force per width and rate of shear [N·s/m]
  double bend_viscosity = 1e-6;  ///< moment per width and rate of curvature [N·m·s]
  double bend_friction = 5e-4;   ///< moment per width against a change of curvature [N]
  double thickness = 0.002;      ///< distance at which two layers of this fabric begin to push each
                                 ///< other [m]; limited to a quarter of the particle spacing
  double friction = 0.3;         ///< Coulomb coefficient; a contact uses the geometric mean of both coefficients
  double drag = 1;               ///< drag coefficient, for motion normal to the cloth; 0: no air resistance
};

/// A sheet of triangles. Its particles are the vertices of the mesh.
struct Cloth {
  std::string name{};
  Mesh mesh{};  ///< shape at the start
  /// Rest coordinates of each particle: its place in the flat fabric, along weft and warp [m]. If
  /// `rest` is empty, the mesh is the rest shape, and the weft of each triangle runs along the
  /// projection of the x axis onto the triangle. If the triangle is nearly perpendicular to the x
  /// axis, the warp runs along the projection of the y axis instead.
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
  double time = 0;  ///< [s]; at least 1e-7 s after the key before
  Pose pose{};
};

/// A rigid body that cloth may touch.
struct Body {
  std::string name{};
  Mesh mesh{};                  ///< in the coordinates of the body; must be closed, with triangles that
                                ///< face the same way and no walls inside, if the body has a mass
  Pose pose{};                  ///< pose at the start, if there are no keys
  std::vector<PoseKey> keys{};  ///< poses through which the body moves smoothly; must be empty if it has a mass
  double mass = 0;              ///< [kg]; if above 0, forces move the body; if 0, keys or Simulation::move() do
  Vector velocity{0, 0, 0};     ///< velocity at the start, of a body with a mass [m/s]
  double friction = 0.3;        ///< Coulomb coefficient
  bool collide = true;          ///< false: nothing touches the body, but pins can follow it
};

/// Holds particles of a cloth in place, or moves them with a body. A particle can be in one pin only.
struct Pin {
  std::string cloth{};
  std::vector<int> particles{};  ///< indices
  std::string body{};            ///< body without mass that they follow; empty: they stay in place
  double release = std::numeric_limits<double>::infinity();  ///< time from which the particles are free [s]
};

enum class Method { implicit_euler, implicit_midpoint, bdf2 };

/// A model to simulate. No two cloths or bodies may have the same name. A Simulation copies the
/// model.
struct Model {
  double fps = 25;  ///< frames per second
  /// Maximum time step [s]: a frame is divided into the fewest equal steps that are not longer.
  /// Exception: with implicit Euler, a frame in which everything rests may be one step.
  double step = 0.01;
  Method method = Method::implicit_euler;
  double newton_tolerance = 0.4;  ///< error that the solver may leave in a step, relative to the
                                  ///< local truncation error, with a visibility threshold as floor
  Vector gravity{0, 0, -9.81};    ///< [m/s²]
  Vector wind{0, 0, 0};           ///< velocity of the air [m/s]
  double air_density = 1.2;       ///< [kg/m³]; 0: no air
  bool self_contact = true;       ///< contact of cloth with itself and with other cloths
  std::vector<Cloth> cloths{};
  std::vector<Body> bodies{};
  std::vector<Pin> pins{};
};

}  // namespace weft
