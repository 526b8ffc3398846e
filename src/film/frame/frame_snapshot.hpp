// The data of one frame: all that the renderer and the mesh writer get from the simulation.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/threads.hpp"
#include "core/types.hpp"

namespace weft::frame {

enum class ObjectKind { cloth, obstacle, character, rope };

/// Name, kind and size of an object, for lists of the objects of a run.
struct ObjectInfo {
  std::string name;
  ObjectKind kind;
  std::size_t vertices = 0, faces = 0;
};

/// A picture for surfaces.
struct Texture {
  int width = 0, height = 0;       ///< [pixels], at least 1
  std::vector<std::uint8_t> rgba;  ///< R, G, B, A of each pixel, top row first; sRGB, alpha not premultiplied
};

/// A picture on a surface, and how it is mapped and blended.
struct Paint {
  /// What is drawn beyond the edge of the picture: the picture again (repeat), its border pixels (clamp), the mirrored
  /// picture (mirror), or nothing, as if the picture were transparent there (once).
  enum class Wrap { repeat, clamp, mirror, once };
  /// Effect of the alpha channel. ignored: the whole picture is opaque. over_color: transparent parts show the colour
  /// of the surface. cutout: transparent parts are holes in the surface.
  enum class Alpha { ignored, over_color, cutout };
  std::shared_ptr<const Texture> texture;
  /// Maps (u, v, 1) of the surface to coordinates of the picture: 0 to 1 from left to right and from bottom to top.
  Eigen::Matrix<double, 2, 3> texture_from_uv = Eigen::Matrix<double, 2, 3>::Identity();
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  Alpha alpha = Alpha::ignored;
};

/// Optical properties of cloth besides its colour, each from 0 to 1.
struct Finish {
  double gloss = 0.15;         ///< strength of the highlights of threads, wide across the threads and narrow along them
  double warp_fraction = 0.5;  ///< fraction of warp among the threads on top: 0.5 for a plain weave, more for satin
  double fuzz = 0.4;           ///< amount of fibres that stand out from the cloth and scatter light at grazing angles
  double sheer = 0.25;         ///< strength of the light that passes through the cloth; above 0.5: see-through
  Threads threads = Threads::plain;
};

/// The appearance of a surface. Colours are sRGB, 0 to 1.
struct Appearance {
  Vec3 color{0.8, 0.8, 0.8};
  Vec3 back_color{0.8, 0.8, 0.8};  ///< cloth only: colour of the side opposite to weft × warp
  double roughness = 0.6;          ///< from 0 (mirror-like) to 1 (matte)
  double thread_spacing = 0;  ///< distance between drawn threads, or lay length of a rope [m]; 0: no threads or strands
  Finish finish;              ///< cloth only
  double metal = 0;           ///< not for cloth: from 0 (no metal) to 1 (metal, which reflects in `color`)
  double coat = 0;            ///< not for cloth: strength of a clear coat, from 0 to 1 (as glass)
  double thickness = 0;       ///< thickness of cloth, visible at its borders, or diameter of a rope [m]; 0: none
  double hem = 0;             ///< width of the folded and sewn borders of cloth [m]; 0: cut borders without hem
  bool checker = false;       ///< faint checkerboard of 0.5 m tiles on the floor, which shows the scale
  /// The picture covers `color` if its alpha is over_color, or if its alpha is ignored and its wrap is `once`.
  /// Otherwise, the picture is multiplied by `color`.
  Paint paint;
  /// Whether the back of cloth also shows the picture, paler by `back_paleness`. If false, the back has `back_color`.
  bool back_painted = true;
  double back_paleness = 0;  ///< from 0 (as the front) to 1 (white)
};

/// A group of triangles of a surface with its own appearance: a panel of a garment, a material of a character's file.
struct SurfacePart {
  std::string name;
  Appearance appearance;  ///< its colours and picture are drawn; all other properties are those of the surface
};

/// The data of an object that do not change in a run. All snapshots share them.
struct Surface {
  std::string name;
  ObjectKind kind = ObjectKind::cloth;
  bool visible = true;
  bool infinite_floor = false;                  ///< a floor drawn to the horizon; computed cameras ignore it
  std::vector<std::array<Index, 3>> triangles;  ///< counter-clockwise seen from the front; of a rope: see is_chain()
  std::vector<std::uint8_t> passed_through;     ///< per triangle: 1 if nothing collides with it; empty: all 0
  std::vector<std::array<Index, 4>> quads;      ///< faces as simulated, if they are quads; else empty
  std::vector<Vec2> uv;                         ///< per vertex: rest coordinates (weft, warp) [m]; may be empty
  /// Bounding box in world space [m]: of a body over its prescribed motion from time 0 to the end of the scene, or of a
  /// cloth at its start. Absent: unknown.
  std::optional<Box3> run_bounds;
  /// An edge is drawn sharp if the normals of its two faces differ by more than this angle [degrees]. 180: all edges
  /// are smooth, as for cloth.
  double crease_angle = 30;
  Appearance appearance;
  std::vector<SurfacePart> parts;              ///< empty: all triangles have `appearance`
  std::vector<std::int32_t> part_of_triangle;  ///< per triangle: index into `parts`; empty if there are no parts
  /// Per triangle: (u, v) of its corners, which Paint::texture_from_uv maps to the picture; on panels of a garment, in
  /// metres along weft and warp. Empty: `uv` applies.
  std::vector<std::array<Vec2, 3>> paint_uv;
  /// Per zip and per seam that can tear: pairs of vertices of its two edges, in order. The edges are drawn as one
  /// between consecutive pairs if both pairs are closer than `max_closed_gap` [m].
  std::vector<std::vector<std::array<Index, 2>>> closures;
  double max_closed_gap = 0;
};

/// Whether a surface or one of its parts has a picture, or a part has other colours than the surface.
inline bool is_painted(const Surface& surface) {
  const Appearance& own = surface.appearance;
  return own.paint.texture || std::ranges::any_of(surface.parts, [&](const SurfacePart& part) {
           const Appearance& look = part.appearance;
           return look.paint.texture || look.color != own.color || look.back_color != own.back_color;
         });
}

/// The data of an object that change from frame to frame.
struct SurfaceState {
  std::vector<Vec3> positions;  ///< world space [m], one per vertex
  std::vector<float> heat;      ///< of cloth and ropes, per vertex: value of the quantity Stage::heat
                                ///< (strain, or speed [m/s]); empty for Heat::none
};

/// A camera at one time.
struct Camera {
  std::string name;
  Vec3 position{0, -3, 1.5};  ///< [m]
  Vec3 target{0, 0, 0.5};     ///< point in the middle of the picture [m]
  double field_of_view = 35;  ///< vertical [degrees]; 0: computed (only if `kind` is track)
  double aperture = 0;        ///< f-number for a film 24 mm high; 0: everything is sharp
  double focus = 0;           ///< distance of the plane in focus along the view axis [m]; 0: distance of the target

  /// placed: the camera has the values above. Cameras of the other kinds are computed from all frames of a run, so that
  /// the subjects are in view. whole: stands still or, if `azimuth` differs between frames, orbits. follow: moves along
  /// with the subjects at a constant distance. close: moves along with the subjects at a distance that changes smoothly
  /// and is as small as possible. track: stands at `position` and turns toward the subjects.
  enum class Kind { placed, whole, follow, close, track };
  Kind kind = Kind::placed;
  /// Names of the surfaces to keep in view. If empty: for `whole`, all visible surfaces except infinite floors; for the
  /// other kinds, all characters; without characters, all cloths; without both, as for `whole`.
  std::vector<std::string> subjects = {};
  /// Horizontal direction from the subjects to the camera [degrees]. 0: along −y if z is up, along +z if y is up; 90:
  /// along +x.
  double azimuth = 33;
  double elevation = 17;   ///< angle of the direction from the subjects to the camera above the horizontal [degrees]
  double margin = 0.14;    ///< free space around the subjects, as a fraction of half the picture's width or height
  double smoothing = 0.5;  ///< standard deviation of the Gaussian that smooths the camera's motion [s]
  /// Number of cuts of a placed camera from its first key to this time. Between two frames with different numbers, the
  /// camera jumps: it has no motion there.
  std::int32_t shot = 0;
};

/// Maximum number of lights of a picture, because each light takes rays at every pixel. Further lights are ignored.
inline constexpr int kMaxLights = 4;

/// A light at one time. Sun: parallel light along `direction`. Spot: from `position` toward `target`.
struct Light {
  enum class Kind { sun, spot };
  std::string name;
  Kind kind = Kind::sun;
  Vec3 direction{-0.4, -0.5, -1};  ///< direction in which the light travels (sun)
  Vec3 position{0, 0, 5};          ///< [m] (spot)
  Vec3 target{0, 0, 0};            ///< [m] (spot)
  double cone_angle = 45;          ///< full opening [degrees] (spot)
  Vec3 color{1, 1, 1};             ///< sRGB
  double intensity = 1;  ///< at 1, a white matte surface that faces the light (spot: at its target) appears white
  double softness = 2;  ///< angular width of the source, seen from the scene [degrees]; a larger one blurs shadows more
};

/// Settings of all pictures of a run: environment, exposure and display of heat.
struct Stage {
  /// The quantity that a colour scale shows on cloth and ropes, in place of their colours.
  enum class Heat { none, strain, speed };
  enum class Look { studio, stage, daylight, clay, wire, strain };
  Vec3 up{0, 0, 1};
  Look look = Look::studio;
  // If one of the next three values is absent, `look` determines it.
  std::optional<Vec3> sky_color;     ///< colour of the light from above, sRGB; without a floor, also tints the
                                     ///< backdrop if that of the look is grey
  std::optional<Vec3> ground_color;  ///< sRGB; light reflected from below
  /// Fraction of the light that comes from the surroundings, 0 to 1; the rest comes from the lights.
  std::optional<double> sky_intensity;
  double exposure = 0;     ///< exposure compensation; positive: brighter [stops]
  double motion_blur = 0;  ///< shutter angle [degrees]; 360 is the time of a frame; 0: everything is sharp
  Heat heat = Heat::none;
  double heat_max = 0;  ///< value of the hottest colour: strain, or speed [m/s]; 0: maximum of each frame
};

/// Name of the vertex property in which files store the heat; empty for Heat::none.
inline std::string_view name_of(Stage::Heat heat) {
  constexpr std::string_view kNames[] = {"", "strain", "speed"};
  return kNames[static_cast<std::size_t>(heat)];
}

/// The data of one frame. Never changes after it is made, so that threads can share it.
struct FrameSnapshot {
  int frame = 0;    ///< number k, from 0
  double time = 0;  ///< k / fps [s]
  std::shared_ptr<const Stage> stage;
  std::vector<std::shared_ptr<const Surface>> surfaces;
  std::vector<SurfaceState> states;  ///< one per surface
  std::vector<Camera> cameras;       ///< cameras of the scene; may be empty
  std::vector<Light> lights;         ///< lights of the scene; may be empty
};

using SnapshotPtr = std::shared_ptr<const FrameSnapshot>;

}  // namespace weft::frame
