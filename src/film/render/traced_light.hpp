// Computes by ray tracing which light reaches the point that a pixel shows: the visible fractions of the lamps and of
// the surroundings, and the light that surfaces reflect onto each other. Each pixel has only a few rays;
// joint_filter.hpp removes their noise.
#pragma once

#include <optional>
#include <vector>

#include "film/render/geometry_buffer.hpp"
#include "film/render/gl/objects.hpp"
#include "film/render/pixel_points.hpp"
#include "film/render/quality.hpp"
#include "film/render/reflected_light.hpp"

namespace weft::render {

/// Traces the rays of a picture, and makes textures of the results for Shading.
class TracedLight {
 public:
  /// For pictures of width x height pixels.
  TracedLight(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// Properties of a surface for rays that start on it.
  struct Surface {
    PixelPoints::Kind kind;
    float mirror_alpha;  ///< squared roughness of its reflections; negative: it reflects only the surroundings

    static Surface of(const frame::Appearance& look, bool cloth);
  };

  /// Traces the light that reaches the points that the geometry buffer shows, and binds textures:
  /// - unit 0: the visible fractions of up to four lamps
  /// - unit 1: irradiance from other surfaces, divided by π; w: fraction of the surroundings that no surface covers
  /// - unit 2, if a surface has a `mirror_alpha` >= 0: light of mirrored surfaces; w: fraction of the mirror image that
  ///   they cover
  ///
  /// `seen`: what read_seen() of the geometry buffer returns.
  void draw(const ReflectedLight& light, const GeometryBuffer& geometry, std::span<const Seen> seen,
            std::span<const Surface> surfaces, const View& view, const std::optional<Floor>& floor);

  /// Areas of the picture that contain all floor with shadow, occlusion or reflected light. Call after draw().
  std::vector<PixelArea> shaded_floor() const;

 private:
  const PixelPoints& lit_points() const { return lit_points_ ? *lit_points_ : pixels_; }
  void trace_shadows(const ReflectedLight& light);
  void trace_lamp(const ReflectedLight& light, const Lamp& lamp, Plane& lit);
  void trace_surroundings(const ReflectedLight& light);
  void trace_mirrors(const ReflectedLight& light, std::span<const Surface> surfaces, const Eigen::Vector3f& eye);
  void upload(std::span<const Plane> planes, const PixelPoints& points, const Texture& texture, GLuint unit,
              const Eigen::Vector4f& on_open_floor);

  const Gl* gl_;
  QualitySettings quality_;
  int width_, height_;
  PixelPoints pixels_, open_points_;
  std::optional<PixelPoints> lit_points_;              // set only if shadows have a lower resolution than the picture
  std::vector<Plane> lit_;                             // per lamp: its visible fraction at each point
  std::vector<Plane> open_, open_scratch_, mirrored_;  // red, green, blue, fraction
  std::vector<Eigen::Vector3f> directions_;            // directions of the rays to the surroundings
  std::array<Plane, 5> scratch_;                       // scratch planes, as large as those of lit_
  Texture lit_texture_, open_texture_;
  Texture mirrored_texture_;  // made once a surface mirrors
  std::vector<Eigen::Vector4f> normals_, values_, texels_;
  std::vector<char> shaded_;  // per tile of the picture: 1 if it contains shaded floor
};

}  // namespace weft::render
