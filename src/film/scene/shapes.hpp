// Shapes of obstacles. All lengths are in metres.
#pragma once

#include <filesystem>
#include <variant>

#include "core/types.hpp"

namespace weft::scene {

/// Axis of a file that points up. `as_file`: as the file states it.
enum class FileUp { as_file, x, y, z };

struct Sphere {
  double radius = 0.5;
};
struct BoxShape {
  Vec3 size{1, 1, 1};
  double bevel = 0;  ///< radius of the rounded edges
};
/// A cone whose axis is the up axis. Its origin is at half the height, its base at −height / 2.
struct Cone {
  double radius = 0.5, height = 1;
};
struct Torus {
  double radius = 0.5, tube_radius = 0.15;  ///< radius: from the centre to the middle of the tube
};
struct Cylinder {
  double radius = 0.5, height = 1;
};
/// Half of a tube, open at the top, with its length along x. `radius`: inner radius.
struct HalfPipe {
  double radius = 1, length = 2, thickness = 0.05;
};
struct Plane {
  Vec2 size{20, 20};     ///< the plane collides only within its size
  bool infinite = true;  ///< whether it is drawn up to the horizon
};
struct MeshFile {
  std::filesystem::path path;   ///< absolute
  double scale = 1;             ///< factor on all lengths of the file
  FileUp up = FileUp::as_file;  ///< up axis of the file
};

using Shape = std::variant<Sphere, BoxShape, Cone, Torus, Cylinder, HalfPipe, Plane, MeshFile>;

}  // namespace weft::scene
