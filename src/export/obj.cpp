#include "export/obj.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "core/temporary_file.hpp"
#include "export/normals.hpp"
#include "export/seams.hpp"
#include "image/color.hpp"

namespace weft::exporter {
namespace {

// Of the highlight, for what is as a mirror: readers such as Blender take roughness for 1 - sqrt(Ns / 1000).
constexpr double kLargestExponent = 1000;

constexpr Index kNone = -1;

// One corner of a face: `v//vn` or `v/vt/vn`, counted from 1.
void append_corner(Index vertex, Index texture, Index normal, std::string& text) {
  const auto out = std::back_inserter(text);
  if (texture != kNone)
    fmt::format_to(out, " {}/{}/{}", vertex + 1, texture + 1, normal + 1);
  else
    fmt::format_to(out, " {}//{}", vertex + 1, normal + 1);
}

void append_triangles(const CutSurface& cut, const NormalGroups& groups, std::string& text) {
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    text += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      const Index place = cut.triangles[t][k];
      const Index texture = cut.uv.empty() ? kNone : place;
      append_corner(cut.vertex_of[static_cast<std::size_t>(place)], texture, groups.of_corner[t][k], text);
    }
    text += '\n';
  }
}

// A corner of a quad has the normal of a triangle that is a part of the quad: both have an edge in common.
void append_quads(const frame::Surface& surface, const NormalGroups& groups, std::string& text) {
  std::map<std::pair<Index, Index>, std::size_t> triangles;  // by edge, from vertex to vertex
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) triangles[{surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]}] = t;
  for (const auto& quad : surface.quads) {
    text += 'f';
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t t = triangles.at({quad[k], quad[(k + 1) % 4]});
      const auto& corners = surface.triangles[t];
      const auto corner = static_cast<std::size_t>(std::ranges::find(corners, quad[k]) - corners.begin());
      const Index texture = surface.uv.empty() ? kNone : quad[k];
      append_corner(quad[k], texture, groups.of_corner[t][corner], text);
    }
    text += '\n';
  }
}

}  // namespace

void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions) {
  std::string text = fmt::format("# Weft, metres\nmtllib {}.mtl\no {}\n", surface.name, surface.name);
  const auto out = std::back_inserter(text);
  for (const Vec3& x : positions) fmt::format_to(out, "v {} {} {}\n", x.x(), x.y(), x.z());
  const CutSurface cut = cut_at_seams(surface);
  for (const Vec2& uv : cut.uv) fmt::format_to(out, "vt {} {}\n", uv.x(), uv.y());
  const NormalGroups groups = group_normals(surface, positions);
  for (const Vec3& n : normals_of(groups, surface, positions))
    fmt::format_to(out, "vn {:.6f} {:.6f} {:.6f}\n", n.x(), n.y(), n.z());
  text += fmt::format("usemtl {}\ns 1\n", surface.name);
  if (surface.quads.empty())
    append_triangles(cut, groups, text);
  else
    append_quads(surface, groups, text);
  write_file(file, text, Flush::no);
}

std::string mtl_text(const frame::Surface& surface) {
  const frame::Appearance& look = surface.appearance;
  const Vec3 color = image::linear_from_srgb(look.color);
  const double glossy = 1 - look.roughness;
  return fmt::format(
      "# Weft, colours in linear light\nnewmtl {}\nKd {:.6f} {:.6f} {:.6f}\nKs 0.5 0.5 0.5\nNs {:.3f}\nPr {}\nd "
      "1\nillum "
      "2\n",
      surface.name, color.x(), color.y(), color.z(), kLargestExponent * glossy * glossy, look.roughness);
}

}  // namespace weft::exporter
