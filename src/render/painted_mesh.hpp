// Where pictures lie on a drawn mesh, and where they leave holes in it.
#pragma once

#include <span>
#include <vector>

#include "frame/frame_snapshot.hpp"
#include "render/opacity.hpp"
#include "render/shaded_mesh.hpp"

namespace weft::render {

/// Consecutive triangles of one look.
struct PaintedRange {
  std::size_t first = 0, count = 0;
  const frame::Appearance* look = nullptr;
};

/// What a painted surface has beside its drawn mesh.
struct PaintedMesh {
  std::vector<Eigen::Vector2f> places;  ///< per drawn vertex: what paints go by
  std::vector<PaintedRange> ranges;
};

/// Splits the drawn vertices whose corners lie at different places of the paint, as they do at seams, and sorts the
/// triangles by part.
PaintedMesh lay_paint(const frame::Surface& surface, ShadedMesh& mesh);

/// The holes of one drawn triangle, if it has any.
class Holes {
 public:
  /// `opacity` of the picture of each range, null where nothing is cut out.
  Holes(const PaintedMesh& mesh, std::vector<const Opacity*> opacity);

  bool any() const;
  /// How opaque triangles from one of `ranges` are; null where they have no holes.
  const Opacity* opacity(std::size_t range) const { return opacity_[range]; }
  std::span<const PaintedRange> ranges() const { return mesh_->ranges; }
  /// Place in the picture of a range of a drawn vertex.
  Eigen::Vector2f place(std::size_t range, Index vertex) const;

 private:
  const PaintedMesh* mesh_;
  std::vector<const Opacity*> opacity_;
};

}  // namespace weft::render
