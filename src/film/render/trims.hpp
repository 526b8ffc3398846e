// Borders and seams of cloth, from which hems, stitches and visible edge thickness are drawn.
#pragma once

#include <span>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/shaded_mesh.hpp"
#include "film/render/view.hpp"

namespace weft::render {

inline constexpr float kNoTrim = 1e3f;

/// Distances from a point to the nearest line of each kind, in rest coordinates [m]; kNoTrim if there is none. Two
/// borders that meet at a corner have different kinds: across the corner, each distance can be interpolated linearly,
/// but not their minimum. (A closed border with an odd number of sides has one corner with a single kind.)
struct Trim {
  enum Kind { border, other_border, seam };
  static constexpr int kKinds = 3;
  std::array<float, kKinds> distance{kNoTrim, kNoTrim, kNoTrim}, along{};  ///< along: position along that line [m]

  float from_border() const { return std::min(distance[border], distance[other_border]); }
};

/// Borders and seams of the rest shape, the same in all frames.
class Trims {
 public:
  /// Uses the surface's rest coordinates; without them, all trims are kNoTrim.
  explicit Trims(const frame::Surface& surface);

  /// The trim at a vertex of the surface, and at the midpoint of an edge.
  Trim at(Index vertex) const;
  Trim middle(Index a, Index b) const;

  /// A border edge: it belongs to a single triangle, and runs from a to b in that triangle's orientation.
  struct Rim {
    Index a, b;
    std::int32_t triangle;
  };
  std::span<const Rim> rims() const { return rims_; }

 private:
  struct Segment {
    Index a, b;              // indices of places
    Index from, to;          // indices of vertices
    double start = 0;        // arc length of its start along its border or seam [m]
    bool other = false;      // is an `other_border`
    std::int32_t twin = -1;  // same edge on the other side of a seam
  };
  /// All lines of one kind, with lookup by place.
  struct Lines {
    std::vector<Segment> segments;
    std::vector<std::int32_t> nearest;          // by place; -1 if there is none
    std::vector<std::vector<std::int32_t>> at;  // by place: segments that begin or end there
  };
  struct Place {
    double distance = kNoTrim, along = 0;
  };
  Place place(const Lines& lines, std::int32_t segment, const Vec2& at) const;
  Lines lines(std::vector<Segment> segments, std::span<const std::vector<Index>> neighbors) const;
  std::vector<Triangle> find_places(const frame::Surface& surface);
  Trim trim(const Vec2& at, std::span<const Index> near) const;

  std::vector<Vec2> places_;                   // positions of vertices in their panels [m]
  std::vector<std::int32_t> part_;             // by place: its panel
  std::vector<std::vector<Index>> places_of_;  // by vertex; empty without rest coordinates
  std::vector<Rim> rims_;
  std::array<Lines, Trim::kKinds> lines_;
};

/// The visible thickness at the edge of cloth: a strip along each border, from front to back.
struct RimStrip {
  std::vector<Vec3> positions, normals;
  std::vector<Index> source;        ///< per position: the argument's vertex at or behind which it lies
  std::vector<Triangle> triangles;  ///< indices into positions, from 0
  std::vector<std::int32_t> owner;  ///< by triangle: the triangle of the surface at its border
};

/// Width of the strips [m]: the thickness of the edge, doubled if it is folded to a hem. Reduced if it covers less than
/// 2.5 pixels in a picture with `rows` rows; 0 if less than about a pixel would remain, because thinner strips break
/// into dots.
double rim_width(const frame::Appearance& look, std::span<const Vec3> positions, const View& view, int rows);

/// The strips of a surface in one frame, `thickness` [m] wide; `normals` by vertex.
RimStrip rim_strip(std::span<const Trims::Rim> rims, std::span<const Vec3> positions, std::span<const Vec3> normals,
                   double thickness);

}  // namespace weft::render
