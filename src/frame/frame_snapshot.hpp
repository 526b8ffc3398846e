// What one frame shows: the only thing that the renderer, the mesh writer and the frame cache ever see.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace weft::frame {

enum class ObjectKind { cloth, obstacle, character };

/// How a surface looks. Colours are sRGB, 0 to 1.
struct Appearance {
  Vec3 color{0.8, 0.8, 0.8};
  Vec3 back_color{0.8, 0.8, 0.8};  ///< cloth only: the side from which weft × warp points away
  double roughness = 0.6;          ///< 0 mirror-like to 1 matte
  double thread_spacing = 0;       ///< distance of two threads of the drawn weave [m]; 0 draws none
  bool checker = false;            ///< faint grid of 0.5 m tiles on the floor, to give scale
};

/// The part of an object that stays the same over a run; shared by all its snapshots.
struct Surface {
  std::string name;
  ObjectKind kind = ObjectKind::cloth;
  bool visible = true;
  bool infinite_floor = false;                  ///< a ground plane: drawn to the horizon, left out of automatic framing
  std::vector<std::array<Index, 3>> triangles;  ///< drawn and collided with; counter-clockwise seen from the front
  std::vector<std::array<Index, 4>> quads;      ///< faces as simulated, if the object is made of quads; else empty
  std::vector<Vec2> uv;                         ///< per vertex: rest coordinates (weft, warp) [m]; empty if it has none
  double crease_angle = 30;  ///< degrees; sharper edges are drawn hard (180: all smooth, as for cloth)
  Appearance appearance;
};

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
  double field_of_view = 35;  ///< vertical, degrees
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
  Vec3 up{0, 0, 1};
  Vec3 sky_color{0.95, 0.97, 1.0};      ///< sRGB; light from above and background near the horizon
  Vec3 ground_color{0.78, 0.75, 0.71};  ///< sRGB; light reflected from below
  double sky_intensity = 0.45;  ///< share of all light that comes from the sky, 0 to 1; the lights give the rest
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
