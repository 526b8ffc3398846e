// Colours and pictures of surfaces, in the form that other programs use.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"

namespace weft::exporter {

/// A picture beside or inside the exported files. The export formats cannot combine a picture with
/// a colour as Weft does, so png() puts the surface's colour into the pixels: each pixel is the
/// product of picture and colour. If the picture covers the colour (Appearance::paint), transparent pixels and the rim
/// have the colour alone.
struct PictureFile {
  std::string name;  ///< file name
  std::shared_ptr<const frame::Texture> texture;
  Vec3 color;  ///< linear colour of the surface
  frame::Paint::Alpha alpha = frame::Paint::Alpha::ignored;
  /// Whether png() adds one transparent pixel at both ends of this axis (a rim). With Wrap::clamp,
  /// readers repeat this pixel beyond the edges, so the picture occurs once, as with Wrap::once.
  bool rim_u = false, rim_v = false;

  /// The bytes of the PNG file; it has alpha only if the picture cuts holes.
  std::string png() const;
};

struct Material {
  static constexpr std::size_t kNoPicture = static_cast<std::size_t>(-1);
  std::string name;                  ///< at most 59 letters, digits, - and _; unique within the object
  Vec3 color;                        ///< linear; if there is a picture, its pixels already include this colour
  double roughness = 0, metal = 0;   ///< 0 to 1
  std::size_t picture = kNoPicture;  ///< index in Materials::pictures
  frame::Paint::Wrap wrap_u = frame::Paint::Wrap::repeat, wrap_v = frame::Paint::Wrap::repeat;  ///< never Wrap::once
  bool cutout = false;  ///< whether the alpha of the picture cuts holes
  /// Linear colour of the back of cloth, if it differs from the front and shows no picture. Only Format::blender
  /// exports it.
  std::optional<Vec3> back = {};
  /// Maps (u, v, 1) of the surface to the picture: 0 to 1 from left to right and from bottom to top.
  Eigen::Matrix<double, 2, 3> picture_from_uv = Eigen::Matrix<double, 2, 3>::Identity();
  std::size_t alike = 0;  ///< index in Materials::all of the first material with the same look

  bool has_picture() const { return picture != kNoPicture; }
};

/// Materials of a surface. Both sides of cloth have the materials of the front, except for Material::back.
struct Materials {
  std::vector<Material> all;  ///< the material of the surface itself, then one material per element of Surface::parts
  std::vector<PictureFile> pictures;

  /// Index in `all` of the material of a triangle.
  std::size_t of_triangle(const frame::Surface& surface, std::size_t triangle) const;
};

/// The materials of both the surface and its parts.
Materials materials_of(const frame::Surface& surface);

/// Triangles with the same look.
struct MaterialGroup {
  std::size_t material = 0;  ///< index in Materials::all of the first material with this look
  std::vector<std::size_t> triangles;
};

/// Groups all triangles by look. The groups are in the order of the materials.
std::vector<MaterialGroup> group_by_look(const frame::Surface& surface, const Materials& materials);

/// `name` with every character except letters, digits and - replaced by _.
std::string plain_name(const std::string& name);

}  // namespace weft::exporter
