// What one frame shows: the only thing that the renderer, the mesh writer and the frame cache ever see.
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

/// A picture to lay on surfaces: rows from the top, R G B A bytes a pixel, colours in sRGB, alpha not multiplied in.
struct Texture {
  int width = 0, height = 0;  ///< pixels, from 1
  std::vector<std::uint8_t> rgba;
};

/// A picture on a surface and how it is laid there.
struct Paint {
  enum class Wrap { repeat, clamp, mirror, once };  ///< once: nothing beyond the edge
  enum class Alpha { ignored, over_color, cutout };
  std::shared_ptr<const Texture> texture;
  /// From the surface's (u, v, 1) to the picture: 0 to 1 from left to right and from the bottom to the top.
  Eigen::Matrix<double, 2, 3> texture_from_uv = Eigen::Matrix<double, 2, 3>::Identity();
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  Alpha alpha = Alpha::ignored;  ///< cutout: transparent parts are holes
};

/// What cloth does with light beside showing its colour, each from 0 to 1.
struct Finish {
  double gloss = 0.15;      ///< highlights that threads give, wide across themselves and narrow along
  double warp_share = 0.5;  ///< of the threads that lie on top: 0.5 of a plain weave, more of a satin
  double fuzz = 0.4;        ///< fibres that stand out and catch light at grazing angles
  double sheer = 0.25;      ///< light that comes through from the other side
  Threads threads = Threads::plain;
};

/// How a surface looks. Colours are sRGB, 0 to 1.
struct Appearance {
  Vec3 color{0.8, 0.8, 0.8};
  Vec3 back_color{0.8, 0.8, 0.8};  ///< cloth only: the side from which weft × warp points away
  double roughness = 0.6;          ///< 0 mirror-like to 1 matte
  double thread_spacing = 0;       ///< distance of two threads of the drawn weave, lay of a rope [m]; 0 draws none
  Finish finish;                   ///< cloth only
  double metal = 0;                ///< not of cloth: 1 where all light is reflected in `color`, none scattered
  double coat = 0;                 ///< not of cloth: of a clear coat over it, 1 as of glass
  double thickness = 0;            ///< of the cloth itself, as its borders show it, or of a rope [m]; 0: none
  double hem = 0;                  ///< width to which borders of cloth are folded to the back and sewn [m]; 0: cut
  bool checker = false;            ///< faint grid of 0.5 m tiles on the floor, to give scale
  Paint paint;                     ///< its picture is multiplied by `color`, but where that shows through it
  bool back_painted = true;        ///< the back shows the picture too, paler by `back_paleness`; else back_color
  double back_paleness = 0;        ///< 0: as the front, 1: white
};

/// Triangles of a surface with colours of their own: a panel of a garment, a material of a character's file.
struct SurfacePart {
  std::string name;
  Appearance appearance;  ///< of which roughness, threads and checker are those of the surface
};

/// The part of an object that stays the same over a run; shared by all its snapshots.
struct Surface {
  std::string name;
  ObjectKind kind = ObjectKind::cloth;
  bool visible = true;
  bool infinite_floor = false;                  ///< a ground plane: drawn to the horizon, left out of automatic framing
  std::vector<std::array<Index, 3>> triangles;  ///< drawn and collided with; counter-clockwise seen from the front
  std::vector<std::uint8_t> passed_through;     ///< per triangle: 1 where cloth does not meet it; empty: it meets all
  std::vector<std::array<Index, 4>> quads;      ///< faces as simulated, if the object is made of quads; else empty
  std::vector<Vec2> uv;                         ///< per vertex: rest coordinates (weft, warp) [m]; empty if it has none
  /// World space [m]: all places to which a body moves in the run, those at which a cloth starts; absent: not known.
  std::optional<Box3> run_bounds;
  double crease_angle = 30;  ///< degrees; sharper edges are drawn hard (180: all smooth, as for cloth)
  Appearance appearance;
  std::vector<SurfacePart> parts;              ///< empty: all triangles look as `appearance` says
  std::vector<std::int32_t> part_of_triangle;  ///< per triangle, into parts; empty where there are none
  /// Per triangle: where its corners lie in what the paints go by, such as metres along the grain of a panel. Empty:
  /// `uv` of the vertices.
  std::vector<std::array<Vec2, 3>> paint_uv;
};

/// Whether pictures lie on a surface, or its parts differ in colour.
inline bool is_painted(const Surface& surface) {
  const Appearance& own = surface.appearance;
  return own.paint.texture || std::ranges::any_of(surface.parts, [&](const SurfacePart& part) {
           const Appearance& look = part.appearance;
           return look.paint.texture || look.color != own.color || look.back_color != own.back_color;
         });
}

/// The part that changes from frame to frame.
struct SurfaceState {
  std::vector<Vec3> positions;  ///< world space [m], one per vertex
  std::vector<float> heat;      ///< per vertex, in the unit of the chosen heat quantity; empty when none is asked for
};

/// A camera at one moment.
struct Camera {
  std::string name;
  Vec3 position{0, -3, 1.5};  ///< [m]
  Vec3 target{0, 0, 0.5};     ///< point in the middle of the picture [m]
  double field_of_view = 35;  ///< vertical, degrees; 0: to be found
  double aperture = 0;        ///< f-number, as of a film 24 mm high; 0: all is sharp
  double focus = 0;           ///< distance along the axis that is sharp [m]; 0: that of the target

  /// Placed as above, or found from all frames of a run: standing so that all of it is in view; going along with its
  /// subjects, at one distance or as close as they allow; standing at `position` and turning after them.
  enum class Kind { placed, whole, follow, close, track };
  Kind kind = Kind::placed;
  std::vector<std::string> subjects = {};  ///< names of surfaces; empty: the characters, else the cloths; whole: all
  double azimuth = 33;                     ///< of the eye at this moment, from the front to the right, degrees
  double elevation = 17;                   ///< above the subjects, degrees
  double margin = 0.14;                    ///< share of each half picture left free around the subjects
  double smoothing = 0.5;                  ///< of the ways of subjects and eye [s]
};

/// A light at one moment. Sun: parallel light from `direction`. Spot: from `position` toward `target`.
struct Light {
  enum class Kind { sun, spot };
  std::string name;
  Kind kind = Kind::sun;
  Vec3 direction{-0.4, -0.5, -1};  ///< the way the light travels (sun)
  Vec3 position{0, 0, 5};          ///< [m] (spot)
  Vec3 target{0, 0, 0};            ///< [m] (spot)
  double cone_angle = 45;          ///< full opening, degrees (spot)
  Vec3 color{1, 1, 1};             ///< sRGB
  double intensity = 1;            ///< 1: a white matte surface facing the light comes out white
  double softness = 2;             ///< width of the source: degrees seen from the scene; wider gives softer shadows
};

/// Surroundings that stay the same over a run.
struct Stage {
  enum class Heat { none, strain, speed };
  enum class Look { studio, stage, daylight, clay, wire, strain };
  Vec3 up{0, 0, 1};
  Look look = Look::studio;
  // Where absent, as the look has them.
  std::optional<Vec3> sky_color;        ///< sRGB; light from above and background near the horizon
  std::optional<Vec3> ground_color;     ///< sRGB; light reflected from below
  std::optional<double> sky_intensity;  ///< share of all light that comes from around, 0 to 1; the lights give the rest
  double exposure = 0;                  ///< stops by which the picture is brighter
  double motion_blur = 0;               ///< angle of the shutter [degrees of 360 a frame]; 0: all is sharp
  Heat heat = Heat::none;
  double heat_max = 0;  ///< value at the hot end of the scale (strain: 1, speed: m/s); 0 follows the frame's largest
};

/// One frame, never changed after it is made.
struct FrameSnapshot {
  int frame = 0;    ///< k
  double time = 0;  ///< k / fps [s]
  std::shared_ptr<const Stage> stage;
  std::vector<std::shared_ptr<const Surface>> surfaces;
  std::vector<SurfaceState> states;  ///< one per surface
  std::vector<Camera> cameras;       ///< those the scene names; may be empty
  std::vector<Light> lights;         ///< those the scene names; may be empty
};

using SnapshotPtr = std::shared_ptr<const FrameSnapshot>;

}  // namespace weft::frame
