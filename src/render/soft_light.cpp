#include "render/soft_light.hpp"

#include <algorithm>

#include "render/seen.hpp"

namespace weft::render {
namespace {

constexpr int kSoftTile = 4;  // side of a tile [texels of the buffer]
constexpr int kMargin = 2;    // filter radius of the lookup around a pixel [texels]; shaders/shading.glsl

// Openness from which floor counts as open: the error is half a level of 255, less than the dither.
constexpr float kOpen = 0.998f;

/// Whether floor at or near this texel needs soft light.
bool needs_soft_light(const SoftTexel& texel) {
  constexpr float kOpenPacked = kFloor + 0.9375f * kOpen;
  if (texel.surface_open < kFloor) return false;
  return texel.surface_open < kOpenPacked || texel.surface_open >= kFirstSurface || texel.lit[0] < 1 ||
         texel.lit[1] < 1;
}

std::vector<std::string> soft_light_defines(const QualitySettings& quality, const LightSet& lights) {
  std::vector<std::string> defines = ShadowMaps::defines(quality, lights);
  defines.push_back("NEARBY_TAPS " + std::to_string(quality.nearby_taps));
  defines.push_back("SKY_TAPS " + std::to_string(quality.sky_taps));
  defines.push_back("REDUCTION " + std::to_string(quality.soft_divisor));
  return defines;
}

}  // namespace

SoftLight::SoftLight(const Gl& gl, const QualitySettings& quality, int width, int height)
    : gl_(&gl),
      quality_(quality),
      picture_width_(width),
      picture_height_(height),
      width_((width + quality.soft_divisor - 1) / quality.soft_divisor),
      height_((height + quality.soft_divisor - 1) / quality.soft_divisor),
      distances_program_(gl, "fullscreen.vert", "soft_distances.frag",
                         {"REDUCTION " + std::to_string(quality.soft_divisor)}),
      sky_(make_texture(gl, GL_RG32F, kSkySize, kSkySize, GL_NEAREST)),
      distances_(make_texture(gl, GL_R32F, width_, height_, GL_NEAREST)),
      light_(make_texture(gl, GL_RGBA32F, width_, height_, GL_NEAREST)),
      distances_target_(gl),
      light_target_(gl),
      no_vertices_(gl),
      texels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)),
      blur_(width_, height_) {
  gl.NamedFramebufferTexture(light_target_.name(), GL_COLOR_ATTACHMENT0, light_.name(), 0);
  gl.NamedFramebufferTexture(distances_target_.name(), GL_COLOR_ATTACHMENT0, distances_.name(), 0);
  for (const Framebuffer* target : {&distances_target_, &light_target_}) {
    check_framebuffer(gl, *target, "soft light");
  }
}

void SoftLight::draw(std::span<const DrawnMesh> meshes, const SkyView& above, LightSet lights) {
  lights.count = std::min(lights.count, kSoftLights);
  auto program = soft_light_.find(lights);
  if (program == soft_light_.end()) {
    Program made(*gl_, "fullscreen.vert", "soft_light.frag", soft_light_defines(quality_, lights));
    program = soft_light_.emplace(lights, std::move(made)).first;
  }
  draw_sky_map(meshes, above, sky_map_);
  gl_->TextureSubImage2D(sky_.name(), 0, 0, 0, kSkySize, kSkySize, GL_RG, GL_FLOAT, sky_map_.data());
  gl_->Disable(GL_DEPTH_TEST);
  gl_->BindVertexArray(no_vertices_.name());
  gl_->Viewport(0, 0, width_, height_);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, distances_target_.name());
  distances_program_.use();
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, light_target_.name());
  gl_->BindTextureUnit(6, sky_.name());
  gl_->BindTextureUnit(9, distances_.name());
  program->second.use();
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);

  const GLsizei bytes = static_cast<GLsizei>(texels_.size() * sizeof(SoftTexel));
  gl_->GetTextureImage(light_.name(), 0, GL_RGBA, GL_FLOAT, bytes, texels_.data());
  blur_.smooth(texels_);
  gl_->TextureSubImage2D(light_.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, texels_.data());
  gl_->BindTextureUnit(3, light_.name());
}

std::vector<PixelArea> SoftLight::shaded_floor() const {
  // Texel x marks the tiles of x - kMargin and x + kMargin; flags start at x = -kMargin.
  const auto tiles = [](int texels_along) { return (texels_along + 2 * kMargin + kSoftTile - 1) / kSoftTile; };
  const int columns = tiles(width_), rows = tiles(height_);
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(columns) * rows), row_flags(columns);
  for (int y = 0; y < height_; ++y) {
    std::fill(row_flags.begin(), row_flags.end(), 0);
    const SoftTexel* row = texels_.data() + static_cast<std::size_t>(y) * width_;
    for (int x = 0; x < width_; ++x) {
      const bool flag = needs_soft_light(row[x]);
      row_flags[x / kSoftTile] |= flag;
      row_flags[(x + 2 * kMargin) / kSoftTile] |= flag;
    }
    for (const int tile_row : {y / kSoftTile, (y + 2 * kMargin) / kSoftTile}) {
      for (int i = 0; i < columns; ++i) flags[static_cast<std::size_t>(tile_row) * columns + i] |= row_flags[i];
    }
  }
  // Merges runs of tiles into areas.
  const auto pixel = [&](int tile, int size) {
    return std::clamp((tile * kSoftTile - kMargin) * quality_.soft_divisor, 0, size);
  };
  std::vector<PixelArea> areas;
  for (int row = 0; row < rows; ++row) {
    const std::uint8_t* row_of_flags = flags.data() + static_cast<std::size_t>(row) * columns;
    for (int begin = 0; begin < columns; ++begin) {
      if (!row_of_flags[begin]) continue;
      int end = begin;
      while (end < columns && row_of_flags[end]) ++end;
      PixelArea area{pixel(begin, picture_width_), pixel(row, picture_height_), 0, 0};
      area.width = pixel(end, picture_width_) - area.x;
      area.height = pixel(row + 1, picture_height_) - area.y;
      areas.push_back(area);
      begin = end;
    }
  }
  return areas;
}

}  // namespace weft::render
