// Coordinates of pictures on a drawn mesh, and the holes that pictures cut into the mesh.
#pragma once

#include <span>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/opacity.hpp"
#include "film/render/shaded_mesh.hpp"

namespace weft::render {

/// Consecutive triangles with the same appearance.
struct PaintedRange {
  std::size_t first = 0, count = 0;
  const frame::Appearance* look = nullptr;
};

/// Data of a painted surface in addition to its drawn mesh.
struct PaintedMesh {
  std::vector<Eigen::Vector2f> places;  ///< per drawn vertex: paint coordinates (Surface::paint_uv or uv)
  std::vector<PaintedRange> ranges;
};

/// Makes the data of a painted surface. In `mesh`, splits vertices whose corners have different paint coordinates, as
/// at seams, and sorts the triangles by part.
PaintedMesh make_painted_mesh(const frame::Surface& surface, ShadedMesh& mesh);

/// Whether the picture covers the colour of the surface, which shows beside it and through its transparent parts.
/// Otherwise, the picture is multiplied by the colour.
bool covers_color(const frame::Paint& paint);

/// The holes of a painted mesh, for passes on the CPU.
class Holes {
 public:
  /// `opacity`: per range, the opacity of its picture; null if the range has no holes.
  Holes(const PaintedMesh& mesh, std::vector<const Opacity*> opacity);

  /// Whether any range has holes.
  bool any() const;
  /// Opacity of the triangles of a range; null if they have no holes.
  const Opacity* opacity(std::size_t range) const { return opacity_[range]; }
  std::span<const PaintedRange> ranges() const { return mesh_->ranges; }
  /// Coordinates of a drawn vertex in the picture of a range (0 to 1, see Paint::texture_from_uv).
  Eigen::Vector2f place(std::size_t range, Index vertex) const;

 private:
  const PaintedMesh* mesh_;
  std::vector<const Opacity*> opacity_;
};

}  // namespace weft::render
