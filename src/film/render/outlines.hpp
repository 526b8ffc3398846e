// Antialiasing: pixels in which a surface ends or folds get 16 samples. Each sample takes its colour from its own pixel
// or, if this pixel shows another surface or the other side of the fold, from a neighbouring pixel that shows the same
// surface as the sample.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "film/render/seen.hpp"
#include "film/render/shaded_mesh.hpp"
#include "film/render/view.hpp"

namespace weft::render {

/// Antialiasing on the CPU, because only a few thousand pixels need it; OpenGL would multisample all pixels.
class Outlines {
 public:
  Outlines(int width, int height);

  /// Antialiases `picture` (RGBA with 16 bits per channel, lowest row first) inside `area`. `seen`: distance and
  /// surface of each pixel. `meshes`: all surfaces except the floor; mesh i has the number kFirstSurface + i.
  void antialias(std::span<const Seen> seen, std::span<const DrawnMesh> meshes, const std::optional<Floor>& floor,
                 const View& view, const PixelArea& area, std::span<std::uint64_t> picture);

  /// Computes `surfaces`, the last picture without floor and backdrop, lowest row first: linear colours premultiplied
  /// by coverage; w: coverage. `unsmoothed`: the picture before antialias().
  void extract_surfaces(std::span<const Seen> seen, std::span<const std::uint64_t> unsmoothed,
                        std::vector<Eigen::Vector4f>& surfaces) const;

  /// Number of pixels of the last picture that have samples.
  std::size_t count() const { return pixels_.size(); }

 private:
  static constexpr int kSamples = 16;
  /// What the samples of one pixel show: 1 / distance [1/m] (0: nothing), the change of this value from pixel to pixel
  /// in the plane of the triangle [1/m], and the number of the surface (as Seen::surface).
  struct Samples {
    float nearness[kSamples] = {}, slope_x[kSamples] = {}, slope_y[kSamples] = {}, surface[kSamples] = {};
  };
  /// A vertex in the picture: pixels from the lower left corner, and 1 / distance [1/m].
  struct Vertex {
    float x, y, nearness;
  };
  struct Pixel {
    int x, y;
  };
  using Bits = std::uint64_t;

  void find_outlines(std::span<const Seen> seen, const PixelArea& area);
  void number_samples();
  void sample(const DrawnMesh& mesh, float surface, const View& view);
  /// Predicate for triangles without holes: every point is opaque.
  struct AlwaysOpaque {};
  template <class Shows = AlwaysOpaque>
  void sample(const Vertex& a, const Vertex& b, const Vertex& c, float surface, const Shows& shows = {});
  void sample_with_holes(const DrawnMesh& mesh, float surface, const View& view);
  void sample_floor(const Floor& floor, const View& view);
  std::array<std::size_t, kSamples> find_sources(std::size_t slot, std::span<const Seen> seen) const;
  Vertex to_picture(const Eigen::Vector4d& clip) const;

  int width_, height_, words_;  // words_: number of words of `bits_` in a row
  float kink_ = 0;              // minimum second difference of 1 / distance at a fold, relative to 1 / distance
  std::vector<Bits> bits_;      // a bit for each pixel with an outline
  std::vector<int> first_;      // for each word of `bits_`: index in `pixels_` of the first pixel of the word
  std::vector<Pixel> pixels_;
  std::vector<Samples> samples_;
  std::vector<std::uint64_t> resolved_;
  std::vector<float> nearness_;
  std::vector<Eigen::Vector4d> clip_;
  std::vector<Vertex> vertices_;
};

}  // namespace weft::render
