// Shapes of obstacles. All lengths are in [m].
#pragma once

#include <filesystem>
#include <variant>

#include "core/types.hpp"

namespace weft::scene {

enum class FileUp { as_file, x, y, z };

struct Sphere {
  double radius = 0.5;
};
struct BoxShape {
  Vec3 size{1, 1, 1};
  double bevel = 0;
};
struct Cone {
  double radius = 0.5, height = 1;
};  ///< base at -height/2, axis along the up axis
struct Torus {
  double radius = 0.5, tube_radius = 0.15;
};
struct Cylinder {
  double radius = 0.5, height = 1;
};
struct HalfPipe {
  double radius = 1, length = 2, thickness = 0.05;
};  ///< open upward; length: along x
struct Plane {
  Vec2 size{20, 20};
  bool infinite = true;
};  ///< drawn to the horizon if infinite
struct MeshFile {
  std::filesystem::path path;
  double scale = 1;
  FileUp up = FileUp::as_file;
};  ///< path is absolute after checking

using Shape = std::variant<Sphere, BoxShape, Cone, Torus, Cylinder, HalfPipe, Plane, MeshFile>;

}  // namespace weft::scene
