#include "physics/mesh/ply.hpp"

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

// write_ply() copies numbers byte by byte into a little-endian file.
static_assert(std::endian::native == std::endian::little);

/// Sizes of a face (the number of its corners as one byte, then their indices) and of an edge [bytes].
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::int32_t), kEdgeBytes = 2 * sizeof(std::int32_t);
constexpr std::size_t kPlaceBytes = 3 * sizeof(double), kUvBytes = 2 * sizeof(float);

std::string header(std::size_t vertices, std::size_t faces, std::size_t edges, std::size_t passed_through,
                   const PlyExtras& extras) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment Weft, metres\n"
      "{}element vertex {}\n"
      "property double x\n"
      "property double y\n"
      "property double z\n"
      "{}{}element face {}\n"
      "property list uchar int vertex_indices\n"
      "{}end_header\n",
      passed_through > 0 ? fmt::format("comment cloth passes through the last {} faces\n", passed_through) : "",
      vertices, extras.uv.empty() ? "" : "property float s\nproperty float t\n",
      extras.values.empty() ? "" : fmt::format("property float {}\n", extras.values_name), faces,
      edges == 0 ? "" : fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", edges));
}

}  // namespace

void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles, const PlyExtras& extras) {
  const auto last = static_cast<std::size_t>(std::ranges::count(extras.passed_through, 1));
  const bool has_uv = !extras.uv.empty();
  const auto is_edge = [](const std::array<Index, 3>& t) { return t[1] == t[2]; };
  const auto edges = static_cast<std::size_t>(std::ranges::count_if(triangles, is_edge));
  std::string content = header(positions.size(), triangles.size() - edges, edges, last, extras);
  const std::size_t values_at = kPlaceBytes + (has_uv ? kUvBytes : 0);
  const std::size_t vertex_bytes = values_at + (extras.values.empty() ? 0 : sizeof(float));
  const std::size_t vertices_at = content.size();
  const std::size_t faces_at = vertices_at + vertex_bytes * positions.size();
  const std::size_t edges_at = faces_at + kFaceBytes * (triangles.size() - edges);
  content.resize(edges_at + kEdgeBytes * edges);
  char* vertex = content.data() + vertices_at;
  for (std::size_t v = 0; v < positions.size(); ++v, vertex += vertex_bytes) {
    std::memcpy(vertex, positions[v].data(), kPlaceBytes);
    if (!extras.values.empty()) std::memcpy(vertex + values_at, &extras.values[v], sizeof(float));
    if (!has_uv) continue;
    const std::array<float, 2> uv{static_cast<float>(extras.uv[v].x()), static_cast<float>(extras.uv[v].y())};
    std::memcpy(vertex + kPlaceBytes, uv.data(), kUvBytes);
  }
  char *face = content.data() + faces_at, *edge = content.data() + edges_at;
  for (const bool passed : {false, true})
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (is_edge(triangles[t])) {
        if (passed) continue;
        std::memcpy(edge, triangles[t].data(), kEdgeBytes);
        edge += kEdgeBytes;
        continue;
      }
      if ((!extras.passed_through.empty() && extras.passed_through[t] != 0) != passed) continue;
      *face = 3;
      std::memcpy(face + 1, triangles[t].data(), kFaceBytes - 1);
      face += kFaceBytes;
    }
  write_file(file, content);
}

}  // namespace weft::mesh
