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

/// A mesh, and the clean-up that was applied.
struct LoadedMesh {
  mesh::Mesh mesh;  ///< in metres, without uv. Quads are kept if the file contains nothing else
  /// Texture coordinates of the corners of each triangle, v upward; a vertex may have different ones in different
  /// triangles. NaN for parts without them; empty if no part has any.
  std::vector<std::array<Vec2, 3>> uv;
  std::vector<Vec3> colors;  ///< per vertex, each channel from 0 to 1 (0 for parts without); empty if no part has any
  /// Weight (0 to 1) of each vertex in each vertex group or bone of the file. Merged vertices keep the largest weight
  /// and the largest value of each colour channel.
  std::map<std::string, std::vector<double>> groups;
  std::size_t removed_triangles = 0;  ///< without area: a repeated corner, or all corners on a line
  std::size_t lost_vertices = 0;      ///< used only by removed triangles
  std::size_t joined_vertices = 0;    ///< copies at the same position, made for different UVs or normals
};

/// Interpretation of the lengths and axes of a mesh file. If the file (glTF, FBX, Collada) or the scene states the up
/// axis of the file, the mesh is rotated to the axes of the scene; else `default_up` decides.
struct MeshAxes {
  double scale = 1;  ///< factor on all lengths
  scene::FileUp up = scene::FileUp::as_file;
  scene::UpAxis scene_up = scene::UpAxis::z;
  scene::FileUp default_up =
      scene::FileUp::as_file;  ///< up axis of files that state none; as_file: the up axis of the scene
};

/// Reads all surfaces of a file (OBJ, PLY, STL, glTF and other formats of assimp), or those named `object`, as one
/// mesh. Applies the transforms of their nodes; an animated file is in its bind pose. Positions are in metres if the
/// file states its unit (FBX, Collada). Ignores points and lines. Merges equal positions, so that a closed body is
/// watertight. `where` names the scene entry, such as "scenes/a.toml:12:8: obstacle.chair". Throws
/// Error(asset_unreadable) with `where`, the file and assimp's own message.
LoadedMesh load_mesh(const std::filesystem::path& file, const MeshAxes& axes, const std::string& where,
                     const std::string& object = {});

/// Report of weld_borders().
struct Welded {
  std::size_t vertices = 0;  ///< number of merged vertices
  double widest = 0;         ///< largest distance between merged vertices [m]
};

/// Welds nearly coincident border vertices, as in files that keep panels separate. Vertices are merged at their mean if
/// their distance is below `ratio` times the shortest border edge at either of them. If this would create an edge of
/// three triangles, or of two that face opposite ways, nothing at all is changed.
Welded weld_borders(LoadedMesh& loaded, double ratio);

}  // namespace weft::assets
