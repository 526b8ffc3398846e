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
  double fraction = 1;  ///< in (0, 1]. Pin with a strength, attachment: factor on the stiffness of
                        ///< the particle's spring. Weight: the additional mass of the particle is
                        ///< proportional to it.
  bool faded = false;   ///< pin: whether the particle is in the fade, a zone around the pin's
                        ///< region in which `fraction` falls to 0
};

/// Particles that are held in place, moved by keys, or moved with a body.
struct Pin {
  std::vector<WeightedParticle> particles;  ///< first those in the pin's region, then those in its fade
  Vec3 middle{0, 0, 0};                     ///< mean start position of the particles in the region [m]
  motion::PoseTrack motion;                 ///< without `body`: motion of `middle` in the world;
                                            ///< without keys, the particles stay in place
  std::optional<std::size_t> body;          ///< number of the body that the pin follows; absent: none
  /// The key frames of `body` may include one point for each particle of the pin, in order. Then
  /// this is the number of the first point, for Model::vertex(). Absent: if `body` deforms, each
  /// particle follows the nearest triangle of `body`; if `body` is rigid, all follow its pose.
  std::optional<std::size_t> first_vertex;
  double release = -1;             ///< time of release [s]; negative: never
  std::optional<double> strength;  ///< stiffness of the spring of a particle with the fraction 1
                                   ///< [N/m]; absent: the particles are held exactly
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
  mesh::Grid grid;       ///< used for cloth of quads; for a rope, one row
  mesh::Sheet sheet;     ///< for cloth of triangles, in coordinates of its own; else empty
  bool crossed = false;  ///< true: the sheet has cells of four triangles around their centre, for
                         ///< which CrossedMembrane prevents membrane locking
  mesh::Mesh mesh;       ///< in the world; its positions are the rest shape, unless `sheet.sewn`.
                         ///< uv: rest coordinates along weft and warp [m]
  /// Smallest distance between neighbouring particles of a grid or rope at rest [m]. For triangles,
  /// √2 times the smallest height of a triangle at rest, so that a square of two triangles has the
  /// same spacing as a square cell of a grid.
  double spacing = 0;
  Material material;
  std::optional<Rope> rope;
  std::vector<Vec3> start;        ///< start positions of its particles [m]
  Vec3 velocity{0, 0, 0};         ///< of all particles at the start [m/s]
  Vec3 spin{0, 0, 0};             ///< angular velocity at the start, about the centre of mass; its
                                  ///< velocities are added to `velocity` [rad/s]
  double put_on = 0;              ///< time at which the cloth is put on, counted from Model::start_time() [s]
  double sewing = 0;              ///< if `sheet.sewn`: time, from `put_on` on, in which the rest shape
                                  ///< changes from the start shape to the flat panels [s]
  std::vector<std::string> over;  ///< names of all cloths over which this one is worn, directly or through others
  bool untangle = false;          ///< whether to move the cloth off surfaces that it touches or crosses at the start
  Pressure pressure;
  std::vector<Pin> pins;
  std::vector<Weight> weights;

  /// Whether the start may move the cloth off other surfaces: if `untangle` is set, or if the cloth
  /// is worn over other cloth.
  bool may_be_untangled() const { return untangle || !over.empty(); }
};

/// Properties of a body that forces move.
struct Dynamics {
  mesh::RigidFrame frame;
  double mass = 0;                 ///< [kg]
  Vec3 velocity{0, 0, 0};          ///< added at `release` to the velocity that the body's keys give [m/s]
  Vec3 angular_velocity{0, 0, 0};  ///< likewise, about the centre of mass [rad/s]
  double release = 0;              ///< time from which forces move the body [s]; until then, Body::mover
                                   ///< moves it; minus infinity: forces always move it
};

/// Some vertices of a body, with a thickness and friction of their own.
struct Patch {
  std::vector<std::uint8_t> vertices;  ///< one flag per vertex of the body; 1: belongs to the patch
  double thickness = 0;                ///< of padding [m]; the contact distance grows by half of it
  double friction = 0;                 ///< Coulomb coefficient
};

/// The object that a body or camera follows: a rigid body, a part of a deforming body, or none.
struct Parent {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t body = kNone;                             ///< number of the rigid body; kNone: none
  std::shared_ptr<const motion::Track> part = nullptr;  ///< motion of the part; null: none
  motion::Pose start = {};                              ///< pose of the parent at the start of the run

  bool is_any() const { return body != kNone || part; }
};

/// Motion of a rigid body (a track of poses) or of a deforming body (key frames of its vertices).
using Mover = std::variant<motion::Track, motion::KeyFrames>;

/// A body that cloth may touch: a rigid body (still, moved by keys or moved by forces) or a
/// deforming body.
struct Body {
  std::string name;
  mesh::Mesh mesh;  ///< rigid: in its own coordinates; deforming: in the world at time 0
  std::shared_ptr<const Mover> mover;
  Parent parent = {};     ///< rigid bodies only: the parent's motion since the start of the run is
                          ///< applied in addition to that of `mover`
  bool may_move = false;  ///< whether `mover`, `parent` or Model::set_motion() may move the body
  bool collide = true;
  bool infinite_floor = false;
  double friction = 0.3;
  std::vector<Patch> patches;
  std::shared_ptr<const Dynamics> dynamics;  ///< if forces move the body; else null
  std::vector<Index> limbs;  ///< deforming bodies: number of the limb of each vertex; limbs may intersect
  /// If only some parts of the mesh collide: their triangles, and triangles that close the cuts
  /// between them and the other parts. Empty: all triangles collide.
  std::vector<mesh::Triangle> colliding;
  std::string advice;  ///< appended to the error message if the body touches a surface at the start; may be empty

  bool deforms() const { return std::holds_alternative<motion::KeyFrames>(*mover); }
  std::span<const mesh::Triangle> colliding_triangles() const {
    return colliding.empty() ? mesh.topology.triangles : colliding;
  }
};

/// Springs from particles of a cloth to those points of another cloth or a body that are nearest at
/// `begin`: buttons, pegs, tacks. A spring shorter than its rest length is slack.
struct Attachment {
  std::string name;
  std::size_t cloth = 0;  ///< number of the cloth whose particles are attached
  std::vector<WeightedParticle> particles;
  std::optional<std::size_t> to_cloth, to_body;  ///< number of the target; exactly one of the two is given
  double stiffness = 10000;                      ///< stiffness of the spring of a particle with the fraction 1 [N/m]
  std::optional<double> length;                  ///< rest length of the springs [m]; absent: for
                                                 ///< each spring, the distance between its ends
                                                 ///< at `begin`
  double begin = -1e5, release = -1;    ///< times between which the springs act [s]; negative release: until the end
  std::optional<double> breaking_load;  ///< sum of the spring forces above which all springs break [N]; absent: never
};

/// Cloths that are put on at the same time, over the cloths of the layers before.
struct Layer {
  int first_frame = 0;              ///< frame at which the cloths are put on; negative: in the preroll
  std::vector<std::size_t> cloths;  ///< numbers of the cloths of this layer
  std::vector<std::size_t> put_on;  ///< numbers of the cloths of this and all earlier layers, ascending
};

/// Everything that is simulated. The pose of a body at a given time changes only by set_motion().
struct Model {
  std::string source;  ///< names the scene in error messages: its file
  Vec3 up{0, 0, 1};    ///< unit vector
  Time time;
  Physics physics;
  std::vector<Fan> fans;
  Solver solver;
  Contact contact;
  std::vector<Cloth> cloths;
  std::vector<Body> bodies;
  std::vector<Attachment> attachments;
  std::vector<Layer> layers;                      ///< all cloths, from the skin outward; empty: one layer
  std::string start_advice = "move one of them";  ///< what to do if surfaces touch at the start; for the error message
  std::string untangle_advice;  ///< appended to `start_advice` if one of the surfaces is cloth; may be empty

  /// Time at which the run starts: that of frame 0, or the start of the preroll [s].
  double start_time() const { return -time.preroll_frames / time.fps; }
  /// Whether the air has a density and some cloth has a drag coefficient above 0.
  bool air_acts() const;
  /// Whether Cloth::may_be_untangled() for any cloth.
  bool may_be_untangled() const;

  /// A copy with only the cloths of these numbers, which must ascend. The copy shares the motions
  /// of bodies. It has no layers, and no attachments of or to cloths that are left out.
  Model with_cloths(std::span<const std::size_t> numbers) const;

  /// Writes the positions of all vertices of a body at time t [s]; `positions` has the size of its
  /// mesh. For a body without Body::may_move, writes the positions of time 0. For a body that forces
  /// move, writes where `mover` places it. Takes time linear in the number of vertices, in
  /// parallel; allocates nothing.
  void place(std::size_t body, double t, std::span<Vec3> positions) const;

  /// Pose of a rigid body or of a parent at time t [s], with velocities and accelerations.
  motion::PoseSample pose(std::size_t body, double t) const;
  motion::PoseSample pose(const Parent& parent, double t) const;

  /// Motion at time t [s] of one vertex of a deforming body, or of a point that a particle of a pin
  /// follows (Pin::first_vertex).
  motion::VertexMotion vertex(std::size_t body, std::size_t vertex, double t) const {
    return std::get<motion::KeyFrames>(*bodies[body].mover).at(t, vertex);
  }

  /// Replaces the motion of a rigid body; the body then follows no parent. Body::may_move must be
  /// true, and the new motion must not change the current pose of the body.
  void set_motion(std::size_t body, const motion::PoseTrack& motion);
};

}  // namespace weft::model
