// Borders and seams of cloth, along which hems, stitches and the thickness of the edge are drawn.
#pragma once

#include <span>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/shaded_mesh.hpp"
#include "film/render/view.hpp"

namespace weft::render {

inline constexpr float kNoTrim = 1e3f;  ///< distance if there is no border or seam [m]

/// Distances from a point to the nearest line (border or seam) of each kind, in rest coordinates [m]; kNoTrim if there
/// is none. The borders on both sides of a corner have different kinds, `border` and `other_border`, because near the
/// corner each distance can be interpolated linearly, but not their minimum. (If a closed border has an odd number of
/// sides, both sides of one of its corners have the same kind.)
struct Trim {
  enum Kind { border, other_border, seam };
  static constexpr int kKinds = 3;
  std::array<float, kKinds> distance{kNoTrim, kNoTrim, kNoTrim}, along{};  ///< along: position along that line [m]

  float from_border() const { return std::min(distance[border], distance[other_border]); }
};

/// The borders and seams of a surface in its rest shape. They are the same in all frames.
class Trims {
 public:
  /// Measures in the rest coordinates of the surface. If it has none, all distances are kNoTrim.
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
    Index a, b;              // ends, as indices into places_
    Index from, to;          // ends, as indices of vertices
    double start = 0;        // arc length of its start along its border or seam [m]
    bool other = false;      // is an `other_border`
    std::int32_t twin = -1;  // index of the same edge on the other side of a seam; -1: none
  };
  /// All lines of one kind, with lookup by index into places_ ("by place").
  struct Lines {
    std::vector<Segment> segments;
    std::vector<std::int32_t> nearest;          // by place: nearest segment; -1 if there is none
    std::vector<std::vector<std::int32_t>> at;  // by place: segments that begin or end there
  };
  /// Distance of a point from a segment, and arc length of the nearest point of the segment along its line [m].
  struct Place {
    double distance = kNoTrim, along = 0;
  };
  Place place(const Lines& lines, std::int32_t segment, const Vec2& at) const;
  Lines lines(std::vector<Segment> segments, std::span<const std::vector<Index>> neighbors) const;
  std::vector<Triangle> find_places(const frame::Surface& surface);
  Trim trim(const Vec2& at, std::span<const Index> near) const;

  std::vector<Vec2> places_;                   // positions of vertices in their flat panels [m], see find_places()
  std::vector<std::int32_t> part_;             // by place: its panel
  std::vector<std::vector<Index>> places_of_;  // by vertex; empty without rest coordinates
  std::vector<Rim> rims_;
  std::array<Lines, Trim::kKinds> lines_;
};

/// The gap between two consecutive pairs of a closure (frame::Surface::closures): its sides run from a[0] to a[1], as
/// an edge of `triangle` in its orientation, and from b[0] to b[1].
struct Slit {
  std::array<Index, 2> a, b;
  std::int32_t triangle;
};
std::vector<Slit> find_slits(const frame::Surface& surface);

/// A strip along each border, from the front to the back of the cloth, which shows its thickness.
struct RimStrip {
  std::vector<Vec3> positions, normals;
  std::vector<Index> source;        ///< per position: the border vertex at which, or behind which, it lies
  std::vector<Triangle> triangles;  ///< indices into positions, from 0
  std::vector<std::int32_t> owner;  ///< by triangle: the triangle of the surface at its border
};

/// Width of the strips [m]: the thickness of the cloth, doubled if the cloth has a hem. The width is reduced if it is
/// less than 2.5 pixels at the vertex nearest to the eye, in a picture with `rows` rows. If the reduced width is less
/// than a pixel, the result is 0, because such strips would appear as separate dots.
double rim_width(const frame::Appearance& look, std::span<const Vec3> positions, const View& view, int rows);

/// The strips of a surface in one frame, `thickness` [m] wide; `normals` by vertex.
RimStrip rim_strip(std::span<const Trims::Rim> rims, std::span<const Vec3> positions, std::span<const Vec3> normals,
                   double thickness);

}  // namespace weft::render
