// The drawn surfaces, prepared for intersection with rays. Embree builds and traverses the bounding volume hierarchy.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>

#include "film/render/shaded_mesh.hpp"

namespace weft::render {

/// Eight numbers, one for each ray of a packet.
inline constexpr int kLanes = 8;
using Lanes = Eigen::Array<float, kLanes, 1>;
/// Eight conditions: -1 for true, 0 for false.
using Mask = Eigen::Array<int, kLanes, 1>;
inline Mask mask(const Eigen::Array<bool, kLanes, 1>& conditions) {
  return -conditions.cast<int>();
}

/// Eight vectors.
struct Lanes3 {
  Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero();

  Eigen::Vector3f at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(int lane, const Eigen::Vector3f& v) { x[lane] = v.x(), y[lane] = v.y(), z[lane] = v.z(); }
  friend Lanes3 operator+(const Lanes3& a, const Lanes3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Lanes3 operator*(const Lanes& a, const Lanes3& b) { return {a * b.x, a * b.y, a * b.z}; }
};
inline Lanes dot(const Lanes3& a, const Lanes3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A packet of eight rays.
struct Rays {
  Lanes3 origin, direction;            ///< [m]
  Lanes end = Lanes::Constant(1e30f);  ///< largest distance, in lengths of `direction`
  Mask wanted = Mask::Zero();          ///< rays to trace; all others hit nothing
  unsigned seed = 0;                   ///< seed of the random choice of rays that pass through translucent cloth
};

/// The nearest hit of each ray of a packet.
struct Hits {
  static constexpr int kNone = -1;
  std::array<int, kLanes> mesh;  ///< index of the mesh; kNone: the ray hits nothing
  std::array<std::size_t, kLanes> triangle;
  Lanes distance;  ///< in lengths of the ray's direction; 0 if the ray hits nothing
  Lanes3 normal;   ///< unit length, on the side from which the corners run counter-clockwise; +z if it hits nothing
};

class RayScene {
 public:
  RayScene();
  ~RayScene();

  /// Replaces the surfaces. Copies positions and triangles. But the triangles and Holes of a mesh with holes must stay
  /// valid while rays are traced, because they give the opacity at hits. Throws std::bad_alloc, or Error(internal) with
  /// the number of Embree's error.
  void build(std::span<const DrawnMesh> meshes);

  /// 1 for each wanted ray that a surface stops, else 0. A surface with holes or an opacity below 1
  /// stops a ray at random, with a probability equal to the opacity at the hit point.
  Lanes blocked(const Rays& rays) const;
  /// The nearest surface that stops each wanted ray. Surfaces stop rays at random as in blocked().
  Hits nearest(const Rays& rays) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace weft::render
