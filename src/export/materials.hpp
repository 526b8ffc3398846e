// Colours and pictures of surfaces as other programs take them.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "frame/frame_snapshot.hpp"

namespace weft::exporter {

/// A picture beside or inside of what is exported. Other programs lay it on as it is: what our surfaces do with it
/// (their colour multiplied in, or showing through it and around it) is done to its pixels.
struct PictureFile {
  std::string name;  ///< of the file
  std::shared_ptr<const frame::Texture> texture;
  Vec3 color;  ///< linear, of the surface
  frame::Paint::Alpha alpha = frame::Paint::Alpha::ignored;
  bool rim_u = false, rim_v = false;  ///< a pixel of nothing around it, which goes on beyond its edges

  /// Its bytes, as PNG; with alpha where it cuts holes.
  std::string png() const;
};

struct Material {
  static constexpr std::size_t kNoPicture = static_cast<std::size_t>(-1);
  std::string name;  ///< letters, digits, - and _
  Vec3 color;        ///< linear; where there is a picture it has this one too, and is not multiplied by it
  double roughness = 0, metal = 0;
  std::size_t picture = kNoPicture;  ///< of Materials::pictures
  frame::Paint::Wrap wrap_u = frame::Paint::Wrap::repeat, wrap_v = frame::Paint::Wrap::repeat;  ///< not once
  bool cutout = false;
  /// From the surface's (u, v, 1) to the picture: 0 to 1 from left to right and from the bottom to the top.
  Eigen::Matrix<double, 2, 3> picture_from_uv = Eigen::Matrix<double, 2, 3>::Identity();
  std::size_t alike = 0;  ///< the first that looks the same

  bool has_picture() const { return picture != kNoPicture; }
};

/// Of a surface. Cloth has those of its front on both sides.
struct Materials {
  std::vector<Material> all;  ///< that of the surface itself, and one for each of its parts
  std::vector<PictureFile> pictures;

  /// Of a triangle, among `all`.
  std::size_t of_triangle(const frame::Surface& surface, std::size_t triangle) const;
};

Materials materials_of(const frame::Surface& surface);

/// Triangles of one look.
struct MaterialGroup {
  std::size_t material = 0;  ///< among `all`
  std::vector<std::size_t> triangles;
};

/// All triangles by look, in the order of the materials.
std::vector<MaterialGroup> by_look(const frame::Surface& surface, const Materials& materials);

/// `name` with all but letters, digits and - as _.
std::string plain_name(const std::string& name);

}  // namespace weft::exporter
