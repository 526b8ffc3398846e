#include "assets/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "mesh/geometry.hpp"
#include "mesh/quads.hpp"

namespace weft::assets {
namespace {

using Transform = Eigen::Matrix4d;

/// Faces flatter than this (area by longest side squared) count as having no area: their normal is rounding noise of
/// the file's single precision.
constexpr double kFlatFace = 1e-7;

/// Surfaces as they come out of the file: triangles and quads over vertices that may repeat.
struct Soup {
  std::vector<Vec3> positions;
  std::vector<mesh::Triangle> triangles;
  std::vector<mesh::Quad> quads;
};

/// Everything a message needs.
struct Source {
  const std::filesystem::path& file;
  const std::string& where;

  [[noreturn]] void fail(const std::string& why) const {
    throw Error(ExitCode::asset_unreadable, "{}: mesh file {}: {}", where, file.string(), why);
  }
};

void check_size(const Source& source) {
  std::error_code error;
  const auto status = std::filesystem::status(source.file, error);
  if (!std::filesystem::exists(status)) source.fail("expected a readable file, got none at this path");
  if (!std::filesystem::is_regular_file(status)) source.fail("expected a regular file, got a folder or a device");
  const std::uintmax_t bytes = std::filesystem::file_size(source.file, error);
  if (error) source.fail(error.message());
  if (bytes == 0) source.fail("expected a mesh, got an empty file");
  if (bytes > kMaxMeshFileBytes) {
    source.fail(
        fmt::format("expected at most {} MB, got {} MB; reduce the mesh", kMaxMeshFileBytes >> 20, bytes >> 20));
  }
}

Transform to_eigen(const aiMatrix4x4& m) {
  Transform result;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) result(r, c) = static_cast<double>(m[r][c]);
  return result;
}

/// Appends one mesh under a node's transform. Returns false if a face names a vertex that is not there.
bool append(Soup& soup, const aiMesh& part, const Transform& to_world, double scale) {
  const auto base = static_cast<Index>(soup.positions.size());
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D& x = part.mVertices[v];
    const Eigen::Vector4d world = to_world * Eigen::Vector4d(x.x, x.y, x.z, 1);
    // Adding zero makes -0 and 0 the same place.
    soup.positions.push_back(scale * world.head<3>() + Vec3::Zero());
  }
  // A mirroring transform turns faces inside out; reverse them to keep their outside.
  const bool mirrored = to_world.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices < 3 || face.mNumIndices > 4) continue;
    mesh::Quad corners{};
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= part.mNumVertices) return false;
      corners[k] = base + static_cast<Index>(face.mIndices[k]);
    }
    if (mirrored) std::reverse(corners.begin(), corners.begin() + face.mNumIndices);
    if (face.mNumIndices == 4) {
      soup.quads.push_back(corners);
    } else {
      soup.triangles.push_back({corners[0], corners[1], corners[2]});
    }
  }
  return true;
}

/// All meshes under all nodes. The walk keeps its own stack: files can nest nodes deeper than ours.
Soup collect(const aiScene& scene, double scale, const Source& source) {
  Soup soup;
  std::vector<std::pair<const aiNode*, Transform>> stack{{scene.mRootNode, to_eigen(scene.mRootNode->mTransformation)}};
  while (!stack.empty()) {
    const auto [node, to_world] = stack.back();
    stack.pop_back();
    for (unsigned m = 0; m < node->mNumMeshes; ++m) {
      const aiMesh& part = *scene.mMeshes[node->mMeshes[m]];
      if (soup.positions.size() + part.mNumVertices > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
        source.fail("expected fewer than 2^31 vertices");
      if (!append(soup, part, to_world, scale))
        source.fail(fmt::format("mesh \"{}\": a face names a vertex that is not there", part.mName.C_Str()));
    }
    for (unsigned c = node->mNumChildren; c-- > 0;) {
      const aiNode* child = node->mChildren[c];
      stack.emplace_back(child, to_world * to_eigen(child->mTransformation));
    }
  }
  return soup;
}

/// Joins vertices at exactly the same place and drops those that no face names. Vertices keep the order in which faces
/// first name them. Returns the number of vertices joined.
std::size_t join_vertices(Soup& soup) {
  const std::size_t n = soup.positions.size();
  const auto& x = soup.positions;
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index i) {
    const Vec3& p = x[static_cast<std::size_t>(i)];
    return std::array{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<Index> first(n);
  std::size_t joined = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const bool same = k > 0 && key(order[k]) == key(order[k - 1]);
    first[static_cast<std::size_t>(order[k])] = same ? first[static_cast<std::size_t>(order[k - 1])] : order[k];
    joined += same ? 1 : 0;
  }
  std::vector<Index> renamed(n, -1);
  std::vector<Vec3> kept;
  const auto rename = [&](Index& v) {
    const auto representative = static_cast<std::size_t>(first[static_cast<std::size_t>(v)]);
    if (renamed[representative] < 0) {
      renamed[representative] = static_cast<Index>(kept.size());
      kept.push_back(x[representative]);
    }
    v = renamed[representative];
  };
  for (auto& q : soup.quads) std::for_each(q.begin(), q.end(), rename);
  for (auto& t : soup.triangles) std::for_each(t.begin(), t.end(), rename);
  soup.positions = std::move(kept);
  return joined;
}

bool has_area(const mesh::Triangle& t, const std::vector<Vec3>& x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[static_cast<std::size_t>(t[k])]; };
  const double longest_sq = std::max({(corner(1) - corner(0)).squaredNorm(), (corner(2) - corner(1)).squaredNorm(),
                                      (corner(0) - corner(2)).squaredNorm()});
  return mesh::area_vector(t, x).norm() > kFlatFace * longest_sq;
}

/// A file of quads alone stays so, if each is a proper quad: then both halves have an area.
bool all_proper_quads(const Soup& soup, const std::vector<mesh::Triangle>& halves) {
  return soup.triangles.empty() &&
         std::all_of(halves.begin(), halves.end(), [&](const auto& t) { return has_area(t, soup.positions); });
}

const aiScene& read(Assimp::Importer& importer, const Source& source) {
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(source.file.string(), aiProcess_ValidateDataStructure);
    const auto larger = [](const aiMesh* part) {
      return std::any_of(part->mFaces, part->mFaces + part->mNumFaces,
                         [](const aiFace& f) { return f.mNumIndices > 4; });
    };
    // Quads are kept for us to split; where anything has more corners, assimp triangulates all.
    if (scene != nullptr && std::any_of(scene->mMeshes, scene->mMeshes + scene->mNumMeshes, larger))
      scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  } catch (const std::exception& error) {
    source.fail(error.what());
  }
  if (scene == nullptr || scene->mRootNode == nullptr) source.fail(importer.GetErrorString());
  return *scene;
}

}  // namespace

LoadedMesh load_mesh(const std::filesystem::path& file, double scale, const std::string& where) {
  const Source source{file, where};
  check_size(source);
  Assimp::Importer importer;
  Soup soup = collect(read(importer, source), scale, source);
  importer.FreeScene();
  if (soup.triangles.empty() && soup.quads.empty()) source.fail("expected faces, got none");
  if (!std::all_of(soup.positions.begin(), soup.positions.end(), [](const Vec3& x) { return x.allFinite(); }))
    source.fail("expected finite coordinates, got an infinite one or NaN");

  LoadedMesh result;
  result.joined_vertices = join_vertices(soup);
  std::vector<mesh::Triangle> triangles = mesh::split_quads(soup.quads, soup.positions);
  if (all_proper_quads(soup, triangles)) {
    result.mesh.topology.quads = std::move(soup.quads);
  } else {
    triangles.insert(triangles.end(), soup.triangles.begin(), soup.triangles.end());
    result.removed_faces = std::erase_if(triangles, [&](const auto& t) { return !has_area(t, soup.positions); });
  }
  if (triangles.empty()) source.fail("expected faces with an area, got none");
  result.mesh.topology.triangles = std::move(triangles);
  result.mesh.positions = std::move(soup.positions);
  return result;
}

}  // namespace weft::assets
