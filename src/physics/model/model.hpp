// The simulated model: cloths with their materials, and bodies with their motion. Plain values in SI units, without
// file names and appearance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/types.hpp"
#include "physics/mesh/mesh.hpp"
#include "physics/mesh/rigid_frame.hpp"
#include "physics/mesh/sheet.hpp"
#include "physics/model/air.hpp"
#include "physics/model/contact.hpp"
#include "physics/model/material.hpp"
#include "physics/model/pressure.hpp"
#include "physics/model/rope.hpp"
#include "physics/model/settings.hpp"
#include "physics/motion/key_frames.hpp"
#include "physics/motion/track.hpp"

namespace weft::model {

/// A particle of a cloth to which a pin, an attachment or a weight applies.
struct WeightedParticle {
  Index particle = 0;   ///< index within the cloth
  double fraction = 1;  ///< in (0, 1]: factor on the stiffness of a pin or attachment; relative part of a weight
  bool faded = false;   ///< of a pin: whether the particle is in the fade, a zone around the pin's region in which
                        ///< `fraction` falls to 0
};

/// Particles that are held in place, or moved by keys or with a body.
struct Pin {
  std::vector<WeightedParticle> particles;  ///< first those in its region, then those in its fade
  Vec3 middle{0, 0, 0};                     ///< mean start position of the particles in its region [m]
  motion::PoseTrack motion;                 ///< of `middle`, in the world, if the pin follows no body
  std::optional<std::size_t> body;          ///< number of the body that the pin follows
  /// If `body` has a vertex for each particle of the pin: index of the first particle's vertex, for Model::vertex();
  /// the vertices of the other particles follow in order. Absent: the particles follow the nearest triangles of `body`
  /// if it deforms, or its pose if it is rigid.
  std::optional<std::size_t> first_vertex;
  double release = -1;             ///< time of release [s]; negative: never
  std::optional<double> strength;  ///< stiffness of the spring of a particle [N/m]; absent: held exactly
};

/// Additional mass, distributed over particles in proportion to WeightedParticle::fraction.
struct Weight {
  std::vector<WeightedParticle> particles;
  double mass = 0;  ///< [kg]
};

/// A cloth at the start: a deformable sheet of quads or triangles, or a rope.
struct Cloth {
  std::string name;
  std::string source;    ///< names the cloth in error messages, such as "napkin.toml:3:1: cloth.napkin"
  mesh::Grid grid;       ///< if the cloth is made of quads; for a rope, one row
  mesh::Sheet sheet;     ///< if the cloth is made of triangles, in its own coordinates; else empty
  bool crossed = false;  ///< four triangles per cell, around its centre; CrossedMembrane then prevents membrane locking
  mesh::Mesh mesh;       ///< rest shape in the world, posed as at the start; uv: along weft and warp from a corner [m]
  /// Smallest distance between neighbouring particles of a grid or rope [m]. For triangles, √2 times the smallest
  /// height of a triangle, so that a square of two triangles has the same spacing as a square cell of a grid.
  double spacing = 0;
  Material material;
  std::optional<Rope> rope;
  std::vector<Vec3> start;  ///< positions of its particles [m]
  Vec3 velocity{0, 0, 0};   ///< of all particles at the start [m/s]
  Vec3 spin{0, 0, 0};       ///< angular velocity about the centre of mass, added to `velocity` at the start [rad/s]
  double put_on = 0;        ///< time at which the cloth is put on, since the start of the run, preroll included [s]
  double sewing = 0;        ///< duration of the change of the rest shape from the start shape to flat panels [s]
  std::vector<std::string> over;  ///< names of all cloths that are put on before this one and stay inside it
  bool untangle = false;          ///< whether to move the cloth off surfaces that it touches or crosses at the start
  Pressure pressure;
  std::vector<Pin> pins;
  std::vector<Weight> weights;

  /// Whether the cloth may be moved before its first step: if `untangle` is set, or if it is worn over other cloth.
  bool may_be_untangled() const { return untangle || !over.empty(); }
};

/// Properties of a body that forces move.
struct Dynamics {
  mesh::RigidFrame frame;
  double mass = 0;                 ///< [kg]
  Vec3 velocity{0, 0, 0};          ///< added at `release` to the velocity by its keys [m/s]
  Vec3 angular_velocity{0, 0, 0};  ///< added at `release`, about the centre of mass [rad/s]
  double release = 0;  ///< from this time on, forces move it instead of its keys [s]; minus infinity: always
};

/// Some vertices of a body, with a thickness and friction of their own.
struct Patch {
  std::vector<std::uint8_t> vertices;  ///< one flag per vertex of the body; 1: belongs to the patch
  double thickness = 0;                ///< of padding; the contact distance grows by half of it [m]
  double friction = 0;                 ///< Coulomb coefficient
};

/// The object that a body or camera follows: another body, or a part of a deforming body.
struct Parent {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t body = kNone;                             ///< number of the body
  std::shared_ptr<const motion::Track> part = nullptr;  ///< motion of the part, else null
  motion::Pose start = {};                              ///< pose of the parent at the start of the run

  bool is_any() const { return body != kNone || part; }
};

/// A rigid body moves along a track, a deforming one by key frames of its vertices.
using Mover = std::variant<motion::Track, motion::KeyFrames>;

/// A body that cloth may touch: a rigid obstacle (still, moved by keys or moved by forces), or a body that deforms.
struct Body {
  std::string name;
  mesh::Mesh mesh;  ///< rigid: in its own coordinates; deforming: in the world at time 0
  std::shared_ptr<const Mover> mover;
  Parent parent = {};   ///< its motion since the start of the run is added to that of `mover`; rigid bodies only
  bool moving = false;  ///< whether `mover` or `parent` move it
  bool collide = true;
  bool infinite_floor = false;
  double friction = 0.3;
  std::vector<Patch> patches;
  std::shared_ptr<const Dynamics> dynamics;  ///< of bodies that forces move; else null
  std::vector<Index> limbs;  ///< of deforming bodies: number of the limb of each vertex; limbs may intersect
  /// If only some parts of the mesh collide: their triangles, and triangles that close the cuts between parts.
  std::vector<mesh::Triangle> colliding;
  std::string advice;  ///< appended to the error message if the body touches a surface at the start; empty: none

  bool deforms() const { return std::holds_alternative<motion::KeyFrames>(*mover); }
  std::span<const mesh::Triangle> colliding_triangles() const {
    return colliding.empty() ? mesh.topology.triangles : colliding;
  }
};

/// Springs from particles of a cloth to the nearest points of another cloth or a body: buttons, pegs, tacks.
struct Attachment {
  std::string name;
  std::size_t cloth = 0;  ///< number of the cloth whose particles are attached
  std::vector<WeightedParticle> particles;
  std::optional<std::size_t> to_cloth, to_body;  ///< number of the target; exactly one is given
  double stiffness = 10000;                      ///< stiffness of the spring of a particle with the fraction 1 [N/m]
  std::optional<double> length;                  ///< rest length of the springs [m]; absent: the distance at `begin`
  double begin = -1e5, release = -1;             ///< times between which it acts [s]; negative release: until the end
  std::optional<double> breaking_load;           ///< sum of its spring forces above which it breaks [N]; absent: never
};

/// A layer: cloths that are put on at the same time, over the cloths of the layers before.
struct Layer {
  int first_frame = 0;              ///< frame at which the cloths are put on; negative in the preroll
  std::vector<std::size_t> cloths;  ///< numbers of the cloths of this layer
  std::vector<std::size_t> put_on;  ///< numbers of the cloths of this and all earlier layers, ascending
};

/// Everything that is simulated. The pose of a body at a given time does not change unless set_motion() is called.
struct Model {
  std::string source;  ///< names the scene in error messages: its file
  Vec3 up{0, 0, 1};
  Time time;
  Physics physics;
  std::vector<Fan> fans;
  Solver solver;
  Contact contact;
  std::vector<Cloth> cloths;
  std::vector<Body> bodies;
  std::vector<Attachment> attachments;
  std::vector<Layer> layers;                      ///< of all cloths, from the skin outward; empty: one layer
  std::string start_advice = "move one of them";  ///< what to do if surfaces touch at the start, for the error message
  std::string untangle_advice;  ///< appended to `start_advice` if one of the surfaces is cloth; empty: none

  /// Start of the run, preroll included [s].
  double start_time() const { return -time.preroll_frames / time.fps; }
  /// Whether the air acts on any cloth.
  bool air_acts() const;
  /// Whether Cloth::may_be_untangled() for any cloth.
  bool may_be_untangled() const;

  /// A copy with these cloths only; `numbers`: ascending. It shares the motions of bodies. It has no layers, and no
  /// attachments of or to cloths that are left out.
  Model with_cloths(std::span<const std::size_t> numbers) const;

  /// Writes the positions of all vertices of a body at time t [s]; `positions` has the size of its mesh. Takes time
  /// linear in the number of vertices, in parallel; allocates nothing. A body that does not move has its pose of time 0
  /// at all times.
  void place(std::size_t body, double t, std::span<Vec3> positions) const;

  /// Pose of a rigid body at time t [s], with velocities and accelerations.
  motion::PoseSample pose(std::size_t body, double t) const;
  motion::PoseSample pose(const Parent& parent, double t) const;

  /// Motion at time t [s] of one vertex of a deforming body, or of a point that a pin follows (Pin::first_vertex).
  motion::VertexMotion vertex(std::size_t body, std::size_t vertex, double t) const {
    return std::get<motion::KeyFrames>(*bodies[body].mover).at(t, vertex);
  }

  /// Replaces the motion of a rigid body; the body then follows no parent. The body must be `moving`, and the new
  /// motion must not change its current pose.
  void set_motion(std::size_t body, const motion::PoseTrack& motion);
};

}  // namespace weft::model
