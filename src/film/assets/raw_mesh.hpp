// The faces of a file before any merging or removal.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "physics/mesh/mesh.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::assets {

/// The faces of a file. Several vertices may have the same position; all indices are in range.
struct RawMesh {
  std::vector<Vec3> positions;  ///< in metres if the file states its unit
  std::vector<Vec2> uv;         ///< per position, v upward; NaN if its mesh in the file has none
  std::vector<Vec3> colors;     ///< per position; NaN if its mesh in the file has none
  /// Weight of a vertex in a vertex group or bone. `group` and `vertex`: indices into group_names and positions.
  struct Weight {
    Index group, vertex;
    double weight;
  };
  std::vector<Weight> weights;
  std::vector<std::string> group_names;
  std::vector<mesh::Triangle> triangles;
  std::vector<mesh::Quad> quads;
  /// The faces other than quads, before their division into triangles: for each face, the number of its corners, then
  /// their vertex indices.
  std::vector<Index> polygons;
  std::optional<int> up;  ///< up axis of the file or its format: 0 x, 1 y, 2 z; absent: not stated
};

/// Reads the meshes whose name or whose node's name is `object` (empty: all meshes), and transforms them to the world.
/// Ignores points and lines. Throws std::runtime_error with the message of assimp or, if no mesh with vertices has the
/// name, with the existing names. Call this function only through run_isolated(), because damaged files can crash
/// assimp or block it for ever.
RawMesh read_raw_mesh(const std::filesystem::path& file, const std::string& object = {});

/// Appends a face. Divides a face that is no quad into triangles.
void append_face(RawMesh& raw, std::span<const Index> corners);

/// Joins the vertices of each group: replaces the vertices of faces by new ones, one per group with a face, in the
/// order of their first use. Leaves positions and other data as they are. `groups`: per vertex, its group, a number
/// below the number of vertices; becomes the new vertex, or -1 if no face uses the group. Returns for each new vertex
/// the old one that is used first.
std::vector<Index> join_groups(RawMesh& raw, std::vector<Index>& groups);

/// The surface of a raw mesh. If the raw mesh has only quads, and both halves of each quad have an area, the surface
/// has these quads. Otherwise, it has only triangles with an area; sets `removed_triangles` to the number of the
/// others. A triangle has no area if it has a repeated corner or all corners on a line, in `raw` and in all
/// `later_positions` (positions in later files of a sequence).
mesh::Topology make_topology(const RawMesh& raw, std::size_t& removed_triangles,
                             std::span<const std::vector<Vec3>> later_positions = {});

/// Serialises a raw mesh for transfer between two processes of the same program.
std::string to_bytes(RawMesh raw);
/// The reverse of to_bytes(). Throws std::runtime_error if the data are incomplete.
RawMesh from_bytes(std::string_view bytes);

}  // namespace weft::assets
