#include "tools/export/obj.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/temporary_file.hpp"
#include "tools/export/materials.hpp"
#include "tools/export/normals.hpp"
#include "tools/export/seams.hpp"

namespace weft::exporter {
namespace {

// Largest specular exponent: readers such as Blender compute the roughness as 1 - sqrt(Ns / 1000).
constexpr double kMaxSpecularExponent = 1000;

// A triangle or quad of the file. Each corner is given as a corner of a triangle of the surface, because texture
// coordinates and normals are stored by triangle.
struct Face {
  std::size_t material = 0;                                  // index of the first material with the same look
  std::vector<std::pair<std::size_t, std::size_t>> corners;  // index of the triangle; 0, 1 or 2: its corner
};

std::vector<Face> triangles_of(const frame::Surface& surface) {
  std::vector<Face> faces;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) faces.push_back({0, {{t, 0}, {t, 1}, {t, 2}}});
  return faces;
}

// Takes each corner of a quad from the triangle that contains the quad's edge from this corner to the next.
std::vector<Face> quads_of(const frame::Surface& surface) {
  std::map<std::pair<Index, Index>, std::size_t> triangles;  // by directed edge
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) triangles[{surface.triangles[t][k], surface.triangles[t][(k + 1) % 3]}] = t;
  std::vector<Face> faces;
  for (const auto& quad : surface.quads) {
    Face& face = faces.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t t = triangles.at({quad[k], quad[(k + 1) % 4]});
      const auto& corners = surface.triangles[t];
      face.corners.emplace_back(t, std::ranges::find(corners, quad[k]) - corners.begin());
    }
  }
  return faces;
}

// Faces in the order of their materials.
std::vector<Face> faces_of(const frame::Surface& surface, const Materials& materials) {
  std::vector<Face> faces = surface.quads.empty() ? triangles_of(surface) : quads_of(surface);
  for (Face& face : faces) face.material = materials.all[materials.of_triangle(surface, face.corners[0].first)].alike;
  std::ranges::stable_sort(faces, {}, &Face::material);
  return faces;
}

// Writes corners as `v//vn` or `v/vt/vn`, counted from 1.
void append_faces(const std::vector<Face>& faces, const Materials& materials, const CutSurface& cut,
                  const NormalGroups& groups, std::string& text) {
  const auto out = std::back_inserter(text);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::size_t material = faces[f].material;
    if (f == 0 || material != faces[f - 1].material) fmt::format_to(out, "usemtl {}\n", materials.all[material].name);
    text += 'f';
    for (const auto& [t, k] : faces[f].corners) {
      const Index place = cut.triangles[t][k];
      const Index vertex = cut.vertex_of[static_cast<std::size_t>(place)], normal = groups.of_corner[t][k];
      if (cut.uv.empty())
        fmt::format_to(out, " {}//{}", vertex + 1, normal + 1);
      else
        fmt::format_to(out, " {}/{}/{}", vertex + 1, place + 1, normal + 1);
    }
    text += '\n';
  }
}

using Wrap = frame::Paint::Wrap;

// Whether a picture repeats along both axes (true) or along neither (false). MTL cannot express other pictures: those
// that are mirrored, or that repeat along one axis only (nullopt).
std::optional<bool> repeats_in_mtl(const Material& material) {
  if (material.wrap_u != material.wrap_v || material.wrap_u == Wrap::mirror) return std::nullopt;
  return material.wrap_u == Wrap::repeat;
}

// MTL options for scale, offset and clamping of a picture; nullopt if the picture is rotated or
// skewed, which MTL cannot express.
std::optional<std::string> map_options(const Material& material) {
  const auto& map = material.picture_from_uv;
  if (map(0, 1) != 0 || map(1, 0) != 0) return std::nullopt;
  std::string text;
  if (map != Eigen::Matrix<double, 2, 3>::Identity())
    text = fmt::format("-s {} {} 1 -o {} {} 0 ", map(0, 0), map(1, 1), map(0, 2), map(1, 2));
  if (repeats_in_mtl(material) == false) text += "-clamp on ";
  return text;
}

}  // namespace

void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions) {
  std::string text = fmt::format("# Weft, metres\nmtllib {}.mtl\no {}\n", surface.name, surface.name);
  const auto out = std::back_inserter(text);
  for (const Vec3& x : positions) fmt::format_to(out, "v {} {} {}\n", x.x(), x.y(), x.z());
  const Materials materials = materials_of(surface);
  const CutSurface cut = cut_at_seams(surface, materials, positions.size());
  for (const Vec2& uv : cut.uv) fmt::format_to(out, "vt {} {}\n", uv.x(), uv.y());
  const NormalGroups groups = group_normals(surface, positions);
  for (const Vec3& n : normals_of(groups, surface, positions))
    fmt::format_to(out, "vn {:.6f} {:.6f} {:.6f}\n", n.x(), n.y(), n.z());
  text += "s 1\n";
  append_faces(faces_of(surface, materials), materials, cut, groups, text);
  write_file(file, text, Flush::no);
}

std::string mtl_text(const frame::Surface& surface) {
  const Materials materials = materials_of(surface);
  std::string text = "# Weft, colours in linear light\n";
  const auto out = std::back_inserter(text);
  for (const MaterialGroup& group : group_by_look(surface, materials)) {
    const Material& material = materials.all[group.material];
    const auto options = material.has_picture() ? map_options(material) : std::nullopt;
    const Vec3 color = options ? Vec3(1, 1, 1) : material.color;
    const double glossy = 1 - material.roughness;
    fmt::format_to(out, "newmtl {}\nKd {:.6f} {:.6f} {:.6f}\nKs 0.5 0.5 0.5\nNs {:.3f}\nPr {}\nd 1\nillum 2\n",
                   material.name, color.x(), color.y(), color.z(), kMaxSpecularExponent * glossy * glossy,
                   material.roughness);
    if (!material.has_picture()) continue;
    const std::string& file = materials.pictures[material.picture].name;
    if (!options) {
      fmt::format_to(out, "# {} is laid turned, which cannot be said here\n", file);
      continue;
    }
    if (!repeats_in_mtl(material))
      fmt::format_to(out, "# {} is mirrored, or repeats along one axis only, which cannot be said here\n", file);
    fmt::format_to(out, "map_Kd {}{}\n", *options, file);
    if (material.cutout) fmt::format_to(out, "map_d {}{}\n", *options, file);
  }
  return text;
}

}  // namespace weft::exporter
