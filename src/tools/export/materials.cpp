#include "tools/export/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <utility>

#include "film/image/color.hpp"
#include "film/image/image.hpp"
#include "film/image/picture.hpp"
#include "film/image/png.hpp"

namespace weft::exporter {
namespace {

using Alpha = frame::Paint::Alpha;
using Wrap = frame::Paint::Wrap;

// Maximum lengths of the name of a material, and of the object's name in it [bytes]. Blender keeps 63 bytes of a name,
// including the number that it adds to a name in use (".001"), and the exported script finds materials by their names.
// The name of the object is cut first, so that the number of the part remains.
constexpr std::size_t kMaxNameBytes = 59, kMaxObjectBytes = 48;

const std::array<double, 256>& linear_of_bytes() {
  static const auto kTable = [] {
    std::array<double, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = image::linear_from_srgb(static_cast<double>(i) / 255);
    return table;
  }();
  return kTable;
}

std::uint8_t byte_of(double fraction) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(fraction, 0.0, 1.0)));
}

// Combines a texel with the surface's colour in linear space, as the renderer does (Appearance::paint). `texel`: null
// in the rim. `output`: receives red, green, blue and alpha.
void blend_texel(const PictureFile& picture, const std::uint8_t* texel, std::uint8_t* output) {
  const bool is_opaque = picture.alpha == Alpha::ignored, has_rim = picture.rim_u || picture.rim_v;
  const bool covers = picture.alpha == Alpha::over_color || (is_opaque && has_rim);
  const double opacity = texel == nullptr ? 0 : is_opaque ? 1 : texel[3] / 255.0;
  for (int c = 0; c < 3; ++c) {
    const double light = texel == nullptr ? 0 : linear_of_bytes()[texel[c]];
    const double shown = covers ? picture.color[c] * (1 - opacity) + light * opacity : picture.color[c] * light;
    output[c] = byte_of(image::srgb_from_linear(shown));
  }
  output[3] = picture.alpha == Alpha::cutout ? byte_of(opacity) : 255;
}

bool is_same(const PictureFile& a, const PictureFile& b) {
  const bool same_texture =
      a.texture == b.texture || (a.texture->width == b.texture->width && a.texture->rgba == b.texture->rgba);
  return same_texture && a.color == b.color && a.alpha == b.alpha && a.rim_u == b.rim_u && a.rim_v == b.rim_v;
}

std::size_t add_picture(std::vector<PictureFile>& pictures, PictureFile picture, const std::string& surface) {
  for (std::size_t i = 0; i < pictures.size(); ++i)
    if (is_same(pictures[i], picture)) return i;
  // Names of objects contain no dots, so no other object has a picture of this name.
  picture.name = pictures.empty() ? surface + ".png" : fmt::format("{}.{}.png", surface, pictures.size() + 1);
  pictures.push_back(std::move(picture));
  return pictures.size() - 1;
}

// The export formats have no Wrap::once (the picture occurs once along this axis). A transparent
// rim with Wrap::clamp looks the same. `pixels`: size of the picture along this axis. `row`: the
// row of Material::picture_from_uv for this axis.
void add_rim(Wrap& wrap, bool& rim, int pixels, Eigen::Ref<Eigen::RowVector3d> row) {
  rim = wrap == Wrap::once;
  if (!rim) return;
  wrap = Wrap::clamp;
  row *= static_cast<double>(pixels) / (pixels + 2);
  row[2] += 1.0 / (pixels + 2);
}

Material material_of(const frame::Surface& surface, const frame::Appearance& look, Materials& materials) {
  Material made{.name = {},
                .color = image::linear_from_srgb(look.color),
                .roughness = surface.appearance.roughness,
                .metal = surface.appearance.metal};
  const bool is_back_painted = look.paint.texture && look.back_painted;
  if (surface.kind == frame::ObjectKind::cloth && look.back_color != look.color && !is_back_painted)
    made.back = image::linear_from_srgb(look.back_color);
  const frame::Paint& paint = look.paint;
  const bool has_places = !surface.uv.empty() || !surface.paint_uv.empty();
  if (!paint.texture || !has_places) return made;
  PictureFile picture{.name = {}, .texture = paint.texture, .color = made.color, .alpha = paint.alpha};
  made.wrap_u = paint.wrap_u;
  made.wrap_v = paint.wrap_v;
  made.cutout = picture.alpha == Alpha::cutout;
  made.picture_from_uv = paint.texture_from_uv;
  Eigen::RowVector3d across = made.picture_from_uv.row(0), up = made.picture_from_uv.row(1);
  add_rim(made.wrap_u, picture.rim_u, paint.texture->width, across);
  add_rim(made.wrap_v, picture.rim_v, paint.texture->height, up);
  made.picture_from_uv << across, up;
  made.picture = add_picture(materials.pictures, std::move(picture), surface.name);
  return made;
}

bool look_alike(const Material& a, const Material& b) {
  return a.color == b.color && a.roughness == b.roughness && a.metal == b.metal && a.picture == b.picture &&
         a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.cutout == b.cutout &&
         a.picture_from_uv == b.picture_from_uv && a.back == b.back;
}

}  // namespace

std::string PictureFile::png() const {
  const int rim_x = rim_u ? 1 : 0, rim_y = rim_v ? 1 : 0;
  image::Picture output{texture->width + 2 * rim_x, texture->height + 2 * rim_y, {}};
  output.rgba.resize(4 * static_cast<std::size_t>(output.width) * static_cast<std::size_t>(output.height));
  for (int y = 0; y < output.height; ++y)
    for (int x = 0; x < output.width; ++x) {
      const int from_x = x - rim_x, from_y = y - rim_y;
      const bool inside = from_x >= 0 && from_y >= 0 && from_x < texture->width && from_y < texture->height;
      const std::size_t from = inside ? 4 * (static_cast<std::size_t>(from_y) * texture->width + from_x) : 0;
      const std::size_t to = 4 * (static_cast<std::size_t>(y) * output.width + x);
      blend_texel(*this, inside ? &texture->rgba[from] : nullptr, &output.rgba[to]);
    }
  if (alpha == Alpha::cutout) return image::png_bytes(output);
  image::Image opaque(output.width, output.height);
  for (std::size_t i = 0; i < opaque.rgb.size(); ++i) opaque.rgb[i] = output.rgba[i / 3 * 4 + i % 3];
  return image::png_bytes(opaque);
}

std::size_t Materials::of_triangle(const frame::Surface& surface, std::size_t triangle) const {
  return surface.part_of_triangle.empty() ? 0 : 1 + static_cast<std::size_t>(surface.part_of_triangle[triangle]);
}

Materials materials_of(const frame::Surface& surface) {
  Materials materials;
  const std::string name = plain_name(surface.name).substr(0, kMaxObjectBytes);
  const auto add = [&](const std::string& material, const frame::Appearance& look) {
    Material made = material_of(surface, look, materials);
    made.name = material.substr(0, kMaxNameBytes);
    const auto first =
        std::ranges::find_if(materials.all, [&](const Material& each) { return look_alike(each, made); });
    made.alike = static_cast<std::size_t>(first - materials.all.begin());
    materials.all.push_back(std::move(made));
  };
  add(name, surface.appearance);
  for (std::size_t p = 0; p < surface.parts.size(); ++p)
    add(fmt::format("{}_{}_{}", name, p, plain_name(surface.parts[p].name)), surface.parts[p].appearance);
  return materials;
}

std::vector<MaterialGroup> group_by_look(const frame::Surface& surface, const Materials& materials) {
  std::vector<MaterialGroup> groups(materials.all.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    groups[materials.all[materials.of_triangle(surface, t)].alike].triangles.push_back(t);
  for (std::size_t m = 0; m < groups.size(); ++m) groups[m].material = m;
  std::erase_if(groups, [](const MaterialGroup& group) { return group.triangles.empty(); });
  return groups;
}

std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  return plain;
}

}  // namespace weft::exporter
