// Where cloth ends and where its panels are sewn together: what hems, stitches and the thickness of its edge go by.
#pragma once

#include <span>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "render/shaded_mesh.hpp"
#include "render/view.hpp"

namespace weft::render {

inline constexpr float kNoTrim = 1e3f;

/// How far a point is from the nearest line of each kind, in rest coordinates [m]; kNoTrim where there is no such
/// thing. Borders that meet at a corner are of two kinds, so that both distances are linear across it: their minimum is
/// not.
struct Trim {
  enum Kind { border, other_border, seam };
  static constexpr int kKinds = 3;
  std::array<float, kKinds> distance{kNoTrim, kNoTrim, kNoTrim}, along{};  ///< along: the place along that line

  float from_border() const { return std::min(distance[border], distance[other_border]); }
};

/// Of the rest shape, so the same in all frames.
class Trims {
 public:
  /// Of a surface with rest coordinates; of one without them all is kNoTrim.
  explicit Trims(const frame::Surface& surface);

  /// Of a vertex of the surface, and of the middle of an edge between two.
  Trim at(Index vertex) const;
  Trim middle(Index a, Index b) const;

  /// An edge of one triangle only, in the way of that.
  struct Rim {
    Index a, b;
    std::int32_t triangle;
  };
  std::span<const Rim> rims() const { return rims_; }

 private:
  struct Segment {
    Index a, b;              // places
    Index from, to;          // vertices
    double start = 0;        // of it along its border or seam [m]
    bool other = false;      // of two sides of a border that meet at a corner, one is
    std::int32_t twin = -1;  // the same edge on the other side of a seam
  };
  /// What one kind of lines is to all places.
  struct Lines {
    std::vector<Segment> segments;
    std::vector<std::int32_t> nearest;          // by place, -1 where there is none
    std::vector<std::vector<std::int32_t>> at;  // by place: those that begin or end there
  };
  struct Place {
    double distance = kNoTrim, along = 0;
  };
  Place place(const Lines& lines, std::int32_t segment, const Vec2& at) const;
  Lines lines(std::vector<Segment> segments, std::span<const std::vector<Index>> neighbors) const;
  std::vector<Triangle> lay_out(const frame::Surface& surface);
  Trim trim(const Vec2& at, std::span<const Index> near) const;

  std::vector<Vec2> places_;                   // where vertices lie in their panels [m]
  std::vector<std::int32_t> part_;             // by place
  std::vector<std::vector<Index>> places_of_;  // by vertex; empty without rest coordinates
  std::vector<Rim> rims_;
  std::array<Lines, Trim::kKinds> lines_;
};

/// The thickness that the edge of cloth shows: a strip along each border, from the front to the back.
struct RimStrip {
  std::vector<Vec3> positions, normals;
  std::vector<Index> source;        ///< the vertex that each is at, or behind
  std::vector<Triangle> triangles;  ///< of these, from 0
  std::vector<std::int32_t> owner;  ///< by triangle: that of its rim
};

/// Width of the strips [m]: as thick as the edge is, twice so where it is folded to a hem; thinner where that is less
/// than 2.5 pixels of a picture of so many rows, and 0 where a pixel would be left, as it would break into dots.
double rim_width(const frame::Appearance& look, std::span<const Vec3> positions, const View& view, int rows);

/// Of a surface as it lies in a frame, `thickness` [m] wide; `normals` by vertex.
RimStrip rim_strip(std::span<const Trims::Rim> rims, std::span<const Vec3> positions, std::span<const Vec3> normals,
                   double thickness);

}  // namespace weft::render
