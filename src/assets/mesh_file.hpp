// Static meshes from files, through assimp.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "assets/source.hpp"
#include "mesh/mesh.hpp"
#include "scene/scene.hpp"

namespace weft::assets {

/// A mesh and what was done to it.
struct LoadedMesh {
  mesh::Mesh mesh;  ///< metres; no uv. Quads stay quads if the file holds nothing else
  /// Of the corners of each triangle, as the file has it, v upward: islands of one vertex differ. NaN where a part of
  /// the file has none; empty where all have none.
  std::vector<std::array<Vec2, 3>> uv;
  std::vector<Vec3> colors;  ///< per vertex, each channel from 0 to 1; empty where no part of the file has any
  /// Weight from 0 to 1 of each vertex in the groups of the file, or its bones. Of vertices that became one these and
  /// the channels of colours are the largest.
  std::map<std::string, std::vector<double>> groups;
  std::size_t removed_triangles = 0;  ///< without area: a corner named twice, or all corners on a line
  std::size_t lost_vertices = 0;      ///< that only such triangles have
  std::size_t joined_vertices = 0;    ///< copies at the same place, as made by seams of texture or normals
};

/// How lengths and axes of a mesh file are meant. It is turned where the file says which axis points up (glTF, FBX,
/// Collada), or the scene does; other files have the axes of the scene.
struct MeshAxes {
  double scale = 1;  ///< factor on all lengths
  scene::FileUp up = scene::FileUp::as_file;
  scene::UpAxis scene_up = scene::UpAxis::z;
  scene::FileUp unsaid = scene::FileUp::as_file;  ///< of files that do not say it; as_file: that of the scene
};

/// Reads every surface of the file, or those named `object` (OBJ, PLY, STL, glTF and what else assimp knows), all
/// meshes merged with the transforms of their nodes, in the bind pose where the file is animated. Positions are in
/// metres where the file says its unit (FBX, Collada). Points and lines are ignored; equal
/// positions become one vertex, so that a closed body is watertight. `where` names what refers to the file, such as
/// "scenes/a.toml:12:8: obstacle.chair". Throws Error(asset_unreadable) with `where`, the file and assimp's own words.
LoadedMesh load_mesh(const std::filesystem::path& file, const MeshAxes& axes, const std::string& where,
                     const std::string& object = {});

/// What weld_borders() did.
struct Welded {
  std::size_t vertices = 0;  ///< that became one with others
  double widest = 0;         ///< distance between two of them [m]
};

/// Joins vertices of borders that nearly meet, as the sides of seams do in files that keep their panels apart: those
/// nearer to each other than a `share` of the shortest edge of the border at either, in their middle. Where that would
/// leave an edge of three triangles, or of two that face both ways, nothing is done.
Welded weld_borders(LoadedMesh& loaded, double share);

}  // namespace weft::assets
