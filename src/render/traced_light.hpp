// The light that reaches each pixel, by rays: fractions of the lamps, of the surroundings, and what surfaces reflect
// onto each other. Few rays a pixel; joint_filter.hpp removes their noise.
#pragma once

#include <optional>
#include <vector>

#include "render/geometry_buffer.hpp"
#include "render/gl/objects.hpp"
#include "render/pixel_points.hpp"
#include "render/quality.hpp"
#include "render/reflected_light.hpp"

namespace weft::render {

class TracedLight {
 public:
  /// For pictures of width x height pixels.
  TracedLight(const Gl& gl, const QualitySettings& quality, int width, int height);

  /// What each surface is to rays that start on it.
  struct Surface {
    PixelPoints::Kind kind;
    float mirror_alpha;  ///< squared roughness of its reflections; negative: it mirrors nothing near by

    static Surface of(const frame::Appearance& look, bool cloth);
  };

  /// Light of what the geometry buffer shows. Binds to unit 0 the fractions of up to four lamps; to unit 1 the light
  /// reflected by surfaces, as matte white shows it, and in w the fraction of the surroundings that is open; to unit 2,
  /// if a surface mirrors, the light mirrored by it and the fraction of it that surfaces hide.
  void draw(const ReflectedLight& light, const GeometryBuffer& geometry, std::span<const Surface> surfaces,
            const View& view, const std::optional<Floor>& floor);

  /// Areas of the picture that contain all floor on which some light is missing or added. Call after draw().
  std::vector<PixelArea> shaded_floor() const;

 private:
  const PixelPoints& lit_points() const { return lit_points_ ? *lit_points_ : pixels_; }
  void trace_shadows(const ReflectedLight& light);
  void trace_lamp(const ReflectedLight& light, const Lamp& lamp, Plane& lit);
  void trace_surroundings(const ReflectedLight& light);
  void trace_mirrors(const ReflectedLight& light, std::span<const Surface> surfaces, const Eigen::Vector3f& eye);
  void upload(std::span<const Plane> planes, const PixelPoints& points, const Texture& texture, GLuint unit);

  const Gl* gl_;
  QualitySettings quality_;
  int width_, height_;
  PixelPoints pixels_, open_points_;
  std::optional<PixelPoints> lit_points_;              // if shadows are smaller than the picture
  std::vector<Plane> lit_;                             // per lamp
  std::vector<Plane> open_, open_scratch_, mirrored_;  // red, green, blue, fraction
  std::vector<Eigen::Vector3f> directions_;            // of the rays to the surroundings
  std::array<Plane, 5> scratch_;                       // of the size of lit_
  Texture lit_texture_, open_texture_;
  std::optional<Texture> mirrored_texture_;
  std::vector<Seen> seen_;
  std::vector<Eigen::Vector4f> normals_, values_, texels_;
  std::vector<char> shaded_;  // flag of each tile of the picture
};

}  // namespace weft::render
