#include "export/obj.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string>

#include "core/temporary_file.hpp"
#include "export/seams.hpp"

namespace weft::exporter {
namespace {

// Corners are counted from 1; `place` gives the vertex and the texture coordinates of each.
template <std::size_t kCorners, class Place>
void append_faces(const std::vector<std::array<Index, kCorners>>& faces, bool textured, const Place& place,
                  std::string& text) {
  const auto out = std::back_inserter(text);
  for (const auto& face : faces) {
    text += 'f';
    for (Index corner : face)
      textured ? fmt::format_to(out, " {}/{}", place(corner) + 1, corner + 1)
               : fmt::format_to(out, " {}", place(corner) + 1);
    text += '\n';
  }
}

}  // namespace

void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions) {
  std::string text = fmt::format("# Weft, metres\no {}\n", surface.name);
  const auto out = std::back_inserter(text);
  for (const Vec3& x : positions) fmt::format_to(out, "v {} {} {}\n", x.x(), x.y(), x.z());
  const CutSurface cut = cut_at_seams(surface);
  for (const Vec2& uv : cut.uv) fmt::format_to(out, "vt {} {}\n", uv.x(), uv.y());
  const auto vertex = [&](Index place) { return cut.vertex_of[static_cast<std::size_t>(place)]; };
  if (surface.quads.empty())
    append_faces(cut.triangles, !cut.uv.empty(), vertex, text);
  else
    append_faces(
        surface.quads, !surface.uv.empty(), [](Index corner) { return corner; }, text);
  write_file(file, text, Flush::no);
}

}  // namespace weft::exporter
