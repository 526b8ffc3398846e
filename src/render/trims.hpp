// Where cloth ends and where its panels are sewn together: what hems, stitches and the thickness of its edge go by.
#pragma once

#include <span>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "render/shaded_mesh.hpp"
#include "render/view.hpp"

namespace weft::render {

/// How far a point is from what lies nearest to it, in rest coordinates [m]; kNoTrim where there is no such thing.
struct Trim {
  float border = 0;  ///< from the border of the cloth
  float seam = 0;    ///< from a seam between two panels
  float along = 0;   ///< the place along the nearer of both
};
inline constexpr float kNoTrim = 1e3f;

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
    Index a, b;
    double start;  // of it along its border or seam [m]
  };
  /// What one kind of lines is to all vertices.
  struct Lines {
    std::vector<Segment> segments;
    std::vector<std::int32_t> nearest;  // by vertex, -1 where there is none
  };
  struct Place {
    double distance = kNoTrim, along = 0;
  };
  Place place(const Lines& lines, std::int32_t segment, const Vec2& at) const;
  Lines lines(std::vector<Segment> segments, std::span<const std::vector<Index>> neighbors) const;
  Trim trim(const Vec2& at, std::span<const Index> near) const;

  std::vector<Vec2> uv_;
  std::vector<Rim> rims_;
  Lines borders_, seams_;
};

/// The thickness that the edge of cloth shows: a strip along each border, from the front to the back.
struct RimStrip {
  std::vector<Vec3> positions, normals;
  std::vector<Index> source;        ///< the vertex that each is at, or behind
  std::vector<Triangle> triangles;  ///< of these, from 0
  std::vector<std::int32_t> owner;  ///< by triangle: that of its rim
};

/// Width of the strips [m]: as thick as the edge is, twice so where it is folded to a hem; thinner where that is less
/// than two pixels of a picture of so many rows, and 0 from one on, as it would break into dots.
double rim_width(const frame::Appearance& look, std::span<const Vec3> positions, const View& view, int rows);

/// Of a surface as it lies in a frame, `thickness` [m] wide; `normals` by vertex.
RimStrip rim_strip(std::span<const Trims::Rim> rims, std::span<const Vec3> positions, std::span<const Vec3> normals,
                   double thickness);

}  // namespace weft::render
