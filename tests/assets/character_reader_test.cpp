// Scenes as assimp returns them, made by hand. Most tests change or damage one part.
#include "film/assets/character_reader.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "assets/small_files.hpp"
#include "film/assets/character_file.hpp"
#include "film/character/pose.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Two triangles skinned to two joints, and a mesh without bones at two nodes. aiScene owns and deletes everything.
class Scenes : public support::TestFolder {
 protected:
  Scenes() {
    root_->mChildren = new aiNode* [3] { hip_, knee_, box_node_ };
    root_->mNumChildren = 3;
    for (aiNode* child : {hip_, knee_, box_node_}) child->mParent = root_;
    knee_->mTransformation.a4 = 1;      // at (1, 0, 0)
    box_node_->mTransformation.b4 = 5;  // at (0, 5, 0)
    scene_.mRootNode = root_;

    leg_->mName = "leg";
    set_vertices(*leg_, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}});
    set_faces(*leg_, {{0, 1, 2}, {1, 3, 2}});
    leg_->mNumBones = 2;
    leg_->mBones = new aiBone* [2] { bone("hip", {{0, 1}, {1, 0.5F}, {2, 1}}), bone("knee", {{1, 0.5F}, {3, 1}}) };
    leg_->mBones[1]->mOffsetMatrix.a4 = -1;
    box_->mName = "box";
    set_vertices(*box_, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    set_faces(*box_, {{0, 1, 2}});
    scene_.mMeshes = new aiMesh* [2] { leg_, box_ };
    scene_.mNumMeshes = 2;
    show(*root_, {0, 1});
    show(*box_node_, {1});

    clip_->mName = "walk";
    clip_->mDuration = 20;
    clip_->mTicksPerSecond = 10;
    clip_->mChannels = new aiNodeAnim* [1] { channel_ };
    clip_->mNumChannels = 1;
    channel_->mNodeName = "knee";
    channel_->mPositionKeys = new aiVectorKey[2]{{0, {1, 0, 0}}, {20, {1, 0, 3}}};
    channel_->mNumPositionKeys = 2;
    scene_.mAnimations = new aiAnimation* [1] { clip_ };
    scene_.mNumAnimations = 1;
  }

  static aiNode* node(const char* name) { return new aiNode(name); }
  static aiBone* bone(const char* name, std::initializer_list<aiVertexWeight> weights) {
    auto* bone = new aiBone;
    bone->mName = name;
    bone->mNumWeights = static_cast<unsigned>(weights.size());
    bone->mWeights = new aiVertexWeight[weights.size()];
    std::copy(weights.begin(), weights.end(), bone->mWeights);
    return bone;
  }
  static void set_vertices(aiMesh& mesh, std::initializer_list<aiVector3D> vertices) {
    mesh.mNumVertices = static_cast<unsigned>(vertices.size());
    mesh.mVertices = new aiVector3D[vertices.size()];
    std::copy(vertices.begin(), vertices.end(), mesh.mVertices);
  }
  static void set_faces(aiMesh& mesh, std::initializer_list<std::initializer_list<unsigned>> faces) {
    mesh.mNumFaces = static_cast<unsigned>(faces.size());
    mesh.mFaces = new aiFace[faces.size()];
    aiFace* face = mesh.mFaces;
    for (const auto& corners : faces) {
      face->mNumIndices = static_cast<unsigned>(corners.size());
      face->mIndices = new unsigned[corners.size()];
      std::copy(corners.begin(), corners.end(), face->mIndices);
      ++face;
    }
  }
  static void show(aiNode& at, std::initializer_list<unsigned> meshes) {
    at.mNumMeshes = static_cast<unsigned>(meshes.size());
    at.mMeshes = new unsigned[meshes.size()];
    std::copy(meshes.begin(), meshes.end(), at.mMeshes);
  }

  /// Converts to bytes and back, as when the data pass from one process to another.
  ReadCharacter read() {
    ReadCharacter read = to_character(scene_, {});
    return character_from_bytes(to_bytes(read));
  }
  std::string refusal() {
    try {
      static_cast<void>(read());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "taken";
  }
  std::string warning() {
    const auto warnings = read().warnings;
    EXPECT_EQ(warnings.size(), 1u);
    return warnings.empty() ? "" : warnings.front();
  }

  aiScene scene_;
  aiNode *root_ = node("root"), *hip_ = node("hip"), *knee_ = node("knee"), *box_node_ = node("crate");
  aiMesh *leg_ = new aiMesh, *box_ = new aiMesh;
  aiAnimation* clip_ = new aiAnimation;
  aiNodeAnim* channel_ = new aiNodeAnim;
};

TEST_F(Scenes, BecomeNodesBonesOneMeshAndClips) {
  const ReadCharacter got = read();
  const character::Character& body = got.character;
  EXPECT_TRUE(got.warnings.empty());
  ASSERT_EQ(body.nodes.size(), 4u);
  EXPECT_EQ(body.nodes[2].name, "knee");
  EXPECT_EQ(body.nodes[2].parent, 0);
  // The leg, and the mesh without bones once for each of its two nodes: 4 + 3 + 3 vertices, each with its weights.
  EXPECT_EQ(body.mesh.positions.size(), 10u);
  EXPECT_EQ(body.mesh.topology.triangles.size(), 4u);
  EXPECT_EQ(body.bones.size(), 4u);
  ASSERT_EQ(body.clips.size(), 1u);
  EXPECT_EQ(body.clips[0].duration, 2);
  EXPECT_EQ(body.clips[0].channels[0].position.times, (std::vector<double>{0, 2}));
  // In the middle of the clip, the knee is 1.5 m above its position at rest. It moves vertex 1 with weight 1/2 and
  // vertex 3 with weight 1.
  std::vector<Vec3> x(10);
  character::skin(body, character::pose_at(body, body.clips[0], 1), x);
  EXPECT_EQ(x[1], Vec3(1, 0, 0.75));
  EXPECT_EQ(x[3], Vec3(2, 0, 1.5));
  EXPECT_EQ(x[2], Vec3(0, 1, 0));
  EXPECT_NE(std::find(x.begin(), x.end(), Vec3(0, 6, 0)), x.end()) << "the copy at the crate";
}

TEST_F(Scenes, HaveTheMeshesThatAreChosen) {
  const auto vertices = [&](const MeshChoice& choice) {
    return to_character(scene_, {}, choice).character.mesh.positions.size();
  };
  EXPECT_EQ(vertices({}), 10u);
  EXPECT_EQ(vertices({.only = {"leg"}, .without = {}, .elsewhere = {}}), 4u);
  EXPECT_EQ(vertices({.only = {"crate"}, .without = {}, .elsewhere = {}}), 3u) << "by the node";
  EXPECT_EQ(vertices({.only = {}, .without = {"box"}, .elsewhere = {}}), 4u);
  EXPECT_EQ(vertices({.only = {}, .without = {}, .elsewhere = {"box", "nothing of this name"}}), 4u);
  for (const MeshChoice& choice : {MeshChoice{{"legs"}, {}, {}}, MeshChoice{{}, {"legs"}, {}}}) try {
      vertices(choice);
      ADD_FAILURE() << "taken";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what())
                    .find("expected names of meshes or of their nodes, such as \"box\", "
                          "\"crate\", \"leg\", \"root\", got \"legs\""),
                std::string::npos)
          << error.what();
    }
}

// The knee was turned by 180 degrees about the origin after binding: vertex 3 moves from (2, 0, 0) to (0, 0, 0).
TEST_F(Scenes, WhoseRestPoseIsNotThatInWhichTheSkinWasBoundAreWarnedAbout) {
  knee_->mTransformation.a1 = knee_->mTransformation.b2 = -1;
  EXPECT_EQ(warning(),
            "mesh \"leg\": in the rest pose of the skeleton, its skin is up to 2 m away from where it was bound to the "
            "bones, at node \"knee\"; if the body looks wrong, export it in its bind pose, or as glTF");
}

// An FBX mesh is bound at its node. In other files, a mesh with one bone is consistent with any pose.
TEST_F(Scenes, OfFbxAreComparedWithTheirNodes) {
  leg_->mBones[1]->mWeights[0].mWeight = leg_->mBones[1]->mWeights[1].mWeight = 0;
  hip_->mTransformation.c4 = 25;
  leg_->mBones[0]->mWeights[1].mWeight = 1;
  scene_.mMetaData = aiMetadata::Alloc(1);
  scene_.mMetaData->Set(0, "UnitScaleFactor", 1.0F);
  const std::vector<std::string> warnings = read().warnings;
  EXPECT_TRUE(std::ranges::any_of(warnings, [](const std::string& text) {
    return text.find("its skin is up to 0.25 m away from where it was bound to the bones, at node \"hip\"") !=
           std::string::npos;
  })) << (warnings.empty() ? "none" : warnings.front());
}

TEST_F(Scenes, WithABindPoseElsewhereStandWhereTheirMostImportantBoneHoldsThem) {
  hip_->mTransformation.c4 = 7;
  const character::Character body = read().character;
  EXPECT_EQ(body.mesh.positions[0], Vec3(0, 0, 7));
  std::vector<Vec3> x(body.mesh.positions.size());
  character::skin(body, character::rest_pose(body), x);
  EXPECT_EQ(x[0], Vec3(0, 0, 7));
  EXPECT_EQ(x[3], Vec3(2, 0, 0)) << "held by the knee alone, which has not moved";
}

// In FBX and glTF, the node of a mesh can have the name of a bone. assimp refers to bones and channels by the names of
// nodes, so such names are ambiguous.
TEST_F(Scenes, WithMeshesThatHaveTheNameOfABoneAreHeldByTheBone) {
  box_node_->mName = "knee";
  std::swap(root_->mChildren[1], root_->mChildren[2]);
  const ReadCharacter got = read();
  EXPECT_TRUE(got.warnings.empty()) << got.warnings.front();
  std::vector<Vec3> x(got.character.mesh.positions.size());
  character::skin(got.character, character::pose_at(got.character, got.character.clips[0], 1), x);
  EXPECT_EQ(x[3], Vec3(2, 0, 1.5));
}

TEST_F(Scenes, WithSeamsAreJoinedWhereCopiesMoveTogether) {
  // A third triangle uses copies of vertices 1 and 2; the copy of 2 has other weights.
  delete[] leg_->mVertices;
  set_vertices(*leg_, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {1, 0, -0.0F}, {0, 1, 0}, {3, 3, 0}});
  delete[] leg_->mFaces;
  set_faces(*leg_, {{0, 1, 2}, {1, 3, 2}, {4, 6, 5}});
  delete leg_->mBones[0];
  delete leg_->mBones[1];
  leg_->mBones[0] = bone("hip", {{0, 1}, {1, 0.5F}, {2, 1}, {4, 0.5F}, {6, 1}});
  leg_->mBones[1] = bone("knee", {{1, 0.5F}, {3, 1}, {4, 0.5F}, {5, 1}});
  EXPECT_EQ(read().character.mesh.positions.size(), 6u + 6u);
}

TEST_F(Scenes, WithWeightsThatNearlySumAreScaledSilentlyAndOthersWithAWarning) {
  leg_->mBones[0]->mWeights[0].mWeight = 0.99F;
  EXPECT_TRUE(read().warnings.empty());
  leg_->mBones[0]->mWeights[0].mWeight = 0.25F;
  EXPECT_EQ(warning(),
            "mesh \"leg\": weights of a vertex should add up to 1; they were scaled, those of vertex 0 from 0.25");
  EXPECT_EQ(read().character.influences[0].weight, 1);
}

TEST_F(Scenes, WithVerticesWithoutABoneHangThemOnTheNodeOfTheMesh) {
  leg_->mBones[0]->mWeights[0].mWeight = 0;
  EXPECT_EQ(warning(), "mesh \"leg\": 1 of 4 vertices have no bone; they go with node \"root\"");
}

TEST_F(Scenes, WithPartsThatCannotBeUsedAreRefusedByTheirNames) {
  leg_->mBones[1]->mName = "ankle";
  EXPECT_EQ(refusal(), "mesh \"leg\": expected a node for each bone, got none named \"ankle\"");
  leg_->mBones[1]->mName = "knee";
  leg_->mBones[1]->mWeights[0].mWeight = kNan;
  EXPECT_EQ(refusal(), "mesh \"leg\", bone \"knee\": expected a weight >= 0, got nan at vertex 1");
  leg_->mBones[1]->mWeights[0] = {9, 0.5F};
  EXPECT_EQ(refusal(), "mesh \"leg\", bone \"knee\": expected one of 4 vertices, got number 9");
  leg_->mBones[1]->mWeights[0] = {1, 0.5F};
  leg_->mVertices[2].y = kNan;
  EXPECT_EQ(refusal(), "mesh \"leg\": vertex 2 has infinite or undefined numbers; export the file again");
  leg_->mVertices[2].y = 1;
  box_->mFaces[0].mIndices[1] = 3;
  EXPECT_EQ(refusal(), "mesh \"box\": expected one of 3 vertices in each face, got number 3");
  box_->mFaces[0].mIndices[1] = 1;
  hip_->mTransformation.b2 = kNan;
  EXPECT_EQ(refusal(), "node \"hip\": its transform has infinite or undefined numbers; export the file again");
  hip_->mTransformation.b2 = 1;
  root_->mMeshes[1] = 2;
  EXPECT_EQ(refusal(), "node \"root\": expected one of 2 meshes, got number 2");
  root_->mMeshes[1] = 1;
  EXPECT_EQ(refusal(), "taken");
}

TEST_F(Scenes, WithChannelsThatCannotBeUsedAreRefusedByTheirNames) {
  channel_->mPositionKeys[1].mTime = -1;
  EXPECT_EQ(refusal(), "clip \"walk\", channel \"knee\": expected key times that increase, got -0.1 s after 0 s");
  channel_->mPositionKeys[1].mTime = kNan;
  EXPECT_EQ(refusal(),
            "clip \"walk\", channel \"knee\": expected key times within a day, got nan ticks of 10 a second");
  channel_->mPositionKeys[1] = {20, {1, kNan, 0}};
  EXPECT_EQ(refusal(),
            "clip \"walk\", channel \"knee\": the key at 2 s has infinite or undefined numbers; export the file again");
}

TEST_F(Scenes, WithKeysPastTheEndOrForNoNodeAreTakenWithAWarning) {
  channel_->mPositionKeys[1].mTime = 25;
  EXPECT_EQ(
      warning(),
      "clip \"walk\", channel \"knee\": its last key, at 2.5 s, is past the end at 2 s; the clip is taken to be that "
      "long");
  EXPECT_EQ(read().character.clips[0].duration, 2.5);
  channel_->mPositionKeys[1].mTime = 20;
  for (const double rate : {std::numeric_limits<double>::infinity(), -25.0}) {
    clip_->mTicksPerSecond = rate;
    EXPECT_EQ(warning(),
              fmt::format("clip \"walk\": expected a time > 0 s for each frame, got {:g} s; 25 frames a second "
                          "are assumed",
                          1 / rate));
  }
  clip_->mTicksPerSecond = 0;  // 0: the file does not state it
  EXPECT_TRUE(read().warnings.empty());
  channel_->mNodeName = "tail";
  EXPECT_EQ(warning(), "clip \"walk\": 1 channel left out, which name no part of the file: \"tail\"");
}

// If an FBX file stores the transform of a node in parts, assimp makes a chain of nodes, and gives the last one the
// name in the file. The clip of this test animates this last node with the whole transform.
TEST_F(Scenes, OfFbxWithTransformsInPartsPlayClipsThatHaveThemWhole) {
  auto* helper = node("knee_$AssimpFbx$_Translation");
  helper->mTransformation.a4 = 7;
  helper->mChildren = new aiNode* [1] { knee_ };
  helper->mNumChildren = 1;
  root_->mChildren[1] = helper;
  helper->mParent = root_;
  knee_->mParent = helper;
  knee_->mTransformation = aiMatrix4x4();
  leg_->mBones[1]->mOffsetMatrix.a4 = -7;
  const auto place_of_knee = [&] {
    const character::Character body = read().character;
    const auto at = character::global_transforms(body, character::pose_at(body, body.clips[0], 0));
    for (std::size_t n = 0; n < body.nodes.size(); ++n)
      if (body.nodes[n].name == "knee") return Vec3(at[n].translation());
    return Vec3(Vec3::Zero());
  };
  EXPECT_EQ(place_of_knee(), Vec3(8, 0, 0)) << "a way alone does not tell";
  channel_->mRotationKeys = new aiQuatKey[1]{{0, aiQuaternion()}};
  channel_->mNumRotationKeys = 1;
  EXPECT_EQ(place_of_knee(), Vec3(1, 0, 0));
  EXPECT_TRUE(read().warnings.empty());
}

// Assimp 5.2 stores the unit as a float, other versions as a double.
TEST_F(Scenes, OfFbxSayTheirUnit) {
  EXPECT_FALSE(read().metres_per_unit);
  scene_.mMetaData = new aiMetadata;
  scene_.mMetaData->Add("UnitScaleFactor", 2.5F);
  EXPECT_EQ(read().metres_per_unit, 0.025);
  scene_.mMetaData->mValues[0].mType = AI_DOUBLE;
  delete static_cast<float*>(scene_.mMetaData->mValues[0].mData);
  scene_.mMetaData->mValues[0].mData = new double(100);
  EXPECT_EQ(read().metres_per_unit, 1);
}

TEST_F(Scenes, WithMorphTargetsAreBlendedByTheirChannels) {
  auto* target = new aiAnimMesh;
  target->mName = "swell";
  target->mWeight = 0;
  target->mNumVertices = 3;
  target->mVertices = new aiVector3D[3]{{0, 0, 2}, {1, 0, 0}, {0, 1, 0}};
  box_->mAnimMeshes = new aiAnimMesh* [1] { target };
  box_->mNumAnimMeshes = 1;
  auto* channel = new aiMeshMorphAnim;
  channel->mName = "box*0";
  channel->mKeys = new aiMeshMorphKey[2];
  channel->mNumKeys = 2;
  for (unsigned k = 0; k < 2; ++k) {
    channel->mKeys[k].mTime = 20.0 * k;
    channel->mKeys[k].mNumValuesAndWeights = 1;
    channel->mKeys[k].mValues = new unsigned[1]{0};
    channel->mKeys[k].mWeights = new double[1]{1.0 * k};
  }
  clip_->mMorphMeshChannels = new aiMeshMorphAnim* [1] { channel };
  clip_->mNumMorphMeshChannels = 1;
  const character::Character body = read().character;
  std::vector<Vec3> x(body.mesh.positions.size());
  character::skin(body, character::pose_at(body, body.clips[0], 0.5), x);
  EXPECT_NE(std::find(x.begin(), x.end(), Vec3(0, 0, 0.5)), x.end()) << "at the root";
  EXPECT_NE(std::find(x.begin(), x.end(), Vec3(0, 5, 0.5)), x.end()) << "at the crate";
  EXPECT_TRUE(to_character(scene_, {}, {.only = {}, .without = {"box"}, .elsewhere = {}}).warnings.empty());
  // assimp 5.2 sets the weights of FBX targets to 1.
  target->mWeight = 1;
  EXPECT_EQ(read().character.morphs.at(0).weight, 1);
  scene_.mMetaData = aiMetadata::Alloc(1);
  scene_.mMetaData->Set(0, "UnitScaleFactor", 1.0F);
  EXPECT_EQ(read().character.morphs.at(0).weight, 0);
  channel->mKeys[1].mValues[0] = 1;
  EXPECT_EQ(refusal(), "clip \"walk\", channel \"box*0\": expected one of 1 morph targets, got number 1");
}

TEST_F(Scenes, ColorsAndPicturesComeWithTheirPlacesForEachTriangle) {
  const std::string png = "\x89PNG\r\n\x1a\nand so on";
  auto* picture = new aiTexture;
  picture->mHeight = 0;
  picture->mWidth = static_cast<unsigned>(png.size());
  picture->pcData = new aiTexel[png.size()];
  std::copy(png.begin(), png.end(), reinterpret_cast<char*>(picture->pcData));
  scene_.mTextures = new aiTexture* [1] { picture };
  scene_.mNumTextures = 1;
  auto *plain = new aiMaterial, *pictured = new aiMaterial;
  const aiColor4D red(1, 0.25F, 0, 1);
  plain->AddProperty(&red, 1, AI_MATKEY_BASE_COLOR);
  const aiString inside("*0"), mask("MASK");
  pictured->AddProperty(&inside, AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0));
  pictured->AddProperty(&mask, AI_MATKEY_GLTF_ALPHAMODE);
  const int mirror = aiTextureMapMode_Mirror;
  pictured->AddProperty(&mirror, 1, AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0));
  scene_.mMaterials = new aiMaterial* [2] { plain, pictured };
  scene_.mNumMaterials = 2;
  leg_->mMaterialIndex = 0;
  box_->mMaterialIndex = 1;
  box_->mTextureCoords[0] = new aiVector3D[3]{{0.25F, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  box_->mNumUVComponents[0] = 2;

  ReadCharacter got = to_character(scene_, "body.glb");
  const character::Coloring coloring = character_from_bytes(to_bytes(got)).character.coloring;
  ASSERT_EQ(coloring.materials.size(), 2u);
  EXPECT_EQ(coloring.materials[0].color, Vec3(1, 0.25, 0));
  EXPECT_EQ(coloring.materials[0].picture, "");
  EXPECT_EQ(coloring.materials[1].picture, png);
  EXPECT_TRUE(coloring.materials[1].cutout);
  EXPECT_EQ(coloring.materials[1].wrap_u, character::Material::Wrap::mirror);
  EXPECT_EQ(coloring.materials[1].wrap_v, character::Material::Wrap::repeat);
  // Triangles: the two of the leg, then the crate at the root and the crate at its own node.
  EXPECT_EQ(coloring.material_of_triangle, (std::vector<Index>{0, 0, 1, 1}));
  ASSERT_EQ(coloring.uv.size(), 4u);
  for (const std::size_t t : {2, 3})
    EXPECT_EQ(coloring.uv[t], (std::array<Vec2, 3>{Vec2(0.25, 0), Vec2(1, 0), Vec2(0, 1)}));
  EXPECT_TRUE(read().character.coloring.materials.empty()) << "of a motion nothing is read";
}

TEST_F(Scenes, TextureCoordinatesAreTransformedAsGltfStates) {
  const std::filesystem::path file = folder_ / "placed.gltf";
  for (const bool turned : {false, true}) {  // whether the picture is rotated by 90 degrees
    support::write_bytes(file, gltf_tetrahedron_of_integers(
                                   R"(,"material":0)",
                                   std::string(R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":
{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"scale":[0.25,0.5])") +
                                       (turned ? R"(,"rotation":1.5707963267948966)" : "") +
                                       R"(}}}}}],"extensionsUsed":["KHR_texture_transform"],"textures":[{"source":0}],
"images":[{"uri":"absent.png"}])"));
    const character::Character body = load_character(file, {}, "here").character;
    ASSERT_EQ(body.coloring.uv.size(), 4U);
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& x = body.mesh.positions[body.mesh.topology.triangles[t][k]];  // y of the file becomes z
        const double u = 0.25 * x.x(), v = 0.5 * x.z();
        const Vec2 placed = turned ? Vec2(0.5 + v, 1 - (0.25 - u)) : Vec2(0.5 + u, 1 - (0.25 + v));
        EXPECT_LT((body.coloring.uv[t][k] - placed).norm(), 1e-6);
      }
  }
}

TEST_F(Scenes, TextureCoordinatesAreFiniteWhateverTheirTransform) {
  const std::filesystem::path file = folder_ / "turned.gltf";
  support::write_bytes(file, gltf_tetrahedron_of_integers(
                                 R"(,"material":0)",
                                 R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{
"KHR_texture_transform":{"rotation":1e39}}}}}],"extensionsUsed":["KHR_texture_transform"],"textures":[{"source":0}],
"images":[{"uri":"absent.png"}])"));
  const character::Character body = load_character(file, {}, "here").character;
  ASSERT_EQ(body.coloring.uv.size(), 4U);
  for (const auto& corners : body.coloring.uv)
    for (const Vec2& uv : corners) EXPECT_TRUE(uv.allFinite());
}

TEST_F(Scenes, PicturesThatCannotBeHadAreLeftOutWithAWarning) {
  auto* material = new aiMaterial;
  const aiString outside("C:\\paint\\skin.tga");
  material->AddProperty(&outside, AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0));
  scene_.mMaterials = new aiMaterial* [1] { material };
  scene_.mNumMaterials = 1;
  const ReadCharacter got = to_character(scene_, "/nowhere/body.fbx");
  ASSERT_EQ(got.warnings.size(), 1u);
  EXPECT_EQ(got.warnings[0], "material \"\": picture \"C:\\paint\\skin.tga\" is left out: not there");
  EXPECT_EQ(got.character.coloring.material_of_triangle.size(), 4u);
}

TEST_F(Scenes, PicturesMayBeNamedPercentEncoded) {
  const std::string png = "\x89PNG\r\n\x1a\nand so on";
  support::write_bytes(folder_ / "my skin.png", png);
  auto* material = new aiMaterial;
  const aiString encoded("my%20skin.png");
  material->AddProperty(&encoded, AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0));
  scene_.mMaterials = new aiMaterial* [1] { material };
  scene_.mNumMaterials = 1;
  const ReadCharacter got = to_character(scene_, folder_ / "body.gltf");
  EXPECT_TRUE(got.warnings.empty());
  EXPECT_EQ(got.character.coloring.materials.at(0).picture, png);
}

// The pictures are not embedded, as in many FBX avatars: there is one warning for all materials.
TEST_F(Scenes, PicturesThatAreNeitherNamedNorHeldAreToldOfOnce) {
  scene_.mNumMaterials = 5;
  scene_.mMaterials = new aiMaterial*[5];
  for (unsigned i = 0; i < 5; ++i) {
    const aiString name("M" + std::to_string(i)), nowhere(".");
    auto* material = scene_.mMaterials[i] = new aiMaterial;
    material->AddProperty(&name, AI_MATKEY_NAME);
    material->AddProperty(&nowhere, AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0));
  }
  const ReadCharacter got = to_character(scene_, "/nowhere/body.fbx");
  ASSERT_EQ(got.warnings.size(), 1u);
  EXPECT_EQ(got.warnings[0],
            "materials \"M0\", \"M1\", \"M2\" and 2 more: pictures are left out: neither named nor held by the file");
}

TEST_F(Scenes, CutShortBetweenProcessesAreRefused) {
  ReadCharacter got = to_character(scene_, {});
  const std::string bytes = to_bytes(got);
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_THROW(static_cast<void>(character_from_bytes(std::string_view(bytes).substr(0, length))),
                 std::runtime_error);
}

}  // namespace
}  // namespace weft::assets
