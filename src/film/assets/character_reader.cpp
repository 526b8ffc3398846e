#include "film/assets/character_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "film/assets/clip_reader.hpp"
#include "film/assets/import.hpp"
#include "film/assets/material_reader.hpp"
#include "film/assets/raw_mesh.hpp"
#include "physics/mesh/polygon.hpp"

namespace weft::assets {
namespace {

using character::Affine;

/// Maximum number of vertices of all meshes before merging. Collision cannot handle nearly as many.
constexpr std::size_t kMaxVertices = 4'000'000;

/// Maximum distance without a warning between the skin in the rest pose of the nodes and in its bind pose [m].
constexpr double kMaxBindError = 0.05;

/// Maximum difference without a warning between 1 and the sum of a vertex's weights. Smaller differences come from
/// rounding, and from formats that store few bits.
constexpr double kWeightSlack = 0.02;

Affine to_affine(const aiMatrix4x4& m) {
  Affine map;
  map.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return map;
}

bool invertible(const Affine& map) {
  const double size = map.linear().norm();
  return std::abs(map.linear().determinant()) > 1e-9 * size * size * size;
}

/// A node, and the index of its parent in the same list.
using NodeWithParent = std::pair<const aiNode*, Index>;

/// All nodes, parents before their children. Uses aiNode::mParent, because assimp 5.2 lists all bones of Half-Life
/// models as children of one node, and stores their parents only there. If mParent does not lead to all nodes, uses the
/// lists of children instead.
std::vector<NodeWithParent> nodes_with_parents(const aiNode& root) {
  using Children = std::unordered_map<const aiNode*, std::vector<const aiNode*>>;
  // The traversal has its own stack, because nodes of a file can be nested more deeply than the call stack allows.
  const auto walk = [&](const auto& children_of) {
    std::vector<NodeWithParent> nodes;
    std::vector<NodeWithParent> stack{{&root, -1}};
    while (!stack.empty()) {
      const NodeWithParent next = stack.back();
      stack.pop_back();
      nodes.push_back(next);
      const auto children = children_of(*next.first);
      for (std::size_t c = children.size(); c-- > 0;)
        // assimp's importer of RAW files (lists of triangles) leaves some child pointers null.
        if (children[c] != nullptr) stack.emplace_back(children[c], Index(nodes.size()) - 1);
    }
    return nodes;
  };
  std::vector<NodeWithParent> listed =
      walk([](const aiNode& node) { return std::span<aiNode* const>(node.mChildren, node.mNumChildren); });
  Children named;
  for (const auto& [node, parent] : listed)
    if (node != &root) named[node->mParent].push_back(node);
  std::vector<NodeWithParent> by_name = walk([&](const aiNode& node) { return named[&node]; });
  return by_name.size() == listed.size() ? by_name : listed;
}

/// The weights of one vertex, by bone.
using Weights = std::vector<character::Influence>;

/// Converts one file.
class CharacterReader {
 public:
  CharacterReader(const aiScene& scene, const std::filesystem::path& file, const MeshChoice& choice)
      : scene_(scene), file_(file), choice_(choice) {}

  ReadCharacter read() {
    read_nodes();
    for (const aiMaterial* material : std::span(scene_.mMaterials, scene_.mNumMaterials))
      character_.materials.emplace_back(material->GetName().C_Str());
    std::set<std::string> names;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      placing_of_skin_.reset();
      for (unsigned k = 0; k < nodes_[n]->mNumMeshes; ++k) {
        const unsigned m = nodes_[n]->mMeshes[k];
        if (m >= scene_.mNumMeshes)
          throw std::runtime_error(fmt::format("node \"{}\": expected one of {} meshes, got number {}",
                                               character_.nodes[n].name, scene_.mNumMeshes, m));
        const std::set<std::string> own = names_of_mesh(scene_, *nodes_[n], k);
        names.insert(own.begin(), own.end());
        if (is_chosen(own))
          read_mesh(*scene_.mMeshes[m], static_cast<Index>(n));
        else
          targets_.left_out.insert(own.begin(), own.end());
      }
    }
    check_choice(names);
    const RawMesh unjoined = raw_mesh_;
    join_vertices();
    make_faces();
    color_faces(unjoined);
    for (const aiAnimation* animation : std::span(scene_.mAnimations, scene_.mNumAnimations))
      character_.clips.push_back(to_clip(*animation, targets_, read_.warnings));
    name_clips();
    read_.metres_per_unit = metres_per_unit(scene_);
    return std::move(read_);
  }

 private:
  /// `own`: the names of a mesh, as of names_of_mesh().
  bool is_chosen(const std::set<std::string>& own) const {
    const auto names_it = [&](const std::vector<std::string>& list) {
      return std::ranges::any_of(list, [&](const std::string& name) { return own.contains(name); });
    };
    return (choice_.only.empty() || names_it(choice_.only)) && !names_it(choice_.without) &&
           !names_it(choice_.elsewhere);
  }

  void check_choice(std::set<std::string> names) const {
    names.erase("");
    for (const auto& [key, list] : {std::pair{"meshes", &choice_.only}, {"without", &choice_.without}})
      for (const std::string& name : *list)
        if (!names.contains(name))
          throw std::runtime_error(
              fmt::format("{}: expected names of meshes or of their nodes, such as \"{}\", got \"{}\"", key,
                          fmt::join(names, "\", \""), name));
  }

  void read_nodes() {
    for (const auto& [node, parent] : nodes_with_parents(*scene_.mRootNode)) {
      const std::string name = node->mName.C_Str();
      // In FBX and glTF, a mesh can have the name of a bone. A name refers to the first node of this name that has no
      // mesh. If all nodes of this name have meshes, it refers to the first one.
      const auto [named, is_new] = targets_.nodes.emplace(name, static_cast<Index>(nodes_.size()));
      if (!is_new && nodes_[named->second]->mNumMeshes > 0 && node->mNumMeshes == 0)
        named->second = static_cast<Index>(nodes_.size());
      nodes_.push_back(node);
      character_.nodes.push_back({name, parent, to_affine(node->mTransformation)});
      const Affine& local = character_.nodes.back().local;
      if (!local.matrix().allFinite())
        throw std::runtime_error(fmt::format("node \"{}\": its transform {}", name, kNotFinite));
      globals_.push_back(parent < 0 ? local : globals_[parent] * local);
    }
  }

  void read_mesh(const aiMesh& mesh, Index node) {
    const std::string name = mesh.mName.C_Str();
    const bool faces = std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                                   [](const aiFace& face) { return face.mNumIndices >= 3; });
    if (!faces) return;
    // Reads a skinned mesh only once, even if several nodes refer to it, because its bones determine its position.
    if (mesh.mNumBones > 0 && !skinned_.insert(&mesh).second) return;
    const std::size_t base = raw_mesh_.positions.size();
    if (base + mesh.mNumVertices > kMaxVertices)
      throw std::runtime_error(fmt::format("mesh \"{}\": expected at most {} vertices in all", name, kMaxVertices));

    Affine own_placing = globals_[node], placing;
    std::vector<Weights> weights = read_weights(mesh, node, own_placing, placing);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& x = mesh.mVertices[v];
      raw_mesh_.positions.push_back(placing * Vec3(x.x, x.y, x.z));
      if (!raw_mesh_.positions.back().allFinite())
        throw std::runtime_error(fmt::format("mesh \"{}\": vertex {} {}", name, v, kNotFinite));
      materials_.push_back(mesh.mMaterialIndex < scene_.mNumMaterials ? static_cast<Index>(mesh.mMaterialIndex) : -1);
      uv_.push_back(uv_of(mesh, v));
    }
    check_bind(mesh, placing, own_placing, weights, node);
    std::move(weights.begin(), weights.end(), std::back_inserter(weights_));
    read_faces(mesh, base, own_placing.linear().determinant() < 0);
    read_morphs(mesh, node, base, placing);
  }

  /// The weights of each vertex of a mesh. For a skinned mesh, sets `own_placing` to the transform from mesh to world
  /// in the rest pose: (bone's node to world) × (bone offset) of the bone with the largest sum of weights, among the
  /// bones for which this product is invertible. Sets `placing` to that of the first skinned mesh of the same node:
  /// assimp divides a mesh by its materials, and rounding errors must not separate the parts. Vertices are stored after
  /// `placing`, and bone offsets are adapted to it, so that it does not affect where the skin is in a pose.
  std::vector<Weights> read_weights(const aiMesh& mesh, Index node, Affine& own_placing, Affine& placing) {
    std::vector<Weights> weights(mesh.mNumVertices);
    std::vector<std::pair<Index, Affine>> bones;  // node and offset of each bone with weights
    double most = 0;
    for (const aiBone* bone : std::span(mesh.mBones, mesh.mNumBones)) {
      double total = 0;
      for (const aiVertexWeight& w : std::span(bone->mWeights, bone->mNumWeights))
        total += check_weight(mesh, *bone, w);
      if (total == 0) continue;
      const auto found = targets_.nodes.find(bone->mName.C_Str());
      if (found == targets_.nodes.end())
        throw std::runtime_error(fmt::format("mesh \"{}\": expected a node for each bone, got none named \"{}\"",
                                             mesh.mName.C_Str(), bone->mName.C_Str()));
      const Affine offset = to_affine(bone->mOffsetMatrix);
      if (!offset.matrix().allFinite())
        throw std::runtime_error(fmt::format("mesh \"{}\", bone \"{}\": its transform {}", mesh.mName.C_Str(),
                                             bone->mName.C_Str(), kNotFinite));
      const auto index = static_cast<Index>(bones.size());
      bones.emplace_back(found->second, offset);
      for (const aiVertexWeight& w : std::span(bone->mWeights, bone->mNumWeights))
        if (w.mWeight > 0) weights[w.mVertexId].push_back({index, w.mWeight});
      const Affine held = globals_[found->second] * offset;
      if (total > most && invertible(held)) {
        most = total;
        own_placing = held;
      }
    }
    if (!invertible(own_placing)) own_placing = Affine::Identity();
    if (most > 0 && !placing_of_skin_) placing_of_skin_ = own_placing;
    placing = most > 0 ? *placing_of_skin_ : own_placing;
    const Affine back = placing.inverse();
    std::vector<Index> numbers;
    for (const auto& [bone_node, offset] : bones) numbers.push_back(add_bone(bone_node, offset * back));
    for (Weights& of_vertex : weights)
      for (character::Influence& influence : of_vertex) influence.bone = numbers[at(influence.bone)];
    normalise_weights(mesh, node, placing, weights);
    return weights;
  }

  /// The number of a bone with this node and offset. Adds it if there is none, so that equal bones of several meshes
  /// are one.
  Index add_bone(Index node, const Affine& offset) {
    std::vector<Index>& known = bones_of_node_[node];
    const auto found = std::ranges::find_if(
        known, [&](Index bone) { return character_.bones[at(bone)].offset.matrix() == offset.matrix(); });
    if (found != known.end()) return *found;
    known.push_back(static_cast<Index>(character_.bones.size()));
    character_.bones.push_back({node, offset});
    return known.back();
  }

  double check_weight(const aiMesh& mesh, const aiBone& bone, const aiVertexWeight& weight) const {
    const auto fail = [&](const std::string& why) {
      throw std::runtime_error(
          fmt::format("mesh \"{}\", bone \"{}\": {}", mesh.mName.C_Str(), bone.mName.C_Str(), why));
    };
    if (weight.mVertexId >= mesh.mNumVertices)
      fail(fmt::format("expected one of {} vertices, got number {}", mesh.mNumVertices, weight.mVertexId));
    if (!std::isfinite(weight.mWeight) || weight.mWeight < 0)
      fail(fmt::format("expected a weight >= 0, got {:g} at vertex {}", weight.mWeight, weight.mVertexId));
    return weight.mWeight;
  }

  /// Warns if the rest pose of the nodes moves the skin away from its bind pose, for example because of pivots that
  /// assimp ignores. In FBX, the node of the mesh defines the bind pose. Other formats define only the bones relative
  /// to each other; for them, `own_placing` defines the bind pose.
  void check_bind(const aiMesh& mesh, const Affine& placing, const Affine& own_placing,
                  const std::vector<Weights>& weights, Index node) {
    if (mesh.mNumBones == 0) return;
    const std::optional<double> metres = metres_per_unit(scene_);
    const Affine& bound = metres ? globals_[node] : own_placing;
    double farthest = 0;
    unsigned worst = 0;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Vec3 x(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z);
      Vec3 held = Vec3::Zero();
      for (const character::Influence& influence : weights[v]) {
        const character::Bone& bone = character_.bones[influence.bone];
        held += influence.weight * (globals_[bone.node] * (bone.offset * (placing * x)));
      }
      const double distance = metres.value_or(1) * (held - bound * x).norm();
      if (distance > farthest) farthest = distance, worst = v;
    }
    if (farthest <= kMaxBindError) return;
    Index holder = 0;
    double most = 0;
    for (const character::Influence& influence : weights[worst])
      if (influence.weight > most) most = influence.weight, holder = character_.bones[influence.bone].node;
    read_.warnings.push_back(fmt::format(
        "mesh \"{}\": in the rest pose of the skeleton, its skin is up to {:.3g} m away from where it was "
        "bound to the bones, at node \"{}\"; if the body looks wrong, export it in its bind pose, or as glTF",
        mesh.mName.C_Str(), farthest, character_.nodes[holder].name));
  }

  /// Scales the weights of each vertex to a sum of 1. Binds vertices without weights to the node of the mesh.
  void normalise_weights(const aiMesh& mesh, Index node, const Affine& placing, std::vector<Weights>& weights) {
    std::size_t unweighted = 0;
    double worst_sum = 1;
    std::size_t worst_sum_vertex = 0;
    Index own = -1;
    for (std::size_t v = 0; v < weights.size(); ++v) {
      double sum = 0;
      for (const character::Influence& influence : weights[v]) sum += influence.weight;
      if (sum <= 0) {
        ++unweighted;
        if (own < 0) own = add_bone(node, placing.inverse());
        weights[v] = {{own, 1}};
        continue;
      }
      if (std::abs(sum - 1) > std::abs(worst_sum - 1)) {
        worst_sum = sum;
        worst_sum_vertex = v;
      }
      for (character::Influence& influence : weights[v]) influence.weight /= sum;
    }
    if (std::abs(worst_sum - 1) > kWeightSlack)
      read_.warnings.push_back(
          fmt::format("mesh \"{}\": weights of a vertex should add up to 1; they were scaled, those "
                      "of vertex {} from {:g}",
                      mesh.mName.C_Str(), worst_sum_vertex, worst_sum));
    if (unweighted > 0 && mesh.mNumBones > 0)
      read_.warnings.push_back(fmt::format("mesh \"{}\": {} of {} vertices have no bone; they go with node \"{}\"",
                                           mesh.mName.C_Str(), unweighted, weights.size(),
                                           character_.nodes[node].name));
  }

  void read_faces(const aiMesh& mesh, std::size_t base, bool mirrored) {
    std::vector<Index> corners;
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
      if (face.mNumIndices < 3) continue;
      corners.clear();
      for (const unsigned v : std::span(face.mIndices, face.mNumIndices)) {
        if (v >= mesh.mNumVertices)
          throw std::runtime_error(fmt::format("mesh \"{}\": expected one of {} vertices in each face, got number {}",
                                               mesh.mName.C_Str(), mesh.mNumVertices, v));
        corners.push_back(static_cast<Index>(base + v));
      }
      // If the transform mirrors, faces would point inward. Reverses the order of their corners.
      if (mirrored) std::reverse(corners.begin(), corners.end());
      append_face(raw_mesh_, corners);
    }
  }

  void read_morphs(const aiMesh& mesh, Index node, std::size_t base, const Affine& placing) {
    const std::string name = mesh.mName.C_Str();
    const ClipTargets::Morphs group{static_cast<Index>(morphs_.size()), static_cast<Index>(mesh.mNumAnimMeshes)};
    for (const aiAnimMesh* target : std::span(mesh.mAnimMeshes, mesh.mNumAnimMeshes)) {
      Morph morph{
          .name = target->mName.C_Str(), .weight = rest_weight(scene_, *target), .first = base, .displacements = {}};
      if (!std::isfinite(target->mWeight) || (target->HasPositions() && target->mNumVertices != mesh.mNumVertices))
        throw std::runtime_error(
            fmt::format("mesh \"{}\", morph target \"{}\": expected {} vertices and a finite weight, got {} and {:g}",
                        name, morph.name, mesh.mNumVertices, target->mNumVertices, target->mWeight));
      for (unsigned v = 0; target->HasPositions() && v < mesh.mNumVertices; ++v) {
        const aiVector3D by = target->mVertices[v] - mesh.mVertices[v];
        morph.displacements.push_back(placing.linear() * Vec3(by.x, by.y, by.z));
        if (!morph.displacements.back().allFinite())
          throw std::runtime_error(
              fmt::format("mesh \"{}\", morph target \"{}\": vertex {} {}", name, morph.name, v, kNotFinite));
      }
      morphs_.push_back(std::move(morph));
    }
    if (group.count == 0) return;
    const std::string& of_node = character_.nodes[node].name;
    targets_.morphs.emplace(of_node, group);
    if (name != of_node) targets_.morphs.emplace(name, group);
  }

  /// Merges vertices with the same position, weights and displacements. At seams of textures, normals or materials,
  /// files have several vertices for one point, which would separate the surface there. Removes vertices without faces.
  void join_vertices() {
    std::unordered_map<std::string, Index> known;
    std::vector<Index> groups;
    for (std::size_t v = 0; v < raw_mesh_.positions.size(); ++v)
      groups.push_back(known.emplace(key_of(v), static_cast<Index>(known.size())).first->second);
    const std::vector<Index> kept = join_groups(raw_mesh_, groups);
    std::vector<Vec3> positions;
    for (const Index old : kept) {
      positions.push_back(raw_mesh_.positions[old]);
      character_.material_of_vertex.push_back(materials_[old]);
      character_.first_influence.push_back(static_cast<Index>(character_.influences.size()));
      character_.influences.insert(character_.influences.end(), weights_[old].begin(), weights_[old].end());
    }
    character_.first_influence.push_back(static_cast<Index>(character_.influences.size()));
    for (Morph& morph : morphs_) {
      std::vector<Vec3> displacements;
      for (const Index v : kept) displacements.push_back(morph.at(at(v)));
      character_.morphs.push_back({std::move(morph.name), std::move(displacements), morph.weight});
    }
    raw_mesh_.positions = std::move(positions);
  }

  /// All data that determine the position of a vertex over time, as bytes.
  std::string key_of(std::size_t v) const {
    std::string key;
    const auto append_number = [&](double number) {
      number += 0.0;  // 0 and -0 are equal
      key.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    for (const double x : raw_mesh_.positions[v]) append_number(x);
    for (const character::Influence& influence : weights_[v]) {
      append_number(influence.bone);
      append_number(influence.weight);
    }
    for (const Morph& morph : morphs_)
      for (const double x : morph.at(v)) append_number(x);
    return key;
  }

  void make_faces() {
    std::size_t flat = 0;
    character_.mesh.topology = make_topology(raw_mesh_, flat);
    character_.mesh.positions = std::move(raw_mesh_.positions);
    if (flat > 0)
      read_.warnings.push_back(fmt::format("{} triangle{} without area left out", flat, flat == 1 ? "" : "s"));
  }

  Vec2 uv_of(const aiMesh& mesh, unsigned v) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials) return Vec2::Zero();
    unsigned channel = uv_channel(*scene_.mMaterials[mesh.mMaterialIndex]);
    if (mesh.mTextureCoords[channel] == nullptr) channel = 0;
    if (mesh.mTextureCoords[channel] == nullptr) return Vec2::Zero();
    const Vec2 uv(mesh.mTextureCoords[channel][v].x, mesh.mTextureCoords[channel][v].y);
    // The result may be infinite, because the texture transform of a file may be.
    const Vec2 placed = placed_uv(*scene_.mMaterials[mesh.mMaterialIndex], uv);
    return placed.allFinite() ? placed : Vec2(Vec2::Zero());
  }

  /// Copies materials and texture coordinates of each triangle. `unjoined`: the raw mesh before its vertices were
  /// merged, with the same list of triangles.
  void color_faces(const RawMesh& unjoined) {
    if (file_.empty() || scene_.mNumMaterials == 0 || std::ranges::find(materials_, -1) != materials_.end()) return;
    character::Coloring& coloring = character_.coloring;
    coloring.materials = read_materials(scene_, file_, read_.warnings);
    std::size_t flat = 0;
    for (const mesh::Triangle& t : make_topology(unjoined, flat).triangles) {
      coloring.material_of_triangle.push_back(materials_[t[0]]);
      coloring.uv.push_back({uv_[t[0]], uv_[t[1]], uv_[t[2]]});
    }
    if (coloring.uv.size() != character_.mesh.topology.triangles.size()) coloring = {};
  }

  /// Gives each clip without a name its number, from 1, as its name.
  void name_clips() {
    for (std::size_t c = 0; c < character_.clips.size(); ++c)
      if (character_.clips[c].name.empty()) character_.clips[c].name = std::to_string(c + 1);
  }

  /// A morph target of one mesh.
  struct Morph {
    std::string name;
    double weight = 0;
    std::size_t first = 0;  // index of the first vertex of the mesh in the raw mesh
    std::vector<Vec3> displacements;

    Vec3 at(std::size_t v) const {
      return v >= first && v - first < displacements.size() ? displacements[v - first] : Vec3(Vec3::Zero());
    }
  };

  const aiScene& scene_;
  const std::filesystem::path& file_;
  const MeshChoice& choice_;
  ReadCharacter read_;
  character::Character& character_ = read_.character;
  std::vector<const aiNode*> nodes_;
  std::vector<Affine> globals_;  // per node: transform to world in the rest pose
  RawMesh raw_mesh_;
  std::vector<Weights> weights_;  // per vertex of the raw mesh
  std::vector<Index> materials_;  // per vertex of the raw mesh; −1: no material
  std::vector<Vec2> uv_;          // per vertex of the raw mesh
  std::vector<Morph> morphs_;
  std::set<const aiMesh*> skinned_;        // skinned meshes that have been read
  std::optional<Affine> placing_of_skin_;  // of the skinned meshes of the node whose meshes are being read
  std::map<Index, std::vector<Index>> bones_of_node_;
  ClipTargets targets_;
};

}  // namespace

ReadCharacter to_character(const aiScene& scene, const std::filesystem::path& file, const MeshChoice& choice) {
  return CharacterReader(scene, file, choice).read();
}

}  // namespace weft::assets
