// Faces as they come out of a file, before anything is joined or removed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/topology.hpp"

namespace weft::assets {

/// Triangles and quads over vertices that may repeat; all indices are in range.
struct Soup {
  std::vector<Vec3> positions;  ///< in metres where the file says its unit
  std::vector<Vec2> uv;         ///< per position, v upward; NaN where its mesh has none
  std::vector<Vec3> colors;     ///< likewise; NaN where its mesh has none
  /// Weights of the groups of vertices, or bones: number among group_names, place among positions, and weight.
  struct Weight {
    Index group, vertex;
    double weight;
  };
  std::vector<Weight> weights;
  std::vector<std::string> group_names;
  std::vector<mesh::Triangle> triangles;
  std::vector<mesh::Quad> quads;
  std::vector<int> up;  ///< axis that points up as the file or its format says: 0 x, 1 y, 2 z; none: it does not say
};

/// Reads the meshes of a file with the transforms of their nodes, those that are named `object`, or whose node is, or
/// all where that is empty. Larger polygons are triangulated, points and lines ignored. Throws std::runtime_error with
/// assimp's words, or with the names that there are. Damaged files can crash assimp or keep it busy for ever:
/// call it through run_isolated.
Soup read_soup(const std::filesystem::path& file, const std::string& object = {});

/// Appends a polygon of the soup's vertices; one of more than four corners is triangulated.
void append_face(Soup& soup, std::span<const Index> corners);

/// The joined surface of a soup: triangles, and quads where the soup holds nothing else and none of them is flat.
/// Triangles without area (a corner named twice, or all corners on a line) are left out and counted.
mesh::Topology make_topology(const Soup& soup, std::size_t& removed_triangles);

/// A soup as plain bytes, for the way between two processes of the same program, and back.
std::string to_bytes(const Soup& soup);
Soup from_bytes(std::string_view bytes);

}  // namespace weft::assets
