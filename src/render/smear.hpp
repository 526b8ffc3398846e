// Motion within one of the sharp pictures of which a blurred one is the mean: each is drawn along the ways of what it
// shows, so that few of them are enough.
#pragma once

#include <span>
#include <vector>

#include "render/surface_buffers.hpp"
#include "render/view.hpp"

namespace weft::render {

/// Way of what a pixel shows [pixels], and 1 / its distance [1/m]; 0 where it is still.
struct Way {
  Eigen::Vector2f way = Eigen::Vector2f::Zero();
  float nearness = 0;
};

/// Longest way of what is in front of the viewer, from one frame to the other [pixels].
double longest_way(const frame::FrameSnapshot& from, const View& from_view, const frame::FrameSnapshot& to,
                   const View& to_view, int width, int height);

class Smear {
 public:
  Smear(int width, int height) : width_(width), height_(height) {}

  /// Adds a picture, linear and lowest row first, drawn along the ways from `from` to `to`, in whose middle it was
  /// taken from `view`.
  void add(std::span<const SurfaceBuffers> surfaces, const View& view, const frame::FrameSnapshot& from,
           const View& from_view, const frame::FrameSnapshot& to, const View& to_view,
           std::span<const Eigen::Vector3f> sharp, std::vector<Eigen::Vector3f>& sum);

 private:
  void find_ways(std::span<const SurfaceBuffers> surfaces, const View& view, const frame::FrameSnapshot& from,
                 const View& from_view, const frame::FrameSnapshot& to, const View& to_view);
  void find_longest();
  Eigen::Vector3f drawn_along(int x, int y, const Eigen::Vector2f& way, std::span<const Eigen::Vector3f> sharp) const;

  int width_, height_;
  std::vector<Way> ways_;
  std::vector<Eigen::Vector2f> longest_;  // of a tile and those around it
};

}  // namespace weft::render
