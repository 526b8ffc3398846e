// Motion blur: the mean of several sharp pictures. Before averaging, each sharp picture is smeared: each pixel becomes
// a mean along the longest motion of the surfaces near it. Thus few pictures are enough.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "film/render/surface_buffers.hpp"
#include "film/render/view.hpp"

namespace weft::render {

/// Motion of the point that a pixel shows [pixels], and 1 / its distance [1/m]; both are 0 for the backdrop, and for
/// floor that stays sharp.
struct PixelMotion {
  Eigen::Vector2f motion = Eigen::Vector2f::Zero();
  float nearness = 0;
};

/// Largest displacement in the picture between two frames [pixels], of all vertices of subjects that are beyond the
/// near plane in both frames and inside the picture in the frame `to`, occluded or not, and of points of the floor in
/// the frame `to`, which move with the camera.
double longest_motion(const frame::FrameSnapshot& from, const View& from_view, const frame::FrameSnapshot& to,
                      const View& to_view, const std::optional<Floor>& floor, int width, int height);

class Smear {
 public:
  Smear(int width, int height) : width_(width), height_(height) {}

  /// Smears the picture `sharp` (linear, lowest row first) along the motion from frame `from` to frame `to`, and adds
  /// it to `sum`. `surfaces`, `floor` and `view`: those of the picture, which is halfway in time between the two
  /// frames.
  void add(std::span<const SurfaceBuffers> surfaces, const std::optional<Floor>& floor, const View& view,
           const frame::FrameSnapshot& from, const View& from_view, const frame::FrameSnapshot& to, const View& to_view,
           std::span<const Eigen::Vector3f> sharp, std::vector<Eigen::Vector3f>& sum);

 private:
  void find_motions(std::span<const SurfaceBuffers> surfaces, const View& view, const frame::FrameSnapshot& from,
                    const View& from_view, const frame::FrameSnapshot& to, const View& to_view);
  void find_floor_motions(const Floor& floor, const View& view, const View& from_view, const View& to_view);
  void dilate_motions();
  Eigen::Vector3f smear_pixel(int x, int y, const Eigen::Vector2f& motion,
                              std::span<const Eigen::Vector3f> sharp) const;

  int width_, height_;
  std::vector<PixelMotion> motions_;
  std::vector<Eigen::Vector2f> dilated_motions_;  // per tile, see dilate_motions()
};

}  // namespace weft::render
