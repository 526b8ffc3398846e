// All surfaces that collide, in one numbering of vertices and of triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/surface.hpp"
#include "core/types.hpp"

namespace weft::collision {

/// How a surface collides.
struct BodyTraits {
  bool deformable = false;  ///< particles, which the solve moves
  double thickness = 0;     ///< of these [m]; 0 for obstacles
  double friction = 0;      ///< Coulomb coefficient; of a pair: the geometric mean
  bool moving = true;       ///< false: its vertices stay where they are at the start
  bool rigid = false;       ///< its vertices keep their distances from each other
  Index frame = -1;         ///< of what is both: the first of the four particles that its vertices follow
};

/// A part of a surface that collides in another way than the rest of it.
struct Patch {
  std::span<const std::uint8_t> vertices;  ///< 1 for those that belong to it; one for each of the body
  double thickness = 0;                    ///< [m]
  double friction = 0;                     ///< Coulomb coefficient; of a pair: the geometric mean
};

/// What a vertex is covered with: of each body its own, and then its patches.
struct Skin {
  std::size_t body = 0;
  double thickness = 0, friction = 0;
};

/// The owner of the triangles, which all other parts of the engine view. Vertices of all bodies share one numbering,
/// that of the arrays of positions: particles first, so bodies that deform are added before the obstacles.
class Bodies {
 public:
  Bodies() = default;
  Bodies(Bodies&&) = default;  // a copy would view the triangles of the original
  Bodies& operator=(Bodies&&) = default;

  /// `triangles`: by vertex number within the body, from 0 to vertex_count − 1; `in_front`: positions of no triangle
  /// before them. Of patches that share vertices the last
  /// counts. `limbs`: of each vertex the limb that it is of, from 0; empty: one.
  void add(std::span<const std::array<Index, 3>> triangles, Index vertex_count, const BodyTraits& traits,
           std::span<const Patch> patches = {}, std::span<const Index> limbs = {}, Index in_front = 0);

  std::size_t size() const { return traits_.size(); }
  const BodyTraits& operator[](std::size_t body) const { return traits_[body]; }

  /// Valid until the next add(), and in a Bodies that this one is moved to.
  std::span<const Triangle> triangles() const { return triangles_; }
  std::span<const Surface> surfaces() const { return surfaces_; }
  /// The surfaces of those that can meet themselves: that deform and are not rigid. They come first.
  std::span<const Surface> deformable() const { return std::span(surfaces_).first(deformable_); }

  Index vertex_count() const { return static_cast<Index>(body_of_.size()); }
  const std::vector<std::size_t>& body_of_vertices() const { return body_of_; }
  std::size_t body_of(Index vertex) const { return body_of_[vertex]; }

  /// Of each vertex, numbered within its body. Limbs of a body may come to lie against each other, and in each other.
  const std::vector<Index>& limb_of_vertices() const { return limb_of_; }

  /// What vertices are covered with; without patches one for each body, in their order.
  const std::vector<Skin>& skins() const { return skins_; }
  std::size_t skin_of(Index vertex) const { return skin_of_[vertex]; }

  /// Number within its body of a triangle with these corners, an edge's second end being named twice.
  Index triangle_of(const Triangle& corners) const;

  /// The part of a global array that is of this body.
  template <class T>
  std::span<T> part(std::size_t body, std::span<T> values) const {
    return values.subspan(surfaces_[body].first_vertex, surfaces_[body].vertex_count);
  }

 private:
  std::vector<BodyTraits> traits_;
  std::vector<Triangle> triangles_;
  std::vector<Surface> surfaces_;
  std::vector<std::size_t> body_of_;  // per vertex
  std::vector<Index> limb_of_;
  std::vector<Skin> skins_;
  std::vector<std::size_t> skin_of_;  // per vertex
  std::size_t deformable_ = 0;
};

}  // namespace weft::collision
