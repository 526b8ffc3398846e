// A checked scene: plain values with all defaults. Units are SI units unless another unit is given. A "key frame" is a
// value at one time; a "key" alone is a key of the TOML text.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/threads.hpp"
#include "core/types.hpp"
#include "film/scene/camera.hpp"
#include "film/scene/shapes.hpp"
#include "physics/integrator/method.hpp"
#include "physics/model/air.hpp"
#include "physics/model/contact.hpp"
#include "physics/model/material.hpp"
#include "physics/model/pressure.hpp"
#include "physics/model/rope.hpp"
#include "physics/model/settings.hpp"
#include "physics/motion/pose.hpp"

namespace weft::scene {

// Types of the physics that scenes use unchanged.
using Integrator = integrator::Method;
using model::Bounds;
using model::Contact;
using model::Fan;
using model::FanKey;
using model::FrictionPair;
using model::Gusts;
using model::Material;
using model::Physics;
using model::PhysicsKey;
using model::Pressure;
using model::PressureControl;
using model::PressureKey;
using model::Response;
using model::RopeKey;
using model::Search;
using model::Solver;
using model::TreeKind;
using motion::change_of_angles;
using motion::Interpolation;
using motion::Pose;
using motion::PoseKey;
using motion::PoseTrack;

inline constexpr int kMaxFrames = 100'000;  ///< maximum of duration * fps

enum class UpAxis { y, z };

/// The unit vector along the up axis.
inline Vec3 up_vector(UpAxis up) {
  return up == UpAxis::z ? Vec3::UnitZ() : Vec3::UnitY();
}

enum class HeatQuantity { none, strain, speed };

/// Length of the film, frame rate and time steps.
struct Time {
  double duration = 5;  ///< [s]; the scene has round(duration * fps) + 1 frames
  double fps = 25;      ///< frames per second
  double preroll = 0;   ///< time simulated before frame 0 and not shown [s]
  double step = 0.01;   ///< maximum time step [s]; see model::Time::step
  /// Allowed local error of positions per step [m]. If present, the step length follows from it, else from `step`.
  std::optional<double> tolerance = std::nullopt;
  Integrator integrator = Integrator::implicit_euler;
};

/// Colours and picture of an object or of a panel of a cloth. On cloth, the picture is aligned with weft and warp.
struct Paint {
  Vec3 color{0.8, 0.8, 0.8};                   ///< sRGB
  std::optional<Vec3> back_color;              ///< back of cloth, sRGB; absent: that of the front, paler
  std::optional<std::filesystem::path> image;  ///< PNG, JPEG or TGA; absolute path
  double image_width = 0.2;                    ///< width of one tile along weft [m]; the height keeps the proportions
  Vec2 image_offset{0, 0};                     ///< position of the lower left corner of a tile along weft and warp [m]
  double image_rotation = 0;                   ///< rotation about that corner, counter-clockwise [degrees]
  bool image_repeat = true;                    ///< false: one tile, with `color` around it, or a hole if `cutout`
  bool cutout = false;                         ///< true: transparent parts are holes; false: they show `color`
};

/// The colours of one panel of a pattern.
struct PanelPaint : Paint {
  std::string name;
};

/// Reflection properties of cloth besides colour, each from 0 to 1; see frame::Finish.
struct Finish {
  double gloss, warp_fraction, fuzz, sheer;
  Threads threads = Threads::plain;
};

/// How an object is drawn.
struct Look : Paint {
  std::vector<PanelPaint> panels;  ///< colours of panels that differ from those of the cloth
  bool as_file = true;             ///< characters: colours and pictures of their file are used, if there are any
  double roughness = 0.6;
  std::optional<double> gloss;        ///< cloth: gloss of the threads (absent: that of the fabric);
                                      ///< obstacles: strength of a clear coat (absent: 0)
  std::optional<double> fuzz, sheer;  ///< cloth only, see Finish; absent: those of the fabric
  double metal = 0;                   ///< obstacles only: 0 no metal, 1 metal, which reflects in its own colour
  std::optional<double> tile_width;   ///< obstacles only: width of one tile [m]; absent: one tile covers the shape
  double warp_fraction = 0.5;         ///< of the fabric: fraction of warp among the threads on top
  Threads threads = Threads::plain;   ///< of the fabric: pattern of the drawn threads
  double cloth_thickness = 0;         ///< thickness of the fabric, not its contact thickness; ropes: diameter [m]
  double thread_spacing = 0.0006;     ///< cloth only: spacing of the drawn threads [m]; 0: no threads are drawn
  std::optional<double> hem;  ///< cloth only: width of drawn hems [m]; 0: none; absent: depends on fabric and shape
  bool checker = false;       ///< infinite planes only: faint grid of 0.5 m tiles
  bool strands = true;        ///< ropes only: drawn with twisted strands
  bool visible = true;
};

/// Key frame of a pin: the pose in which the pin holds its particles at one time. The particles rotate about their
/// centroid.
struct PinKey {
  double time = 0;  ///< [s], strictly increasing
  Pose pose;        ///< its position: the displacement of the centroid or, if `in_world`, the centroid
  bool in_world = false;
};

/// The motion of the particles of a pin.
struct PinTrack {
  Interpolation interpolation = Interpolation::cubic;
  std::vector<PinKey> keys;  ///< empty: the particles keep their start positions
};

enum class VertexColor { none, red, green, blue, brightness };

/// A part of a cloth: the particles between the corners `low` and `high`, in fractions of the size of the cloth along
/// weft and warp. For a mesh, this size is the extent along x and y before the pose is applied. `mask`, `vertex_color`
/// and `vertex_group` each give a particle a fraction from 0 to 1, which is the strength of the effect on the particle.
/// If several of them are given, their fractions are multiplied.
struct ClothPart {
  std::string panel;  ///< pattern: only this panel, to which low, high and mask then refer; empty: all panels
  Vec2 low{0, 0}, high{1, 1};
  std::optional<Vec2> at = {};  ///< rope: both ends of the part, in fractions of its length; replaces low and high
  std::string edge;             ///< pattern: only this edge, as "panel.edge"; empty: no such limit
  std::optional<std::filesystem::path> mask;     ///< picture whose grey values are fractions; absolute path
  VertexColor vertex_color = VertexColor::none;  ///< mesh: colour channel that gives fractions
  std::string vertex_group;  ///< mesh: vertex group or bone whose weights are fractions; empty: none

  /// Whether a particle at the fractions (u, v) is between `low` and `high`. With the tolerance kRoundoff, the part
  /// contains particles at a bound that the scene gives with nine digits, such as 0.333333333.
  bool holds(double u, double v) const {
    return u >= low.x() - kRoundoff && u <= high.x() + kRoundoff && v >= low.y() - kRoundoff &&
           v <= high.y() + kRoundoff;
  }
};

/// A pin: particles of a cloth that are held in place or moved.
struct Pin : ClothPart {
  std::string follow;              ///< body or "<character>.<part>" with which the particles move; empty: none
  PinTrack motion;                 ///< used if `follow` is empty
  double release = -1;             ///< time of release [s]; negative: never
  std::optional<double> strength;  ///< stiffness of the spring of a particle with fraction 1 [N/m];
                                   ///< absent: particles with a fraction of at least 0.5 are held
                                   ///< exactly
  /// Distance from the part, along the cloth at rest, over which the pull on the particles around the part falls to 0
  /// [m]; needs `strength`.
  double fade = 0;
};

/// The two names in a `follow`: name of the body, and name of the part of a character (empty if there is none).
struct Followed {
  std::string body, part;
};
inline Followed followed(const std::string& follow) {
  const std::size_t dot = follow.find('.');
  return {follow.substr(0, dot), dot == std::string::npos ? "" : follow.substr(dot + 1)};
}

/// Additional mass, distributed over the particles of a part in proportion to their fractions.
struct Weight : ClothPart {
  double mass = 0.1;  ///< [kg]
};

/// Springs between particles of a cloth and points of another cloth or body, such as buttons, pegs and tacks.
struct Attachment : ClothPart {
  std::string name, cloth, to;        ///< `to`: the other cloth, rope or body
  double stiffness = 10000;           ///< of the spring of a particle with fraction 1 [N/m]
  std::optional<double> length;       ///< rest length of the springs [m]; absent: the distance of their ends at `begin`
  double begin = -1e5, release = -1;  ///< times between which the springs act [s]; negative release: until the end
  std::optional<double> breaking_load;  ///< sum of the spring forces above which all springs break [N]; absent: never
};

/// Action if the cloth touches or crosses surfaces at the start: the scene is refused (as_given), or the cloth is moved
/// off the surfaces (untangle).
enum class ClothStart { as_given, untangle };
/// `quads`, `aligned_triangles` and `crossed_triangles` are rectangles of cloth with different meshes.
enum class ClothShape { quads, aligned_triangles, crossed_triangles, mesh, pattern, rope };
/// Source of the rest shape of a mesh. `automatic`: the UVs if they are panels of cloth (UvRest), else the mesh.
enum class ClothRest { automatic, mesh, uv };

struct Rope;

/// A sheet of cloth, or the one-dimensional cloth of a rope.
struct Cloth {
  std::string name;
  ClothShape shape = ClothShape::quads;
  Vec2 size{1, 1};                               ///< rectangles: size along weft and warp [m]
  int particles_weft = 41, particles_warp = 41;  ///< rectangles; crossed_triangles have one more per cell
  Vec2 grading{1, 1};                            ///< rectangles: ratio of the last to the first spacing of particles
  std::filesystem::path file;                    ///< mesh or sewing pattern; absolute path
  double scale = 1;                              ///< mesh, pattern: factor on all lengths of the file
  FileUp up = FileUp::as_file;                   ///< mesh: up axis of the file
  std::string object;                            ///< mesh: name of the object in the file; empty: all objects
  ClothRest rest = ClothRest::automatic;         ///< mesh: source of the rest shape
  std::optional<Vec2> uv_scale;                  ///< mesh: metres per unit of the UVs; absent: fitted to the mesh
  double edge_length = 0.02;                     ///< pattern: edge length of its mesh [m]
  std::string wearer;                            ///< pattern: character that wears it; empty: the only character
  bool fit = false;                              ///< pattern: scale it to the wearer's measures
  double sewing = 1;                             ///< mesh, pattern: time in which the rest shape changes from the start
                                                 ///< shape to the flat panels [s]
  int line = 0, column = 0;                      ///< place in the scene file, for error messages
  Pose pose;               ///< of the middle of a rectangle (weft along x, warp along y), or of the origin of a file
  Vec3 velocity{0, 0, 0};  ///< at the start [m/s]
  Vec3 spin{0, 0, 0};      ///< angular velocity at the start, about the centre of mass [degrees/s]
  Vec2 start_scale{1, 1};  ///< ratio of the lengths at the start to those at rest, along weft and warp
  std::optional<ClothStart> start;  ///< absent: see starts_untangled()
  std::vector<std::string> over;    ///< names of the cloths directly below this cloth
  double start_noise = 0;           ///< maximum random displacement of a particle at the start, along each axis [m]
  Material material;
  Pressure pressure;
  Look look;
  std::vector<Pin> pins;
  std::vector<Weight> weights;
  std::shared_ptr<const Rope> rope;  ///< the rope for which this cloth is simulated; null: a sheet
};

/// Whether the cloth is moved off surfaces that it touches or crosses at the start. The default is true for patterns,
/// because the program, not the scene, places their panels. (Cloth worn `over` other cloth is always moved off that
/// cloth.)
inline bool starts_untangled(const Cloth& cloth) {
  return cloth.start ? *cloth.start == ClothStart::untangle : cloth.shape == ClothShape::pattern;
}

/// Number of particles of a rectangle of cloth; 0 for other shapes.
inline long rectangle_particles(const Cloth& cloth) {
  const long u = cloth.particles_weft, v = cloth.particles_warp;
  if (cloth.shape > ClothShape::crossed_triangles) return 0;
  return u * v + (cloth.shape == ClothShape::crossed_triangles ? (u - 1) * (v - 1) : 0);
}

/// A thin chain of particles, simulated as a one-dimensional cloth; see as_cloth() (ropes.hpp).
struct Rope {
  std::string name;
  std::vector<Vec3> points;      ///< points through which the rope passes at the start [m]
  std::optional<Vec3> from, to;  ///< ends of a rope without points [m]
  bool smooth = false;           ///< true: a smooth curve through the points; false: straight between them
  bool closed = false;           ///< true: the last point is joined to the first
  std::optional<double> length;  ///< rest length [m]; absent: that of the first key or, without keys, of the start path
  Interpolation interpolation = Interpolation::cubic;  ///< between `keys`
  std::vector<RopeKey> keys;                           ///< key frames of the rest length; empty: it is constant
  std::optional<int> segments;                         ///< number of pieces; absent: depends on length and diameter
  double diameter = 0.008;                             ///< contact diameter [m]
  int material = 0;                                    ///< index into rope_materials()
  std::optional<double> mass, stretch, bend;           ///< mass per length [kg/m], EA [N], EI [N·m²];
                                                       ///< absent: those of the material
  double damping = 0.01;                               ///< viscosity of stretch and bending / their stiffness [s]
  double friction = 0.3;   ///< Coulomb coefficient; a contact uses the geometric mean of both coefficients
  double drag = 1.1;       ///< drag coefficient of a cylinder, for motion across the rope
  Vec3 velocity{0, 0, 0};  ///< at the start [m/s]
  Look look;
  std::vector<Pin> pins;
  std::vector<Weight> weights;
};

/// A rigid body: it rests, or key frames or forces move it.
struct Obstacle {
  std::string name;
  Shape shape;
  int segments = 48;  ///< round shapes: number of faces around the axis
  Pose pose;
  PoseTrack motion;        ///< key frames of the pose, in place of `pose`; empty: the obstacle rests at `pose`
  double mass = 0;         ///< [kg]; 0: follows from `density`
  double density = 0;      ///< [kg/m³]; 0: follows from `mass`; if both are 0, forces do not move the obstacle
  Vec3 velocity{0, 0, 0};  ///< at the start or at `release`, if forces move it and it has at most one key frame [m/s]
  Vec3 spin{0, 0, 0};      ///< at the same time: angular velocity about the centre of mass [degrees/s]
  /// If forces move the obstacle: time at which they begin to act [s]; until then, the obstacle rests or follows its
  /// key frames. Absent: forces act from the start.
  std::optional<double> release;
  /// Obstacle or "<character>.<part>" that this obstacle follows: the rigid motion of the followed body since the start
  /// of the run is added to the motion of this obstacle. Empty: none.
  std::string follow = {};
  double friction = 0.3;
  bool collide = true;
  Look look;
  int line = 0, column = 0;  ///< place in the scene file, for error messages
};

/// Whether forces move the obstacle.
inline bool is_dynamic(const Obstacle& obstacle) {
  return obstacle.mass > 0 || obstacle.density > 0;
}

enum class Stance { first, rest };

/// Names of one joint in two files. Only needed if the program does not find the joint in one of them.
struct JointNames {
  std::string name;                   ///< one of character::joint_names()
  std::optional<std::string> body;    ///< its name in the file of the character; absent: found by the program
  std::optional<std::string> motion;  ///< its name in the file of the motion; absent: found by the program
};

/// Horizontal motion of a clip: as in its file, none (in place), or with a given mean speed.
struct Travel {
  enum class Kind { file, none, speed };
  Kind kind = Kind::file;
  double speed = 0;  ///< for Kind::speed: mean horizontal speed in the scene [m/s]
};

/// The motion of a body with a skeleton. A clip is an animation in a file.
struct SkeletonMotion {
  std::optional<std::string> clip;  ///< name of the clip in `motion`, else in the file of the body; absent: the first
  std::optional<std::filesystem::path> motion;  ///< file with the motion of another skeleton; absolute path
  FileUp motion_up = FileUp::as_file;           ///< up axis of `motion`
  std::vector<JointNames> joints;
  Travel travel;
  /// Pose during Character::dressing. `first`: that of the clip at Character::start; `rest`: that of the skeleton.
  Stance stance = Stance::first;
  /// Angle between the straight arms and the downward direction in the pose of `stance` [degrees]; absent: as in the
  /// pose.
  std::optional<double> stance_arms;
  bool loop = false;     ///< whether the clip is repeated; each round starts where the round before ended
  double crossfade = 0;  ///< clip time at the end of a round in which it is blended into the next one [s]; 0: none
};

/// A character from a file, with skeleton and animations.
struct CharacterFile : SkeletonMotion {
  std::filesystem::path path;        ///< absolute
  std::vector<std::string> meshes;   ///< names of the meshes to use, or of their nodes; empty: all
  std::vector<std::string> without;  ///< names of the meshes to leave out, or of their nodes
};

/// The built-in mannequin; see character::MannequinBuild. In scenes with z up, it faces −y and walks along −y.
struct Mannequin : SkeletonMotion {
  double height = 1.75;       ///< [m]
  double girth = 1;           ///< factor on widths and depths of the slender default
  double masculinity = 0;     ///< 0: shape of a woman, 1: of a man
  double edge_length = 0.02;  ///< edge length of its triangles [m]
  double walk = 0;            ///< walked distance [m]; 0: it stands
  double pace = 1.2;          ///< steady walking speed [m/s]
  bool turn_back = false;     ///< true: turns around at the end of the walk and walks back
  double arms_out = 13;       ///< angle of the upper arms from the vertical while it walks [degrees]
};

/// A body whose key frames are a sequence of mesh files.
struct MeshSequence {
  std::string files;  ///< see sequence_files(); absolute path
  double fps = 25;    ///< files per second
};

using CharacterSource = std::variant<CharacterFile, Mannequin, MeshSequence>;

/// A part of a character with its own contact settings. `bone` or `material` selects the part; if both are absent,
/// `name` selects it, such as "head".
struct BodyPart {
  std::string name;
  std::optional<std::string> bone;      ///< node of the character's file; includes all nodes below it
  std::optional<std::string> material;  ///< of the character's file
  bool collide = true;
  std::optional<double> friction;  ///< absent: that of the character
  double thickness = 0;            ///< thickness of padding [m]; half of it is added to the contact distance
};

/// A body with prescribed motion. The program converts this motion to key frames of the vertices of the body.
struct Character {
  std::string name;
  CharacterSource source;
  std::optional<double> scale;  ///< metres per unit of the file; absent: as stated in the file, else 1
  FileUp up = FileUp::as_file;
  Pose pose;            ///< of the file's origin, or of the floor below the mannequin
  double dressing = 0;  ///< time for which it stands still to be dressed, from the start of the preroll on [s]
  /// Time after `dressing` [s] in which the clip accelerates to `speed` and the pose changes from `stance` to the clip.
  double blend = 0;
  double grow = 0;   ///< time at the start of `dressing` in which it grows from its bones to its size [s]
  double start = 0;  ///< time of the clip at which the motion begins [s]
  double speed = 1;  ///< factor on the speed of the clip
  std::optional<double> clearance;        ///< clearance between limbs [m]; absent: clearance_between_limbs()
  std::optional<double> keys_per_second;  ///< computed key frames per second [Hz]; absent: rate of
                                          ///< the clip, but 10 to 120
  Interpolation interpolation = Interpolation::cubic;
  double friction = 0.3;
  bool collide = true;
  std::vector<BodyPart> parts;
  Look look;
  int line = 0, column = 0;  ///< place in the scene file, for error messages
};

/// The motion settings of a character with a skeleton; nullptr for mesh sequences.
inline const SkeletonMotion* skeleton_motion_of(const Character& character) {
  if (const auto* file = std::get_if<CharacterFile>(&character.source)) return file;
  return std::get_if<Mannequin>(&character.source);
}
inline SkeletonMotion* skeleton_motion_of(Character& character) {
  return const_cast<SkeletonMotion*>(skeleton_motion_of(std::as_const(character)));
}

/// Key frame of a light.
struct LightKey {
  double time = 0;  ///< [s]
  /// Suns: direction in which the light travels. Spots: position and target [m].
  Vec3 direction{-0.4, -0.5, -1}, position{0, 0, 5}, target{0, 0, 0};
  double intensity = 1;  ///< with 1, a white surface that faces the light (spot: at its target) looks white
};

struct Light {
  std::string name;
  bool spot = false;
  double cone_angle = 45;  ///< full opening angle [degrees]
  Vec3 color{1, 1, 1};
  double softness = 2;         ///< angular width of the source as seen from the scene [degrees]
  std::vector<LightKey> keys;  ///< key frames, at least one; with only one, the light does not change
  Interpolation interpolation = Interpolation::cubic;
};

enum class StageLook { studio, stage, daylight, clay, wire, strain };

struct Render {
  int width = 1280, height = 720;
  std::string camera;  ///< name; empty: the first camera or, without cameras, one that the program places
  StageLook look = StageLook::studio;
  std::optional<Vec3> sky_color, ground_color;  ///< sRGB; absent: those of the look
  /// Fraction of all light that comes from the surroundings; absent: that of the look.
  std::optional<double> sky_intensity;
  double exposure = 0;                     ///< exposure compensation [stops]
  double motion_blur = 0;                  ///< shutter angle [degrees]
  HeatQuantity heat = HeatQuantity::none;  ///< quantity that the colours of cloth show
  double heat_max = 0;  ///< value of the hottest colour: strain, or speed [m/s]; 0: maximum of each frame
};

struct Scene {
  std::filesystem::path file;
  std::string name;  ///< file name without extension; names the output
  std::string title;
  std::uint64_t hash = 0;                    ///< see identify() (effective.hpp)
  std::uint64_t simulation_hash = 0;         ///< see identify()
  std::vector<std::filesystem::path> files;  ///< files that for_each_dependency() visits
  UpAxis up = UpAxis::z;
  Time time;
  Physics physics;
  std::vector<Fan> fans;
  Solver solver;
  Contact contact;
  std::vector<Cloth> cloths;  ///< cloths of ropes come last
  std::vector<Rope> ropes;    ///< `cloths` contains a cloth for each of them
  std::vector<Attachment> attachments;
  std::vector<Obstacle> obstacles;
  std::vector<Character> characters;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Render render;

  int frame_count() const { return static_cast<int>(std::lround(time.duration * time.fps)) + 1; }
  /// Number of frames in the preroll; frame 0 follows them.
  int preroll_frames() const { return static_cast<int>(std::ceil(time.preroll * time.fps - kRoundoff)); }
  double start_time() const { return -preroll_frames() / time.fps; }  ///< start of the run, including the preroll [s]
};

}  // namespace weft::scene
