#include "mesh/ply.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/error.hpp"
#include "core/temporary_file.hpp"

namespace weft::mesh {
namespace {

// Numbers are copied as they lie in memory.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// One face of the file: the number of its corners as a byte, then their indices.
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::int32_t);
constexpr std::size_t kVertexBytes = 3 * sizeof(double);

std::string header(std::size_t vertices, std::size_t faces, std::size_t passed_through) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment Weft, metres\n"
      "{}element vertex {}\n"
      "property double x\n"
      "property double y\n"
      "property double z\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "end_header\n",
      passed_through > 0 ? fmt::format("comment cloth passes through the last {} faces\n", passed_through) : "",
      vertices, faces);
}

}  // namespace

void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, std::span<const std::uint8_t> passed_through) {
  const auto last = static_cast<std::size_t>(std::ranges::count(passed_through, 1));
  std::string content = header(positions.size(), triangles.size(), last);
  const std::size_t vertices_at = content.size();
  const std::size_t faces_at = vertices_at + kVertexBytes * positions.size();
  content.resize(faces_at + kFaceBytes * triangles.size());
  if (!positions.empty())
    std::memcpy(&content[vertices_at], static_cast<const void*>(positions.data()), kVertexBytes * positions.size());
  char* face = content.data() + faces_at;
  for (const bool passed : {false, true})
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if ((!passed_through.empty() && passed_through[t] != 0) != passed) continue;
      *face = 3;
      std::memcpy(face + 1, triangles[t].data(), kFaceBytes - 1);
      face += kFaceBytes;
    }
  write_file(file, content);
}

}  // namespace weft::mesh
