// A scene after checking: plain values in SI units, every default filled in, every name resolved.
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
#include "scene/camera.hpp"
#include "scene/keyed.hpp"
#include "scene/physics.hpp"
#include "scene/pressure.hpp"
#include "scene/shapes.hpp"

namespace weft::scene {

enum class UpAxis { y, z };
enum class Integrator { implicit_euler, implicit_midpoint, bdf2 };

/// What scenes and reports call them, in their order.
inline const std::vector<std::string> kIntegratorNames = {"implicit_euler", "implicit_midpoint", "bdf2"};
inline const std::string& name_of(Integrator integrator) {
  return kIntegratorNames[static_cast<std::size_t>(integrator)];
}

enum class HeatQuantity { none, strain, speed };
enum class Response { springs, velocity_constraints };

struct Time {
  double duration = 5;  ///< [s]; the scene has round(duration * fps) + 1 frames
  double fps = 25;      ///< frames a second
  double preroll = 0;   ///< simulated before frame 0 and not shown [s]
  double step = 0.01;   ///< largest time step [s]; a frame is cut into equal steps no longer than this
  std::optional<double> tolerance =
      std::nullopt;  ///< instead of `step`: local error of the positions of a cloth in one step [m]
  Integrator integrator = Integrator::implicit_euler;
};

struct Solver {
  double newton_tolerance = 0.3;  ///< residual against the weight and inertia of the cloth, relative
  int newton_iterations = 60;     ///< per step, before the step is halved
  double linear_tolerance = 0.1;  ///< of the conjugate gradients, relative to the first residual
  int linear_iterations = 1000;
  int halvings = 8;  ///< of a rejected step, before the run gives up
};

enum class Bounds { box, dop18, dop26 };
enum class TreeKind { binary, quad, oct };

/// How near surfaces are found (seed, "Collision Detection"). Nothing here changes what is found, only how fast.
struct Search {
  Bounds bounds = Bounds::box;    ///< k-DOPs with k = 6, 18, 26
  TreeKind tree = TreeKind::oct;  ///< two, four or eight children to a node
  int leaf = 8;                   ///< most triangles of a leaf
  bool open_longer_side = false;  ///< of two nodes open the longer one, instead of both
  bool separation_lists = false;  ///< walk on from where the last walk stopped
  bool velocity_cones = false;    ///< leave the bounds of slow nodes as they are
  bool normal_cones = false;      ///< skip regions that are provably flat enough
  bool coherence = false;         ///< keep closest points of surfaces that hardly move relative to each other
  bool reuse = true;              ///< keep candidates and close features while nothing has moved far
};

/// Coulomb friction between two objects, instead of what their own coefficients give.
struct FrictionPair {
  std::string first, second;              ///< names of cloths or obstacles; the same twice: a cloth with itself
  double friction = 0.3;                  ///< while sliding
  std::optional<double> static_friction;  ///< until sliding begins, at least that of sliding; the same where absent
};

/// Contact of all surfaces.
struct Contact {
  bool self = true;        ///< cloth against itself and other cloths
  bool obstacles = true;   ///< cloth against obstacles
  double stiffness = 100;  ///< of one contact [N/m]
  std::vector<FrictionPair> pairs;
  Search search;
  Response response = Response::springs;
};

/// A fabric in continuum units (seed, "Elastic Model").
struct Material {
  std::string fabric = "cotton";  ///< the named fabric that the numbers started from
  double density = 0.15;          ///< [kg/m²]
  double stretch_weft = 800;      ///< k1 [N/m]
  double stretch_warp = 2100;     ///< k2 [N/m]
  double shear = 130;             ///< mu [N/m]; the shear modulus of linear elasticity is mu / 2
  double bend = 1e-5;             ///< B [N·m]
  double max_stretch = 0.1;       ///< extension at which threads lock; 0: never
  double max_shear = 0;           ///< angle off square at which they lock [degrees]; 0: never
  double stretch_viscosity = 0;   ///< stress per strain rate, weft and warp [N·s/m]
  double shear_viscosity = 0;     ///< [N·s/m]
  double bend_viscosity = 1e-6;   ///< [N·m·s]
  double bend_friction = 5e-4;    ///< moment per width that a change of curvature must overcome [N]
  double thickness = 0.002;       ///< distance that contact keeps between two layers [m]
  double friction = 0.3;          ///< Coulomb coefficient; of a pair: the geometric mean of both
  double drag = 1.0;              ///< air resistance coefficient of the normal motion; 0 for none
};

/// Colours of a cloth or of one of its panels, and a picture on it that lies along the grain.
struct Paint {
  Vec3 color{0.8, 0.8, 0.8};                   ///< sRGB
  std::optional<Vec3> back_color;              ///< cloth: the other side; a paler front where absent
  std::optional<std::filesystem::path> image;  ///< PNG, JPEG or TGA; absolute after checking
  double image_width = 0.2;                    ///< of one tile along weft [m]; its height follows the picture's shape
  Vec2 image_offset{0, 0};                     ///< of the lower left corner of a tile along weft and warp [m]
  double image_rotation = 0;                   ///< about that corner, counter-clockwise [degrees]
  bool image_repeat = true;                    ///< else one tile, and `color` around it
  bool cutout = false;                         ///< what is transparent is a hole; else `color` shows there
};

/// A panel of a pattern with colours of its own.
struct PanelPaint : Paint {
  std::string name;
};

/// What cloth does with light beside showing its colour, each from 0 to 1; see frame::Finish.
struct Finish {
  double gloss, warp_share, fuzz, sheer;
  Threads threads = Threads::plain;
};

struct Look : Paint {
  std::vector<PanelPaint> panels;  ///< of a pattern
  bool as_file = true;             ///< characters: colours and pictures are those of the file, where it has some
  double roughness = 0.6;
  std::optional<double> gloss;        ///< of threads, by default of the fabric; of an obstacle: of its coat
  std::optional<double> fuzz, sheer;  ///< cloth only; those of the fabric where absent
  double metal = 0;                   ///< obstacles only: 1 where it reflects in its own colour
  std::optional<double> tile_width;   ///< obstacles only: of its picture [m]; absent: once over the shape
  double warp_share = 0.5;            ///< of the gloss; of the fabric
  Threads threads = Threads::plain;   ///< of the fabric
  double cloth_thickness = 0;         ///< of the fabric itself, or of a rope [m]
  double thread_spacing = 0.0006;     ///< of the drawn weave [m]; cloth only; 0 draws none
  std::optional<double> hem;          ///< width of its hems [m]; cloth only; 0: cut edges
  bool checker = false;               ///< floors only
  bool strands = true;                ///< ropes only: drawn twisted
  bool visible = true;
};

/// A rigid placement: rotation, then translation.
struct Pose {
  Vec3 position{0, 0, 0};  ///< [m]
  Quat rotation{1, 0, 0, 0};
  std::optional<Vec3> angles{};  ///< of the same rotation, where it was given by them [degrees]: with whole turns
};

/// How far the angles differ from one key to the next [degrees]: nothing where one of them has none.
std::optional<Vec3> change_of_angles(const Pose& from, const Pose& to);

struct PoseKey {
  double time = 0;  ///< [s], strictly increasing
  Pose pose;
};

struct PoseTrack {
  Interpolation interpolation = Interpolation::cubic;
  std::vector<PoseKey> keys;  ///< empty: stays at the object's own pose
};

/// Where a pin holds its particles at a time. The rotation is about their middle.
struct PinKey {
  double time = 0;  ///< [s], strictly increasing
  Pose pose;        ///< position: of their middle, from where that starts, or in the world
  bool in_world = false;
};

struct PinTrack {
  Interpolation interpolation = Interpolation::cubic;
  std::vector<PinKey> keys;  ///< empty: they stay where they start
};

enum class VertexColor { none, red, green, blue, brightness };

/// Particles of a cloth, in fractions of its rest size along weft and warp: those inside [low, high]. What else is
/// given says which share of each of them; several such shares are multiplied.
struct ClothPart {
  std::string panel;  ///< of a pattern: only those of it, and fractions are of its own size; empty: all
  Vec2 low{0, 0}, high{1, 1};
  std::optional<Vec2> at = {};                   ///< of a rope, in place of low and high: fractions of its length
  std::string edge;                              ///< of a pattern, as "panel.edge": only those on it; empty: all
  std::optional<std::filesystem::path> mask;     ///< picture whose greys are shares; absolute after checking
  VertexColor vertex_color = VertexColor::none;  ///< of the file of a mesh
  std::string vertex_group;                      ///< likewise: a group of its vertices, or bone; empty: all

  /// Whether the particle at fractions (u, v) of the rest size is inside; the slack keeps i / (n - 1) inside a bound
  /// that was written with fewer digits.
  bool holds(double u, double v) const {
    constexpr double kSlack = 1e-9;
    return u >= low.x() - kSlack && u <= high.x() + kSlack && v >= low.y() - kSlack && v <= high.y() + kSlack;
  }
};

/// Particles held in place, or moved.
struct Pin : ClothPart {
  std::string follow;              ///< body whose motion they share, or "<character>.<part>"; empty: none
  PinTrack motion;                 ///< else of their own
  double release = -1;             ///< time at which they are let go [s]; negative: never
  std::optional<double> strength;  ///< of the springs that draw them there [N/m]; none: they are held
  double fade = 0;  ///< distance along the cloth up to which others are drawn too, ever less [m]; needs a strength
};

/// The body and, of a character, the part (else empty) that a `follow` names.
struct Followed {
  std::string body, part;
};
inline Followed followed(const std::string& follow) {
  const std::size_t dot = follow.find('.');
  return {follow.substr(0, dot), dot == std::string::npos ? "" : follow.substr(dot + 1)};
}

/// Mass that hangs on particles, by their shares.
struct Weight : ClothPart {
  double mass = 0.1;  ///< [kg]
};

/// Springs from particles of a cloth to the nearest places of another cloth or of a body: buttons, pegs, tacks.
struct Attachment : ClothPart {
  std::string name, cloth, to;
  double stiffness = 10000;             ///< of the spring of each particle, times its share [N/m]
  std::optional<double> length;         ///< up to which it is slack [m]; none: as far apart as when it begins
  double begin = -1e5, release = -1;    ///< [s]; release negative: never
  std::optional<double> breaking_load;  ///< of all its springs together, above which it is gone [N]; none: never
};

enum class ClothStart { as_given, untangle };
enum class ClothShape { quads, aligned_triangles, crossed_triangles, mesh, pattern, rope };
enum class ClothRest { automatic, mesh, uv };

struct Rope;

struct Cloth {
  std::string name;
  ClothShape shape = ClothShape::quads;
  Vec2 size{1, 1};                               ///< weft, warp [m]; not of a file
  int particles_weft = 41, particles_warp = 41;  ///< likewise; crossed triangles have one more in each cell
  Vec2 grading{1, 1};                            ///< likewise: last spacing of particles over the first
  std::filesystem::path file;                    ///< of a mesh or sewing pattern; absolute after checking
  double scale = 1;             ///< of a mesh: metres per unit of the file; of a pattern: factor on its lengths
  FileUp up = FileUp::as_file;  ///< of a mesh: axis of the file that points up
  std::string object;           ///< of a mesh: name of what the file has it as; empty: all that it holds
  ClothRest rest = ClothRest::automatic;  ///< what the shape at rest of a mesh is taken from
  std::optional<Vec2> uv_scale;           ///< metres per unit of its UVs; absent: measured against the mesh
  double edge_length = 0.02;              ///< of the mesh of a pattern [m]
  std::string wearer;                     ///< character that a pattern is put on; empty: the only one
  bool fit = false;                       ///< whether a pattern is scaled to the wearer's measures
  double sewing = 1;                      ///< time in which what has flat panels goes to their measures [s]
  int line = 0, column = 0;               ///< where the scene names it, for errors of its file
  Pose pose;               ///< of the middle of the sheet, which lies in its x-y plane, weft along x, warp along y
  Vec3 velocity{0, 0, 0};  ///< at the start [m/s]
  Vec3 spin{0, 0, 0};      ///< at the start, about its centre of mass: along the axis [degrees/s]
  Vec2 start_scale{1, 1};  ///< lengths along weft and warp at the start, times those at rest
  ClothStart start = ClothStart::as_given;  ///< where it touches or crosses something
  std::vector<std::string> over;            ///< cloths that are put on before it, and stay inside of it
  double start_noise = 0;                   ///< most that a particle is off its place at the start, along each axis [m]
  Material material;
  Pressure pressure;
  Look look;
  std::vector<Pin> pins;
  std::vector<Weight> weights;
  std::shared_ptr<const Rope> rope;  ///< that it stands for; null: it is a sheet
};

/// Particles of a rectangle of cloth; of the others their file tells, and this is 0.
inline long rectangle_particles(const Cloth& cloth) {
  const long u = cloth.particles_weft, v = cloth.particles_warp;
  if (cloth.shape > ClothShape::crossed_triangles) return 0;
  return u * v + (cloth.shape == ClothShape::crossed_triangles ? (u - 1) * (v - 1) : 0);
}

/// How long a rope is at a time, as if it were drawn in or let out evenly.
struct RopeKey {
  double time = 0;    ///< [s], strictly increasing
  double length = 1;  ///< at rest [m]
};

/// A thin chain of particles. What is simulated is the cloth of one dimension that as_cloth() makes of it.
struct Rope {
  std::string name;
  std::vector<Vec3> points;                            ///< that it runs through at the start [m]
  std::optional<Vec3> from, to;                        ///< its ends, where it has no points [m]
  bool smooth = false;                                 ///< bent through its points; else straight between them
  bool closed = false;                                 ///< its end is its beginning
  std::optional<double> length;                        ///< at rest [m]; absent: as it starts
  Interpolation interpolation = Interpolation::cubic;  ///< between its keys
  std::vector<RopeKey> keys;                           ///< of its length; empty: that stays
  std::optional<int> segments;                         ///< pieces between particles; absent: by diameter
  double diameter = 0.008;                             ///< that contact keeps [m]
  int material = 0;                                    ///< into rope_materials()
  std::optional<double> mass, stretch, bend;  ///< of a metre [kg/m], EA [N], EI [N·m²]; absent: of the material
  double damping = 0.01;                      ///< viscosity of stretch and bending over their stiffness [s]
  double friction = 0.3;                      ///< Coulomb coefficient; of a pair: the geometric mean of both
  double drag = 1.1;                          ///< air resistance coefficient of motion across it, as of a cylinder
  Vec3 velocity{0, 0, 0};                     ///< at the start [m/s]
  Look look;
  std::vector<Pin> pins;
  std::vector<Weight> weights;
};

struct Obstacle {
  std::string name;
  Shape shape;
  int segments = 48;  ///< round shapes: faces around
  Pose pose;
  PoseTrack motion;        ///< absolute poses; empty: rests at `pose`
  double mass = 0;         ///< [kg]; 0: by density
  double density = 0;      ///< of its volume [kg/m³]; 0, and no mass: forces do not move it
  Vec3 velocity{0, 0, 0};  ///< at the start, where forces move it and no keys [m/s]
  Vec3 spin{0, 0, 0};      ///< likewise, rate of turning about its centre of mass [degrees/s]
  double release = 0;      ///< time from which on forces move it [s]; before, its keys do
  /// Obstacle, or "<character>.<part>", whose rigid motion from the start of the run on is added to its own; empty:
  /// none.
  std::string follow = {};
  double friction = 0.3;
  bool collide = true;
  Look look;
  int line = 0, column = 0;  ///< where the scene names it, for errors of its file
};

/// Whether forces move it.
inline bool is_dynamic(const Obstacle& obstacle) {
  return obstacle.mass > 0 || obstacle.density > 0;
}

enum class Stance { first, rest };

/// A joint of the body that `motion` is to move, where its name is none that is known.
struct JointNames {
  std::string name;                   ///< one of character::joint_names()
  std::optional<std::string> body;    ///< in the character's file
  std::optional<std::string> motion;  ///< in the file of the motion
};

/// How a clip goes over the floor: as its file has it, in place, or at a speed.
struct Travel {
  enum class Kind { file, none, speed };
  Kind kind = Kind::file;
  double speed = 0;  ///< [m/s of the scene]; where that is the kind
};

/// How a skinned body is made to move.
struct Acting {
  std::optional<std::string> clip;              ///< of `motion`, else of the body itself; absent: the first
  std::optional<std::filesystem::path> motion;  ///< file whose motion it takes over; absolute after checking
  FileUp motion_up = FileUp::as_file;           ///< axis of `motion` that points up
  std::vector<JointNames> joints;
  Travel travel;
  Stance stance = Stance::first;      ///< pose that is held while dressing
  std::optional<double> stance_arms;  ///< angle of its straight arms from hanging down; absent: as they are [degrees]
  bool loop = false;                  ///< again and again, each round from where the last one has come to
  double crossfade = 0;               ///< [s] of clip time at the end of a round that pass over into the next
};

/// A skinned and animated character from a file.
struct CharacterFile : Acting {
  std::filesystem::path path;        ///< absolute after checking
  std::vector<std::string> meshes;   ///< that it consists of, by the names of meshes or their nodes; empty: all
  std::vector<std::string> without;  ///< that it does not have, likewise
};

/// Our own mannequin, see character::MannequinBuild. It looks along −y, where y is up along z, and walks there.
struct Mannequin : Acting {
  double height = 1.75;       ///< [m]
  double girth = 1;           ///< widths against those of the slender default
  double masculinity = 0;     ///< 0 a woman, 1 a man
  double edge_length = 0.02;  ///< of its triangles [m]
  double walk = 0;            ///< [m]; 0: it stands
  double pace = 1.2;          ///< of even walking [m/s]
  bool turn_back = false;     ///< at the end it turns and walks back
  double arms_out = 13;       ///< of the upper arms from the vertical while it walks [degrees]
};

/// Key frames as mesh files, one after the other.
struct MeshSequence {
  std::string files;  ///< a folder, or a file name with one *; relative paths start at the scene's folder
  double fps = 25;    ///< [1/s]
};

using CharacterSource = std::variant<CharacterFile, Mannequin, MeshSequence>;

/// Of a character, with a say of its own in contact. What it is: a bone, a material, else what its name says.
struct BodyPart {
  std::string name;
  std::optional<std::string> bone;      ///< node of the character's file, with all below it
  std::optional<std::string> material;  ///< of the character's file
  bool collide = true;
  std::optional<double> friction;  ///< absent: that of the character
  double thickness = 0;            ///< distance that cloth keeps from it beyond its own half thickness, twice [m]
};

/// A body that moves by itself, stored as key frames of its vertices.
struct Character {
  std::string name;
  CharacterSource source;
  std::optional<double> scale;  ///< metres per unit of the file; absent: what the file says, else 1
  FileUp up = FileUp::as_file;
  Pose pose;                              ///< of the file's origin, or of the floor below the mannequin
  double dressing = 0;                    ///< [s] it stands still
  double blend = 0;                       ///< [s] in which it then gets going
  double grow = 0;                        ///< [s] of the dressing in which it grows from its bones to its size
  double start = 0;                       ///< time of the clip that it gets going from [s]
  double speed = 1;                       ///< of the clip
  std::optional<double> room;             ///< [m] between its limbs for cloth; absent: as cloths are thick
  std::optional<double> keys_per_second;  ///< absent: those of the clip
  Interpolation interpolation = Interpolation::cubic;
  double friction = 0.3;
  bool collide = true;
  std::vector<BodyPart> parts;
  Look look;
  int line = 0, column = 0;  ///< where the scene names it, for errors of its file
};

/// Of a character with joints; else nullptr.
inline const Acting* acting_of(const Character& character) {
  if (const auto* file = std::get_if<CharacterFile>(&character.source)) return file;
  return std::get_if<Mannequin>(&character.source);
}
inline Acting* acting_of(Character& character) {
  return const_cast<Acting*>(acting_of(std::as_const(character)));
}

struct LightKey {
  double time = 0;
  Vec3 direction{-0.4, -0.5, -1}, position{0, 0, 5}, target{0, 0, 0};
  double intensity = 1;
};

struct Light {
  std::string name;
  bool spot = false;
  double cone_angle = 45;
  Vec3 color{1, 1, 1};
  double softness = 2;
  std::vector<LightKey> keys;  ///< at least one; one: still
  Interpolation interpolation = Interpolation::cubic;
};

enum class StageLook { studio, stage, daylight, clay, wire, strain };

struct Render {
  int width = 1280, height = 720;
  std::string camera;  ///< name; empty: the first, or automatic framing where there is none
  StageLook look = StageLook::studio;
  std::optional<Vec3> sky_color, ground_color;  ///< sRGB; those of the look where absent
  std::optional<double> sky_intensity;
  double exposure = 0;     ///< stops
  double motion_blur = 0;  ///< angle of the shutter [degrees]
  HeatQuantity heat = HeatQuantity::none;
  double heat_max = 0;
};

struct Scene {
  std::filesystem::path file;
  std::string name;  ///< file name without its ending; names the output
  std::string title;
  std::uint64_t hash = 0;                    ///< of the checked values, so that comments and order do not count
  std::uint64_t simulation_hash = 0;         ///< of those that count for the simulation
  std::vector<std::filesystem::path> files;  ///< all that were read for it, and it depends on
  UpAxis up = UpAxis::z;
  Time time;
  Physics physics;
  std::vector<Fan> fans;
  Solver solver;
  Contact contact;
  std::vector<Cloth> cloths;  ///< those of ropes behind the others
  std::vector<Rope> ropes;    ///< as they are read
  std::vector<Attachment> attachments;
  std::vector<Obstacle> obstacles;
  std::vector<Character> characters;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Render render;

  int frame_count() const { return static_cast<int>(std::lround(time.duration * time.fps)) + 1; }
  /// Of the preroll; frame 0 comes after them.
  int preroll_frames() const { return static_cast<int>(std::ceil(time.preroll * time.fps - 1e-9)); }
  double start_time() const { return -preroll_frames() / time.fps; }  ///< of the run, with its preroll [s]
};

}  // namespace weft::scene
