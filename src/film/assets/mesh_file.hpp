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
  mesh::Mesh mesh;  ///< in metres, without uv; made of quads if the file has nothing else
  /// Texture coordinates of the corners of each triangle, v upward; they can differ between triangles at one vertex.
  /// NaN for meshes of the file without them; empty if none has any.
  std::vector<std::array<Vec2, 3>> uv;
  std::vector<Vec3> colors;  ///< per vertex, channels 0 to 1; 0 for meshes without them; empty: none has any
  /// By vertex group or bone of the file: the weight of each vertex, from 0 to 1. A merged vertex keeps the largest
  /// weight and the largest value of each colour channel.
  std::map<std::string, std::vector<double>> groups;
  std::size_t removed_triangles = 0;  ///< triangles without area
  std::size_t lost_vertices = 0;      ///< vertices that only removed triangles use
  std::size_t joined_vertices = 0;    ///< merged copies with equal positions, made for different UVs or normals
};

/// How to interpret the lengths and axes of a mesh file. If the file (glTF, FBX, Collada) or the scene states the up
/// axis of the file, the mesh is rotated to the axes of the scene; else `default_up` is the up axis.
struct MeshAxes {
  double scale = 1;  ///< factor on all lengths
  scene::FileUp up = scene::FileUp::as_file;
  scene::UpAxis scene_up = scene::UpAxis::z;
  scene::FileUp default_up = scene::FileUp::as_file;  ///< as_file: the up axis of the scene
};

/// Reads all surfaces of a file (OBJ, PLY, STL, glTF and other formats of assimp), or those named `object`, as one
/// mesh. Applies the transforms of their nodes; an animated file is in its bind pose. Ignores points and lines.
/// Positions are in metres if the file states its unit (FBX, Collada). Merges equal positions, so that a closed body is
/// watertight. `where` names the scene entry, such as "scenes/a.toml:12:8: obstacle.chair". Throws
/// Error(asset_unreadable) with `where`, the file and the reason.
LoadedMesh load_mesh(const std::filesystem::path& file, const MeshAxes& axes, const std::string& where,
                     const std::string& object = {});

/// The result of weld_borders().
struct Welded {
  std::size_t vertices = 0;  ///< number of merged vertices
  double widest = 0;         ///< largest distance between merged vertices [m]
};

/// Merges border vertices that nearly coincide, as in files that keep panels separate. Two vertices are merged at their
/// mean if their distance is below `ratio` times the shortest border edge at each of them. If merging would create an
/// edge of three triangles, or of two that face opposite ways, changes nothing.
Welded weld_borders(LoadedMesh& loaded, double ratio);

}  // namespace weft::assets
