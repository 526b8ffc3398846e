// Real character files from the Debian package assimp-testmodels.
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "film/assets/character_file.hpp"
#include "film/character/pose.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::assets {
namespace {

namespace fs = std::filesystem;
using character::Character;

const fs::path kModels = "/usr/share/assimp/models";

/// Number of poses of a clip that are compared.
constexpr int kPoses = 10;

class Packaged : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kModels)) GTEST_SKIP() << "apt-get install assimp-testmodels";
  }
};

std::vector<fs::path> all_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kModels))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void expect_sound(const Character& body, const std::string& name) {
  const auto report = mesh::inspect(body.mesh.topology.triangles, body.mesh.positions.size());
  EXPECT_TRUE(report.out_of_range.empty() && report.degenerate.empty()) << name;
  ASSERT_EQ(body.first_influence.size(), body.mesh.positions.size() + 1) << name;
  for (std::size_t v = 0; v < body.mesh.positions.size(); ++v) {
    double sum = 0;
    for (Index i = body.first_influence[v]; i < body.first_influence[v + 1]; ++i) {
      ASSERT_LT(static_cast<std::size_t>(body.influences[i].bone), body.bones.size()) << name;
      sum += body.influences[i].weight;
    }
    ASSERT_NEAR(sum, 1, 1e-12) << name << " vertex " << v;
  }
  for (std::size_t n = 0; n < body.nodes.size(); ++n) ASSERT_LT(body.nodes[n].parent, static_cast<Index>(n)) << name;
  // The positions of the first pose of the first clip are finite.
  std::vector<Vec3> x(body.mesh.positions.size());
  skin(body, body.clips.empty() ? rest_pose(body) : pose_at(body, body.clips[0], 0), x);
  EXPECT_TRUE(std::all_of(x.begin(), x.end(), [](const Vec3& at) { return at.allFinite(); })) << name;
}

TEST_F(Packaged, FilesAreEachLoadedOrRefusedByName) {
  int loaded = 0, refused = 0, animated = 0, skinned = 0;
  std::ofstream list;
  if (const char* file = std::getenv("WEFT_CHARACTER_LIST")) list.open(file);
  for (const fs::path& file : all_files()) {
    try {
      const LoadedCharacter got = load_character(file, {}, "scene");
      expect_sound(got.character, file.string());
      ++loaded;
      animated += got.character.clips.empty() ? 0 : 1;
      skinned += std::any_of(got.character.first_influence.begin(), got.character.first_influence.end(),
                             [&, v = Index{0}](Index first) mutable { return first != v++; })
                     ? 1
                     : 0;
      list << "loaded\t" << file.string() << '\t' << got.character.mesh.positions.size() << '\t'
           << got.character.bones.size() << '\t' << got.character.clips.size() << '\n';
      for (const std::string& warning : got.warnings) list << "warned\t" << warning << '\n';
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(error.code(), ExitCode::asset_unreadable) << error.what();
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
      list << "refused\t" << error.what() << '\n';
    }
  }
  RecordProperty("loaded", loaded);
  RecordProperty("refused", refused);
  // Lower limits for version 5.2.5~ds0-1 of the package; other versions may have other files.
  EXPECT_GE(loaded, 300);
  EXPECT_GE(animated, 50);
  EXPECT_GE(skinned, 6) << "with vertices that several bones hold";
}

/// An independent evaluation of assimp's scene: it visits nodes recursively, and each vertex of each mesh separately.
struct Evaluation {
  const aiScene& scene;
  const aiAnimation& clip;
  double ticks;

  template <class Key>
  static std::size_t key_before(const Key* keys, unsigned count, double t) {
    std::size_t k = 0;
    while (k + 1 < count && keys[k + 1].mTime <= t) ++k;
    return k;
  }
  template <class Key>
  static double key_fraction(const Key* keys, std::size_t k, double t) {
    return std::clamp((t - keys[k].mTime) / (keys[k + 1].mTime - keys[k].mTime), 0.0, 1.0);
  }
  Vec3 vector_at(const aiVectorKey* keys, unsigned count) const {
    const std::size_t k = key_before(keys, count, ticks);
    const auto value = [&](std::size_t i) { return Vec3(keys[i].mValue.x, keys[i].mValue.y, keys[i].mValue.z); };
    if (k + 1 >= count) return value(k);
    const double f = key_fraction(keys, k, ticks);
    return (1 - f) * value(k) + f * value(k + 1);
  }
  /// Rotation as a matrix, by spherical interpolation between two keys.
  Mat3 rotation_at(const aiQuatKey* keys, unsigned count) const {
    const std::size_t k = key_before(keys, count, ticks);
    const auto value = [&](std::size_t i) {
      const aiQuaternion& q = keys[i].mValue;
      return Eigen::Vector4d(q.w, q.x, q.y, q.z).normalized();
    };
    Eigen::Vector4d q = value(k);
    if (k + 1 < count) {
      Eigen::Vector4d next = value(k + 1);
      if (q.dot(next) < 0) next = -next;
      const double f = key_fraction(keys, k, ticks), angle = std::atan2((next - q).norm(), (next + q).norm()) * 2;
      q = angle < 1e-9
              ? q
              : Eigen::Vector4d((std::sin((1 - f) * angle) * q + std::sin(f * angle) * next) / std::sin(angle));
    }
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    Mat3 m;
    m << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
        1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
    return m;
  }
  static Eigen::Matrix4d to_matrix(const aiMatrix4x4& m) {
    Eigen::Matrix4d result;
    for (unsigned r = 0; r < 4; ++r)
      for (unsigned c = 0; c < 4; ++c) result(r, c) = static_cast<double>(m[r][c]);
    return result;
  }
  Eigen::Matrix4d local(const aiNode& node) const {
    for (unsigned c = 0; c < clip.mNumChannels; ++c) {
      const aiNodeAnim& channel = *clip.mChannels[c];
      // If several nodes have the same name, a channel moves the first of them.
      if (scene.mRootNode->FindNode(channel.mNodeName) != &node) continue;
      Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
      m.topLeftCorner<3, 3>() = rotation_at(channel.mRotationKeys, channel.mNumRotationKeys) *
                                vector_at(channel.mScalingKeys, channel.mNumScalingKeys).asDiagonal();
      m.topRightCorner<3, 1>() = vector_at(channel.mPositionKeys, channel.mNumPositionKeys);
      return m;
    }
    return to_matrix(node.mTransformation);
  }
  Eigen::Matrix4d global(const aiNode& node) const {
    return node.mParent == nullptr ? local(node) : Eigen::Matrix4d(global(*node.mParent) * local(node));
  }

  /// Positions of all vertices that faces use, mesh by mesh.
  std::vector<Vec3> vertices() const {
    std::vector<Vec3> all;
    std::set<unsigned> skinned;
    std::function<void(const aiNode&)> walk = [&](const aiNode& node) {
      for (unsigned k = 0; k < node.mNumMeshes; ++k) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[k]];
        if (mesh.mNumBones > 0 && !skinned.insert(node.mMeshes[k]).second) continue;
        append(node, mesh, all);
      }
      for (unsigned c = 0; c < node.mNumChildren; ++c) walk(*node.mChildren[c]);
    };
    walk(*scene.mRootNode);
    return all;
  }
  void append(const aiNode& node, const aiMesh& mesh, std::vector<Vec3>& all) const {
    std::vector<Eigen::Vector4d> x(mesh.mNumVertices, Eigen::Vector4d::Zero());
    std::vector<double> sum(mesh.mNumVertices, 0.0);
    const auto add = [&](unsigned v, double weight, const Eigen::Matrix4d& m) {
      const aiVector3D& at = mesh.mVertices[v];
      x[v] += weight * (m * Eigen::Vector4d(at.x, at.y, at.z, 1));
      sum[v] += weight;
    };
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const aiNode* held_by = scene.mRootNode->FindNode(bone.mName);
      if (held_by == nullptr) continue;
      const Eigen::Matrix4d m = global(*held_by) * to_matrix(bone.mOffsetMatrix);
      for (unsigned w = 0; w < bone.mNumWeights; ++w) add(bone.mWeights[w].mVertexId, bone.mWeights[w].mWeight, m);
    }
    std::set<unsigned> named;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      if (mesh.mFaces[f].mNumIndices >= 3)
        named.insert(mesh.mFaces[f].mIndices, mesh.mFaces[f].mIndices + mesh.mFaces[f].mNumIndices);
    for (const unsigned v : named) {
      if (sum[v] == 0) add(v, 1, global(node));
      all.push_back(x[v].head<3>() / sum[v]);
    }
  }
};

/// For each vertex of `from`, the distance to the closest vertex of `to`, taken as the largest distance over all poses.
/// Returns the maximum over all vertices.
double max_distance(const std::vector<std::vector<Vec3>>& from, const std::vector<std::vector<Vec3>>& to) {
  // Vertices of `to` by their x in the first pose, so that only nearby vertices are compared.
  std::multimap<double, std::size_t> along_x;
  for (std::size_t v = 0; v < to[0].size(); ++v) along_x.emplace(to[0][v].x(), v);
  constexpr double kNear = 1e-3;
  double worst = 0;
  for (std::size_t v = 0; v < from[0].size(); ++v) {
    double best = kNear;
    for (auto at = along_x.lower_bound(from[0][v].x() - kNear);
         at != along_x.end() && at->first < from[0][v].x() + kNear; ++at) {
      double distance = 0;
      for (std::size_t k = 0; k < from.size() && distance < best; ++k)
        distance = std::max(distance, (from[k][v] - to[k][at->second]).norm());
      best = std::min(best, distance);
    }
    worst = std::max(worst, best);
  }
  return worst;
}

/// Parameter: a file, relative to kModels.
class Skinned : public testing::TestWithParam<const char*> {};

TEST_P(Skinned, FollowsAnEvaluationOfItsOwnOverTheWholeClip) {
  const fs::path file = kModels / GetParam();
  if (!fs::exists(file)) GTEST_SKIP() << "apt-get install assimp-testmodels";
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_NE(scene, nullptr);
  ASSERT_GT(scene->mNumAnimations, 0u);
  const Character unscaled = load_character(file, {1, scene::FileUp::y, scene::UpAxis::y}, "test").character;
  Box3 box;
  for (const Vec3& x : unscaled.mesh.positions) box.extend(x);
  const double scale = 1.8 / box.sizes().maxCoeff();  // the longest side of the body is 1.8 m
  const Character body = load_character(file, {scale, scene::FileUp::y, scene::UpAxis::y}, "test").character;
  for (unsigned a = 0; a < scene->mNumAnimations; ++a) {
    const aiAnimation& clip = *scene->mAnimations[a];
    const double ticks_per_second = clip.mTicksPerSecond > 0 ? clip.mTicksPerSecond : 25;
    std::vector<std::vector<Vec3>> ours, theirs;
    for (int k = 0; k < kPoses; ++k) {
      const double t = body.clips[a].duration * k / (kPoses - 1);
      ours.emplace_back(body.mesh.positions.size());
      skin(body, pose_at(body, body.clips[a], t), ours.back());
      theirs.push_back(Evaluation{*scene, clip, t * ticks_per_second}.vertices());
      for (Vec3& x : theirs.back()) x *= scale;
    }
    EXPECT_LT(max_distance(theirs, ours), 1e-5) << clip.mName.C_Str();
    EXPECT_LT(max_distance(ours, theirs), 1e-5) << clip.mName.C_Str();
    std::printf("%s, %s: %.2g m\n", GetParam(), clip.mName.C_Str(),
                std::max(max_distance(theirs, ours), max_distance(ours, theirs)));
  }
}

INSTANTIATE_TEST_SUITE_P(Packaged, Skinned,
                         testing::Values("X/BCN_Epileptic.X", "X/Testwuson.X", "FBX/animation_with_skeleton.fbx",
                                         "FBX/huesitos.fbx", "glTF2/simple_skin/simple_skin.gltf", "BVH/01_01.bvh",
                                         "ASE/MotionCaptureROM.ase", "MDL/MDL (HL1)/man.mdl", "SMD/WusonSMD.smd",
                                         "CSM/ThomasFechten.csm", "Collada/box_nested_animation.dae"),
                         [](const auto& file) {
                           std::string name = file.param;
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace weft::assets
