#include "film/assets/raw_mesh.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "core/archive.hpp"
#include "film/assets/import.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/mesh/polygon.hpp"
#include "physics/mesh/quads.hpp"

namespace weft::assets {
namespace {

using Transform = Eigen::Matrix4d;

/// A triangle counts as having no area if the ratio area / (longest side)² is smaller than this. Its normal then
/// consists only of rounding errors, because assimp uses single precision.
constexpr double kMinFaceArea = 1e-7;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool has_area(const mesh::Triangle& t, const std::vector<Vec3>& x) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return x[t[k]]; };
  const double longest_sq = std::max({(corner(1) - corner(0)).squaredNorm(), (corner(2) - corner(1)).squaredNorm(),
                                      (corner(0) - corner(2)).squaredNorm()});
  return mesh::area_vector(t, x).norm() > kMinFaceArea * longest_sq;
}

Transform to_eigen(const aiMatrix4x4& m) {
  Transform result;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) result(r, c) = static_cast<double>(m[r][c]);
  return result;
}

/// Appends the bones of a mesh as vertex groups. Bones of the same name form one group.
void append_groups(RawMesh& raw, const aiMesh& part, std::size_t base) {
  for (const aiBone* bone : std::span(part.mBones, part.mNumBones)) {
    const auto known = std::ranges::find(raw.group_names, bone->mName.C_Str());
    const auto group = static_cast<Index>(known - raw.group_names.begin());
    if (known == raw.group_names.end()) raw.group_names.emplace_back(bone->mName.C_Str());
    for (const aiVertexWeight& weight : std::span(bone->mWeights, bone->mNumWeights))
      if (weight.mVertexId < part.mNumVertices)
        raw.weights.push_back({group, static_cast<Index>(base + weight.mVertexId), weight.mWeight});
  }
}

/// Appends one mesh, transformed to the world. Morph targets have the weights that the file states.
void append_mesh(RawMesh& raw, const aiScene& scene, const aiMesh& part, const Transform& to_world) {
  const std::size_t base = raw.positions.size();
  if (base + part.mNumVertices > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw std::runtime_error("expected fewer than 2^31 vertices");
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    aiVector3D x = part.mVertices[v];
    for (const aiAnimMesh* target : std::span(part.mAnimMeshes, part.mNumAnimMeshes))
      if (target->HasPositions() && v < target->mNumVertices)
        x += (target->mVertices[v] - part.mVertices[v]) * static_cast<ai_real>(rest_weight(scene, *target));
    const Eigen::Vector4d world = to_world * Eigen::Vector4d(x.x, x.y, x.z, 1);
    raw.positions.push_back(world.head<3>());
    raw.uv.emplace_back(kNone, kNone);
    if (part.HasTextureCoords(0)) raw.uv.back() = {part.mTextureCoords[0][v].x, part.mTextureCoords[0][v].y};
    raw.colors.emplace_back(kNone, kNone, kNone);
    if (part.HasVertexColors(0)) raw.colors.back() = {part.mColors[0][v].r, part.mColors[0][v].g, part.mColors[0][v].b};
  }
  append_groups(raw, part, base);
  // If the transform mirrors, faces would point inward. Reverses the order of their corners.
  const bool mirrored = to_world.topLeftCorner<3, 3>().determinant() < 0;
  std::vector<Index> corners;
  for (const aiFace& face : std::span(part.mFaces, part.mNumFaces)) {
    if (face.mNumIndices < 3) continue;
    corners.clear();
    for (const unsigned v : std::span(face.mIndices, face.mNumIndices)) {
      if (v >= part.mNumVertices)
        throw std::runtime_error(
            fmt::format("mesh \"{}\": a face names vertex {} of {}", part.mName.C_Str(), v, part.mNumVertices));
      corners.push_back(static_cast<Index>(base + v));
    }
    if (mirrored) std::reverse(corners.begin(), corners.end());
    append_face(raw, corners);
  }
}

/// A node and its transform to the world.
using PlacedNode = std::pair<const aiNode*, Transform>;

std::vector<PlacedNode> placed_nodes(const aiNode& root) {
  std::vector<PlacedNode> nodes;
  // The traversal has its own stack, because nodes of a file can be nested more deeply than the call stack allows.
  std::vector<PlacedNode> stack{{&root, to_eigen(root.mTransformation)}};
  while (!stack.empty()) {
    const auto [node, to_world] = stack.back();
    stack.pop_back();
    nodes.emplace_back(node, to_world);
    for (unsigned c = node->mNumChildren; c-- > 0;) {
      const aiNode* child = node->mChildren[c];
      // assimp's importer of RAW files (lists of triangles) leaves some child pointers null.
      if (child != nullptr) stack.emplace_back(child, to_world * to_eigen(child->mTransformation));
    }
  }
  return nodes;
}

/// Transform from mesh to world. For a mesh without usable bones, it is the transform of the mesh's node. Otherwise, it
/// is (bone's node to world) × (bone offset) of the bone with the largest sum of weights. A bone is not usable if this
/// product is nearly singular. character_reader.cpp uses the same rule. The reason for the rule: in glTF, bones alone
/// determine the position of a skinned mesh; the node that refers to the mesh has no effect.
Transform placement_of(const aiMesh& part, const Transform& of_node,
                       const std::unordered_map<std::string, Transform>& placed) {
  Transform placing = of_node;
  double most = 0;
  for (const aiBone* bone : std::span(part.mBones, part.mNumBones)) {
    double total = 0;
    for (const aiVertexWeight& w : std::span(bone->mWeights, bone->mNumWeights)) total += w.mWeight;
    const auto found = placed.find(bone->mName.C_Str());
    if (!(total > most) || found == placed.end()) continue;
    const Transform held = found->second * to_eigen(bone->mOffsetMatrix);
    const double size = held.topLeftCorner<3, 3>().norm();
    constexpr double kMinVolumeRatio = 1e-9;  // minimum |det M| / ‖M‖³ of a transform that is used
    if (!held.allFinite() ||
        !(std::abs(held.topLeftCorner<3, 3>().determinant()) > kMinVolumeRatio * size * size * size))
      continue;
    most = total, placing = held;
  }
  return placing;
}

/// Whether two meshes have a bone with the same offset in common. Such meshes of a node are parts of one mesh, which
/// assimp divides by its materials.
bool share_bone(const aiMesh& a, const aiMesh& b) {
  return std::ranges::any_of(std::span(a.mBones, a.mNumBones), [&](const aiBone* of_a) {
    return std::ranges::any_of(std::span(b.mBones, b.mNumBones), [&](const aiBone* of_b) {
      return of_a->mName == of_b->mName && of_a->mOffsetMatrix == of_b->mOffsetMatrix;
    });
  });
}

template <class Archive>
void serialize(Archive& archive, RawMesh& raw) {
  serialize_plain(archive, raw.positions);
  serialize_plain(archive, raw.uv);
  serialize_plain(archive, raw.colors);
  serialize_plain(archive, raw.weights);
  serialize_each(archive, raw.group_names, [&](std::string& name) { serialize_plain(archive, name); });
  serialize_plain(archive, raw.triangles);
  serialize_plain(archive, raw.quads);
  serialize_plain(archive, raw.polygons);
  archive.value(raw.up);
}

}  // namespace

void append_face(RawMesh& raw, std::span<const Index> corners) {
  if (corners.size() == 4) {
    raw.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
  } else {
    raw.polygons.push_back(static_cast<Index>(corners.size()));
    raw.polygons.insert(raw.polygons.end(), corners.begin(), corners.end());
    mesh::triangulate_face(corners, raw.positions, raw.triangles);
  }
}

RawMesh read_raw_mesh(const std::filesystem::path& file, const std::string& object) {
  Assimp::Importer importer;
  const aiScene* scene = &import(importer, file, aiProcess_ValidateDataStructure);
  RawMesh raw;
  std::set<std::string> names;
  const std::vector<PlacedNode> nodes = placed_nodes(*scene->mRootNode);
  // Transforms of nodes by name. If several nodes have the same name, the first without a mesh counts, or the first if
  // all have meshes.
  std::unordered_map<std::string, Transform> placed;
  for (const bool has_mesh : {false, true})
    for (const auto& [node, to_world] : nodes)
      if ((node->mNumMeshes > 0) == has_mesh) placed.emplace(node->mName.C_Str(), to_world);
  for (const auto& [node, to_world] : nodes) {
    const aiMesh* first = nullptr;  // first mesh of the node that is read
    Transform placement_of_first = Transform::Identity();
    for (unsigned k = 0; k < node->mNumMeshes; ++k) {
      const aiMesh& part = *scene->mMeshes[node->mMeshes[k]];
      const std::set<std::string> own = names_of_mesh(*scene, *node, k);
      names.insert(own.begin(), own.end());
      if (!object.empty() && !own.contains(object)) continue;
      // Rounding errors of two placements would separate parts of one mesh.
      const bool is_same = first != nullptr && share_bone(*first, part);
      const Transform placement = is_same ? placement_of_first : placement_of(part, to_world, placed);
      if (first == nullptr) first = &part, placement_of_first = placement;
      append_mesh(raw, *scene, part, placement);
    }
  }
  if (!object.empty() && raw.positions.empty()) {
    names.erase("");
    throw std::runtime_error(
        fmt::format("expected a mesh or node named \"{}\", got {}", object,
                    names.empty() ? "none with a name" : fmt::format("{}", fmt::join(names, ", "))));
  }
  if (const auto metres = metres_per_unit(*scene))
    for (Vec3& x : raw.positions) x *= *metres;
  raw.up = up_axis(importer, *scene);
  return raw;
}

std::vector<Index> join_groups(RawMesh& raw, std::vector<Index>& groups) {
  std::vector<Index> joined(groups.size(), -1), kept;  // joined: new vertex of each group
  const auto rename = [&](Index& v) {
    Index& vertex = joined[at(groups[at(v)])];
    if (vertex < 0) {
      vertex = static_cast<Index>(kept.size());
      kept.push_back(v);
    }
    v = vertex;
  };
  for (auto& q : raw.quads) std::for_each(q.begin(), q.end(), rename);
  for (auto& t : raw.triangles) std::for_each(t.begin(), t.end(), rename);
  for (Index& group : groups) group = joined[at(group)];
  return kept;
}

mesh::Topology make_topology(const RawMesh& raw, std::size_t& removed_triangles,
                             std::span<const std::vector<Vec3>> later_positions) {
  mesh::Topology topology;
  topology.triangles = mesh::split_quads(raw.quads, raw.positions);
  const auto flat = [&](const mesh::Triangle& t) {
    return !has_area(t, raw.positions) &&
           std::ranges::none_of(later_positions, [&](const std::vector<Vec3>& x) { return has_area(t, x); });
  };
  if (raw.triangles.empty() && std::none_of(topology.triangles.begin(), topology.triangles.end(), flat)) {
    topology.quads = raw.quads;
  } else {
    topology.triangles.insert(topology.triangles.end(), raw.triangles.begin(), raw.triangles.end());
    removed_triangles = std::erase_if(topology.triangles, flat);
  }
  return topology;
}

std::string to_bytes(RawMesh raw) {
  ByteWriter writer;
  serialize(writer, raw);
  return std::move(writer.bytes);
}

RawMesh from_bytes(std::string_view bytes) {
  RawMesh raw;
  ByteReader reader{bytes};
  serialize(reader, raw);
  return raw;
}

}  // namespace weft::assets
