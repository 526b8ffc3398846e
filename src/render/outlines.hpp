// Antialiasing: where surfaces end or fold, pixels are sampled 16 times, and each sample takes the colour of its own
// surface from the pixels around.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/seen.hpp"
#include "render/shaded_mesh.hpp"
#include "render/view.hpp"

namespace weft::render {

/// Works on the processor: a few thousand pixels of a picture have outlines, and OpenGL can only sample all of it.
class Outlines {
 public:
  Outlines(int width, int height);

  /// Antialiases `picture`, RGBA of 16 bits each with the lowest row first, inside `area`. `seen` tells what each of
  /// its pixels shows; `meshes` are all surfaces but the floor, mesh i with the number kFirstSurface + i.
  void smooth(std::span<const Seen> seen, std::span<const DrawnMesh> meshes, const std::optional<Floor>& floor,
              const View& view, const PixelArea& area, std::span<std::uint64_t> picture);

  /// Of the last picture, without floor and backdrop: linear colours times what the surfaces cover of each pixel, and
  /// that share, lowest row first. `unsmoothed`: the picture before.
  void cut_out(std::span<const Seen> seen, std::span<const std::uint64_t> unsmoothed,
               std::vector<Eigen::Vector4f>& surfaces) const;

  /// Pixels of the last picture that were sampled.
  std::size_t count() const { return pixels_.size(); }

 private:
  static constexpr int kSamples = 16;
  /// What the samples of one pixel show: 1 / distance [1/m], 0 for nothing, how that changes over the plane of their
  /// triangle [1/m for each pixel], and the surface.
  struct Samples {
    float nearness[kSamples] = {}, slope_x[kSamples] = {}, slope_y[kSamples] = {}, surface[kSamples] = {};
  };
  /// A vertex in the picture: pixels from its lower left corner, and 1 / distance [1/m].
  struct Vertex {
    float x, y, nearness;
  };
  struct Pixel {
    int x, y;
  };
  using Bits = std::uint64_t;

  void find(std::span<const Seen> seen, const PixelArea& area);
  void number();
  void sample(const DrawnMesh& mesh, float surface, const View& view);
  /// Of triangles without holes all is shown.
  struct Everything {};
  template <class Shows = Everything>
  void sample(const Vertex& a, const Vertex& b, const Vertex& c, float surface, const Shows& shows = {});
  void sample_with_holes(const DrawnMesh& mesh, float surface, const View& view);
  void sample_floor(const Floor& floor, const View& view);
  std::array<std::size_t, kSamples> find_sources(std::size_t slot, std::span<const Seen> seen) const;
  Vertex to_picture(const Eigen::Vector4d& clip) const;

  int width_, height_, words_;  // words of bits in a row
  float kink_ = 0;              // of 1 / distance, as a part of it, beyond which something folds
  std::vector<Bits> bits_;      // a bit for each pixel with an outline
  std::vector<int> first_;      // for each word: samples of its lowest pixel
  std::vector<Pixel> pixels_;
  std::vector<Samples> samples_;
  std::vector<std::uint64_t> resolved_;
  std::vector<float> nearness_;
  std::vector<Eigen::Vector4d> clip_;
  std::vector<Vertex> vertices_;
};

}  // namespace weft::render
