// Reads PLY files that `weft run --meshes` writes.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace weft::support {

struct PlyMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> triangles;
  std::size_t passed_through = 0;  // number of triangles, at the end of the list, that cloth may pass through
};

/// Reads a file; positions keep all their bits. Throws std::runtime_error if the length of the file differs from its
/// header, or if a face is not a triangle of its vertices.
inline PlyMesh read_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const auto expect = [&](bool holds) {
    if (!holds) throw std::runtime_error(path.string() + " is not as Weft writes PLY files");
  };
  const auto after = [&](const std::string& text) {
    const std::size_t at = bytes.find(text);
    expect(at != std::string::npos);
    return at + text.size();
  };
  PlyMesh mesh;
  mesh.positions.resize(std::stoul(bytes.substr(after("element vertex "))));
  mesh.triangles.resize(std::stoul(bytes.substr(after("element face "))));
  std::size_t edges = 0;
  if (const std::size_t said = bytes.find("element edge "); said < bytes.find("end_header\n"))
    edges = std::stoul(bytes.substr(said + std::strlen("element edge ")));
  const std::string comment = "comment cloth passes through the last ";
  if (const std::size_t said = bytes.find(comment); said < after("end_header\n"))
    mesh.passed_through = std::stoul(bytes.substr(said + comment.size()));
  expect(mesh.passed_through <= mesh.triangles.size());
  std::size_t at = after("end_header\n");
  // A heat value may follow each position; it is not read.
  const std::size_t vertex_size = sizeof(Vec3) + (bytes.find("property float ") < at ? sizeof(float) : 0);
  expect(bytes.size() == at + vertex_size * mesh.positions.size() + 13 * mesh.triangles.size() + 8 * edges);
  for (Vec3& position : mesh.positions) {
    std::memcpy(static_cast<void*>(position.data()), &bytes[at], sizeof(Vec3));
    at += vertex_size;
  }
  for (auto& triangle : mesh.triangles) {
    expect(bytes[at] == 3);
    std::memcpy(triangle.data(), &bytes[at + 1], 12);
    for (const Index v : triangle) expect(v >= 0 && static_cast<std::size_t>(v) < mesh.positions.size());
    at += 13;
  }
  // Reads pieces of rope as faces (a, b, b), as the simulation represents them.
  for (; edges > 0; --edges, at += 8) {
    std::array<Index, 2> ends;
    std::memcpy(ends.data(), &bytes[at], 8);
    for (const Index v : ends) expect(v >= 0 && static_cast<std::size_t>(v) < mesh.positions.size());
    mesh.triangles.push_back({ends[0], ends[1], ends[1]});
  }
  return mesh;
}

}  // namespace weft::support
