#include "mesh/ply.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

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

std::string header(std::size_t vertices, std::size_t faces) {
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment Weft, metres\n"
      "element vertex {}\n"
      "property double x\n"
      "property double y\n"
      "property double z\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "end_header\n",
      vertices, faces);
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) throw Error(ExitCode::asset_unreadable, "{}: cannot be read", file.string());
  return std::move(content).str();
}

/// The number after `element NAME ` in the header; 0 where there is none, which then fails the comparison of headers.
std::size_t count_of(std::string_view text, std::string_view element) {
  const std::size_t at = text.find(element);
  if (at == std::string_view::npos) return 0;
  std::size_t count = 0;
  for (const char digit : text.substr(at + element.size(), 10)) {
    if (digit < '0' || digit > '9') break;
    count = 10 * count + static_cast<std::size_t>(digit - '0');
  }
  return count;
}

}  // namespace

void write_ply(const std::filesystem::path& file, std::span<const Vec3> positions,
               std::span<const std::array<Index, 3>> triangles) {
  std::string content = header(positions.size(), triangles.size());
  const std::size_t vertices_at = content.size();
  const std::size_t faces_at = vertices_at + kVertexBytes * positions.size();
  content.resize(faces_at + kFaceBytes * triangles.size());
  if (!positions.empty()) std::memcpy(&content[vertices_at], positions.data(), kVertexBytes * positions.size());
  char* face = content.data() + faces_at;
  for (const auto& triangle : triangles) {
    *face = 3;
    std::memcpy(face + 1, triangle.data(), kFaceBytes - 1);
    face += kFaceBytes;
  }
  write_file(file, content);
}

PlyMesh read_ply(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  const auto fail = [&](std::string_view why) {
    throw Error(ExitCode::asset_unreadable, "{}: expected a PLY file written by Weft: {}", file.string(), why);
  };
  // The header is the one that write_ply makes for these counts, or the file is not ours.
  const std::string_view start = std::string_view(content).substr(0, 512);
  const std::size_t vertices = count_of(start, "element vertex ");
  const std::size_t faces = count_of(start, "element face ");
  const std::string expected = header(vertices, faces);
  if (!start.starts_with(expected)) fail("another header");
  if (content.size() != expected.size() + kVertexBytes * vertices + kFaceBytes * faces) {
    fail(fmt::format("{} bytes do not hold {} vertices and {} triangles", content.size(), vertices, faces));
  }
  PlyMesh mesh;
  mesh.positions.resize(vertices);
  mesh.triangles.resize(faces);
  const char* at = content.data() + expected.size();
  if (vertices > 0) std::memcpy(static_cast<void*>(mesh.positions.data()), at, kVertexBytes * vertices);
  at += kVertexBytes * vertices;
  for (auto& triangle : mesh.triangles) {
    if (*at != 3) fail("a face is no triangle");
    std::memcpy(triangle.data(), at + 1, kFaceBytes - 1);
    at += kFaceBytes;
    for (const Index v : triangle)
      if (static_cast<std::size_t>(v) >= vertices)  // negative ones become huge
        fail("a face names a vertex that is not there");
  }
  return mesh;
}

}  // namespace weft::mesh
