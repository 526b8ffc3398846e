// All bodies that collide (cloths, ropes, rigid bodies, obstacles), in one numbering of vertices and triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/types.hpp"
#include "physics/collision/hierarchy/surface.hpp"

namespace weft::collision {

/// Collision properties of a body.
struct BodyTraits {
  bool deformable = false;  ///< true: its vertices are particles, which the solve moves
  double thickness = 0;     ///< contact thickness [m]; activation distance of two bodies: at most the mean of theirs
  double friction = 0;      ///< Coulomb coefficient; see ContactMaterial
  bool may_move = true;     ///< false: its vertices never leave their positions at the start of the run
  bool rigid = false;       ///< true: its vertices keep their distances from each other
  Index frame = -1;  ///< if deformable and rigid: first of its four frame particles (mesh::RigidFrame); else −1
};

/// Some vertices of a body, with a thickness and friction of their own.
struct Patch {
  std::span<const std::uint8_t> vertices;  ///< one flag per vertex of the body; 1: belongs to the patch
  double thickness = 0;                    ///< contact thickness [m]
  double friction = 0;                     ///< Coulomb coefficient; see ContactMaterial
};

/// Contact material of a vertex. Each body has one material for its vertices outside patches, then one for each patch.
/// The friction of two materials is the geometric mean of their coefficients, unless ContactParameters::friction has
/// coefficients for their bodies.
struct ContactMaterial {
  std::size_t body = 0;
  double thickness = 0, friction = 0;  ///< [m], Coulomb coefficient
};

/// Owns the triangles of all bodies; the other parts of the engine hold spans of them. Vertex
/// numbers are indices into the position arrays. The particles come first in these arrays: the
/// vertices of cloths, and of rigid bodies that forces move. So add cloths first, then these rigid
/// bodies, then obstacles.
class Bodies {
 public:
  Bodies() = default;
  Bodies(Bodies&&) = default;  // not copyable: a copy would view the triangles of the original
  Bodies& operator=(Bodies&&) = default;

  /// Adds a body. `triangles`: vertex numbers within the body, 0 to vertex_count − 1. `in_front`: number of further
  /// positions of the body, which come before its vertices and belong to no triangle, such as the frame particles of a
  /// rigid body. Flags of `patches` and entries of `limbs` begin with these positions. If several patches contain a
  /// vertex, the last of them counts. `limbs`: limb number of each vertex, counted from 0; empty: the body has one
  /// limb. Limbs are parts of a character, such as arms, that may touch or overlap.
  void add(std::span<const std::array<Index, 3>> triangles, Index vertex_count, const BodyTraits& traits,
           std::span<const Patch> patches = {}, std::span<const Index> limbs = {}, Index in_front = 0);

  std::size_t size() const { return traits_.size(); }
  const BodyTraits& operator[](std::size_t body) const { return traits_[body]; }

  /// The spans are valid until the next add(), even if this object is moved.
  std::span<const Triangle> triangles() const { return triangles_; }
  std::span<const Surface> surfaces() const { return surfaces_; }
  /// Surfaces that can collide with themselves: deformable and not rigid. They come first.
  std::span<const Surface> deformable() const { return std::span(surfaces_).first(self_colliding_count_); }

  Index vertex_count() const { return static_cast<Index>(body_of_.size()); }
  const std::vector<std::size_t>& body_of_vertices() const { return body_of_; }
  std::size_t body_of(Index vertex) const { return body_of_[vertex]; }

  /// Limb of each vertex, numbered within its body.
  const std::vector<Index>& limb_of_vertices() const { return limb_of_; }

  /// All contact materials. Without patches: one for each body, in the order of the bodies.
  const std::vector<ContactMaterial>& materials() const { return materials_; }
  /// Contact material of a vertex, as an index into materials().
  std::size_t material_of(Index vertex) const { return material_of_[vertex]; }

  /// Index of the first triangle with these corners, in any order, within the body of corners[0].
  /// Returns the number of triangles of that body if there is none. To find the first triangle at
  /// an edge, repeat one end of the edge.
  Index triangle_of(const Triangle& corners) const;

  /// The elements of `values` that belong to this body. `values` has one element per vertex of all
  /// bodies.
  template <class T>
  std::span<T> part(std::size_t body, std::span<T> values) const {
    return values.subspan(surfaces_[body].first_vertex, surfaces_[body].vertex_count);
  }

 private:
  std::vector<BodyTraits> traits_;
  std::vector<Triangle> triangles_;
  std::vector<Surface> surfaces_;
  std::vector<std::size_t> body_of_;  // per vertex
  std::vector<Index> limb_of_;        // per vertex
  std::vector<ContactMaterial> materials_;
  std::vector<std::size_t> material_of_;  // per vertex
  std::size_t self_colliding_count_ = 0;  // number of surfaces in deformable()
};

}  // namespace weft::collision
