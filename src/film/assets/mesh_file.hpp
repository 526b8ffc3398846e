// Reads static meshes from files, through assimp.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "film/assets/source.hpp"
#include "film/scene/scene.hpp"
#include "physics/mesh/mesh.hpp"

namespace weft::assets {

/// A mesh, and counts of the repairs that were made while reading it.
struct LoadedMesh {
  mesh::Mesh mesh;  ///< in metres, without uv; has quads if all faces of the file are quads with an area
  /// Texture coordinates of the corners of each triangle, v upward; they can differ between triangles at one vertex.
  /// NaN for meshes of the file without texture coordinates; empty if no mesh has them.
  std::vector<std::array<Vec2, 3>> uv;
  /// Per vertex, channels 0 to 1. 0 for meshes of the file without colours; empty if no mesh has them.
  std::vector<Vec3> colors;
  /// By vertex group or bone of the file: the weight of each vertex, from 0 to 1. A merged vertex keeps the largest
  /// weight and the largest value of each colour channel.
  std::map<std::string, std::vector<double>> groups;
  std::size_t removed_triangles = 0;  ///< triangles without area
  std::size_t lost_vertices = 0;      ///< vertices that only removed triangles use
  std::size_t joined_vertices = 0;    ///< copies of a vertex (for other UVs or normals) that were merged
};

/// How to interpret the lengths and axes of a mesh file. If `up` is as_file, the up axis of the file is that stated in
/// the file (glTF, FBX, Collada), or `default_up` if the file states none. The mesh is rotated to the axes of the
/// scene.
struct MeshAxes {
  double scale = 1;  ///< factor on all lengths
  scene::FileUp up = scene::FileUp::as_file;
  scene::UpAxis scene_up = scene::UpAxis::z;
  scene::FileUp default_up = scene::FileUp::as_file;  ///< as_file: the up axis of the scene
};

/// Reads the surfaces of a file (OBJ, PLY, STL, glTF and other formats of assimp) as one mesh: those of the mesh or
/// node `object`, or all if it is empty. Applies the transforms of nodes. A skinned mesh keeps its bind pose; the bone
/// with the largest sum of weights determines its position. Ignores points and lines. Converts positions to metres if
/// the file states its unit (FBX, Collada). Merges equal positions, so that a closed body is watertight. `where` names
/// the scene entry, such as "scenes/a.toml:12:8: obstacle.chair". Throws Error(asset_unreadable) with `where`, the file
/// and the reason.
LoadedMesh load_mesh(const std::filesystem::path& file, const MeshAxes& axes, const std::string& where,
                     const std::string& object = {});

/// The result of weld_borders().
struct Welded {
  std::size_t vertices = 0;  ///< number of removed vertices
  double widest = 0;         ///< largest distance between merged vertices [m]
};

/// Merges border vertices that nearly coincide, as in files in which panels are separate. Merges two vertices if their
/// distance is at most `ratio` times the shortest border edge at each of them, and places them at their mean position.
/// If the merged mesh is not manifold, changes nothing and returns zeros.
Welded weld_borders(LoadedMesh& loaded, double ratio);

}  // namespace weft::assets
