// Where in the picture something ends, in tiles: what lies elsewhere need not be drawn a second time for its outlines.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace weft::render {

/// A flag for each tile of kTile x kTile pixels of a picture.
class OutlineTiles {
 public:
  static constexpr int kTile = 8;

  /// Flags the tiles of a picture of `width` x `height` distances along the view axis [m], row by row, in which a pixel
  /// lies where 1 / distance, linear over the picture of any plane, has a kink or a step; shaders/inside.frag looks
  /// for the same.
  OutlineTiles(std::span<const float> distances, int width, int height);

  /// True where a flagged tile touches the rectangle of pixels [x0, x1] x [y0, y1]; parts outside the picture count
  /// as their nearest tile.
  bool any(float x0, float y0, float x1, float y1) const;

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace weft::render
