#include "export/obj.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string>

#include "core/temporary_file.hpp"

namespace weft::exporter {
namespace {

template <std::size_t kCorners>
void append_faces(const std::vector<std::array<Index, kCorners>>& faces, bool textured, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const auto& face : faces) {
    text += 'f';
    for (Index corner : face)  // counted from 1
      textured ? fmt::format_to(out, " {0}/{0}", corner + 1) : fmt::format_to(out, " {}", corner + 1);
    text += '\n';
  }
}

}  // namespace

void write_obj(const std::filesystem::path& file, const frame::Surface& surface, const std::vector<Vec3>& positions) {
  std::string text = fmt::format("# Weft, metres\no {}\n", surface.name);
  const auto out = std::back_inserter(text);
  for (const Vec3& x : positions) fmt::format_to(out, "v {} {} {}\n", x.x(), x.y(), x.z());
  for (const Vec2& uv : surface.uv) fmt::format_to(out, "vt {} {}\n", uv.x(), uv.y());
  if (surface.quads.empty())
    append_faces(surface.triangles, !surface.uv.empty(), text);
  else
    append_faces(surface.quads, !surface.uv.empty(), text);
  write_file(file, text, Flush::no);
}

}  // namespace weft::exporter
