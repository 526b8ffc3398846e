// The data of one frame. The renderer, the mesh writer and the frame cache get nothing else from the simulation.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/threads.hpp"
#include "core/types.hpp"

namespace weft::frame {

enum class ObjectKind { cloth, obstacle, character, rope };

/// An object of a run, for lists.
struct ObjectInfo {
  std::string name;
  ObjectKind kind;
  std::size_t vertices = 0, faces = 0;
};

/// A picture for surfaces: rows from the top, bytes R G B A per pixel, colours in sRGB, alpha not premultiplied.
struct Texture {
  int width = 0, height = 0;  ///< pixels, from 1
  std::vector<std::uint8_t> rgba;
};

/// A picture on a surface, and its mapping.
struct Paint {
  enum class Wrap { repeat, clamp, mirror, once };  ///< once: no picture beyond the edge
  enum class Alpha { ignored, over_color, cutout };
  std::shared_ptr<const Texture> texture;
  /// Maps (u, v, 1) of the surface to the picture: 0 to 1 from left to right and from bottom to top.
  Eigen::Matrix<double, 2, 3> texture_from_uv = Eigen::Matrix<double, 2, 3>::Identity();
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  Alpha alpha = Alpha::ignored;  ///< cutout: transparent parts are holes
};

/// Optical properties of cloth besides its colour, each from 0 to 1.
struct Finish {
  double gloss = 0.15;         ///< highlights of threads, wide across the threads and narrow along them
  double warp_fraction = 0.5;  ///< fraction of warp among the threads on top: 0.5 for a plain weave, more for satin
  double fuzz = 0.4;           ///< protruding fibres, which scatter light at grazing angles
  double sheer = 0.25;         ///< light transmitted from the other side
  Threads threads = Threads::plain;
};

/// The appearance of a surface. Colours are sRGB, 0 to 1.
struct Appearance {
  Vec3 color{0.8, 0.8, 0.8};
  Vec3 back_color{0.8, 0.8, 0.8};  ///< cloth only: colour of the side away from weft × warp
  double roughness = 0.6;          ///< 0 mirror-like to 1 matte
  double thread_spacing = 0;       ///< distance of drawn threads, or lay length of a rope [m]; 0: draws no threads
  Finish finish;                   ///< cloth only
  double metal = 0;                ///< not for cloth: fraction of metal; at 1, all light is reflected, in `color`
  double coat = 0;                 ///< not for cloth: strength of a clear coat, 1 as glass
  double thickness = 0;            ///< thickness of cloth, visible at its borders, or diameter of a rope [m]; 0: none
  double hem = 0;                  ///< width of the folded and sewn borders of cloth [m]; 0: borders are cut
  bool checker = false;            ///< faint grid of 0.5 m tiles on the floor, to give scale
  Paint paint;                     ///< multiplied by `color`, or over it: Alpha::over_color, or ignored with Wrap::once
  /// true: the back shows the picture too, paler by `back_paleness`; false: the back has back_color
  bool back_painted = true;
  double back_paleness = 0;  ///< 0: as the front, 1: white
};

/// A group of triangles of a surface with its own appearance: a panel of a garment, a material of a character's file.
struct SurfacePart {
  std::string name;
  Appearance appearance;  ///< its roughness, threads and checker equal those of the surface
};

/// The constant data of an object over a run, shared by all snapshots.
struct Surface {
  std::string name;
  ObjectKind kind = ObjectKind::cloth;
  bool visible = true;
  bool infinite_floor = false;                  ///< a ground plane: drawn to the horizon; computed cameras ignore it
  std::vector<std::array<Index, 3>> triangles;  ///< for drawing and collision; counter-clockwise seen from the front
  std::vector<std::uint8_t> passed_through;     ///< per triangle: 1 if cloth passes through it; empty: none
  std::vector<std::array<Index, 4>> quads;      ///< faces as simulated, if they are quads; else empty
  std::vector<Vec2> uv;                         ///< per vertex: rest coordinates (weft, warp) [m]; empty if it has none
  /// Bounding box in world space [m]: for a body, of its motion from time 0 to the end of the scene; for a cloth, of
  /// its start. Absent: unknown.
  std::optional<Box3> run_bounds;
  /// Edges at which the normals of the two faces differ by more are drawn sharp [degrees] (180: all are smooth, as for
  /// cloth).
  double crease_angle = 30;
  Appearance appearance;
  std::vector<SurfacePart> parts;              ///< empty: all triangles have `appearance`
  std::vector<std::int32_t> part_of_triangle;  ///< per triangle: index into parts; empty if there are none
  /// Per triangle: coordinates of its corners for the paints, such as metres along the grain of a panel. Empty: `uv`
  /// applies.
  std::vector<std::array<Vec2, 3>> paint_uv;
};

/// Whether a surface has pictures, or parts of different colours.
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
  std::vector<float> heat;      ///< per vertex, in the unit of the chosen heat quantity; empty if none is chosen
};

/// A camera at one time.
struct Camera {
  std::string name;
  Vec3 position{0, -3, 1.5};  ///< [m]
  Vec3 target{0, 0, 0.5};     ///< point in the middle of the picture [m]
  double field_of_view = 35;  ///< vertical [degrees]; 0: computed (`track` only)
  double aperture = 0;        ///< f-number for a film 24 mm high; 0: everything is sharp
  double focus = 0;           ///< distance of the plane in focus along the view axis [m]; 0: that of the target

  /// placed: as given above. Cameras of the other kinds are computed from all frames of a run. whole: stands still or
  /// orbits, with everything in view. follow: moves along with the subjects at a constant distance. close: moves along
  /// with them as close as they allow. track: stands at `position` and turns toward the subjects.
  enum class Kind { placed, whole, follow, close, track };
  Kind kind = Kind::placed;
  /// Names of surfaces. If empty: for `whole` all visible surfaces except infinite floors; for the other kinds all
  /// characters, else all cloths, else the same as for `whole`.
  std::vector<std::string> subjects = {};
  double azimuth = 33;     ///< of the camera position at this time, from the front to the right [degrees]
  double elevation = 17;   ///< of the camera position above the subjects [degrees]
  double margin = 0.14;    ///< fraction of each half of the picture that is left free around the subjects
  double smoothing = 0.5;  ///< time over which the paths of subjects and camera are smoothed [s]
};

/// Maximum number of lights of which pictures show the effect; further ones are ignored. Each costs rays at every
/// pixel.
inline constexpr int kMaxLights = 4;

/// A light at one time. Sun: parallel light along `direction`. Spot: from `position` toward `target`.
struct Light {
  enum class Kind { sun, spot };
  std::string name;
  Kind kind = Kind::sun;
  Vec3 direction{-0.4, -0.5, -1};  ///< in which the light travels (sun)
  Vec3 position{0, 0, 5};          ///< [m] (spot)
  Vec3 target{0, 0, 0};            ///< [m] (spot)
  double cone_angle = 45;          ///< full opening [degrees] (spot)
  Vec3 color{1, 1, 1};             ///< sRGB
  double intensity = 1;            ///< at 1, a white matte surface that faces the light appears white
  double softness = 2;             ///< angular width of the source seen from the scene [degrees]; more: softer shadows
};

/// Surroundings that stay the same over a run.
struct Stage {
  enum class Heat { none, strain, speed };
  enum class Look { studio, stage, daylight, clay, wire, strain };
  Vec3 up{0, 0, 1};
  Look look = Look::studio;
  // If absent, the look determines the value.
  std::optional<Vec3> sky_color;     ///< sRGB; light from above and background near the horizon
  std::optional<Vec3> ground_color;  ///< sRGB; light reflected from below
  /// Fraction of the light that comes from the surroundings, 0 to 1; the rest comes from the lights.
  std::optional<double> sky_intensity;
  double exposure = 0;     ///< exposure compensation; positive: brighter [stops]
  double motion_blur = 0;  ///< shutter angle [degrees, 360 per frame]; 0: everything is sharp
  Heat heat = Heat::none;
  double heat_max = 0;  ///< value at the hot end of the scale (strain, or speed [m/s]); 0: the frame's largest
};

/// One frame, never changed after it is made.
struct FrameSnapshot {
  int frame = 0;    ///< number k
  double time = 0;  ///< k / fps [s]
  std::shared_ptr<const Stage> stage;
  std::vector<std::shared_ptr<const Surface>> surfaces;
  std::vector<SurfaceState> states;  ///< one per surface
  std::vector<Camera> cameras;       ///< of the scene; may be empty
  std::vector<Light> lights;         ///< of the scene; may be empty
};

using SnapshotPtr = std::shared_ptr<const FrameSnapshot>;

}  // namespace weft::frame
