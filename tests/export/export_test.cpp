// Exported files must contain what the frames show. Independent readers check this: assimp for meshes and animations,
// and a small reader in this file for point caches.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>

#include "export/made_frames.hpp"
#include "film/assets/mesh_file.hpp"
#include "film/image/color.hpp"
#include "film/image/picture.hpp"
#include "tools/export/gltf.hpp"
#include "tools/export/normals.hpp"

namespace weft::exporter {
namespace {

// A moving sheet of two quads, a static floor, and an invisible surface; z is up.
class Exported : public MadeFrames {
 protected:
  void SetUp() override {
    MadeFrames::SetUp();
    frame::Surface cloth;
    cloth.name = "cloth";
    cloth.quads = {{0, 1, 4, 3}, {1, 2, 5, 4}};
    cloth.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    for (int i = 0; i < 6; ++i) cloth.uv.emplace_back(0.1 * (i % 3), 0.1 * (i / 3));
    cloth.appearance.color = {0.8, 0.2, 0.1};
    cloth.appearance.roughness = 0.7;
    frame::Surface floor;
    floor.name = "floor";
    floor.kind = frame::ObjectKind::obstacle;
    floor.triangles = {{0, 1, 2}};
    add_surfaces({cloth, floor});
    request_.name = "flutter";
    request_.fps = 20;
  }

  // Frame 4 equals frame 2.
  std::vector<std::vector<Vec3>> positions(int k) const override {
    std::vector<Vec3> cloth;
    const int phase = k == 4 ? 2 : k;
    for (int i = 0; i < 6; ++i)
      cloth.emplace_back(0.1 * (i % 3) + 1.0 / 3, 0.1 * (i / 3) - 0.7, 0.05 * std::sin(0.9 * i + phase));
    return {cloth, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.25}}};
  }

  void write(Format format, std::vector<int> frames) {
    request_.format = format;
    request_.frames = std::move(frames);
    ASSERT_TRUE(exporter::write(request_, [&](int k) { return snapshot(k); }));
    std::vector<std::string> expected;
    for (const auto& file : exporter::files(request_, *snapshot(request_.frames.front()))) {
      EXPECT_TRUE(std::filesystem::exists(file)) << file;
      expected.push_back(file.filename().string());
    }
    for (const auto& [file, content] : exporter::shared_files(request_, *snapshot(request_.frames.front()))) {
      EXPECT_EQ(support::read_bytes(file), content) << file;
      expected.push_back(file.filename().string());
    }
    std::size_t there = 0;
    for (const auto& entry : std::filesystem::directory_iterator(request_.folder)) there += entry.is_regular_file();
    EXPECT_EQ(there, expected.size());
  }
  std::filesystem::path file(const std::string& name) const { return request_.folder / name; }

  /// The content of a file; valid until the next call.
  const aiScene& read(const std::string& name) {
    const aiScene* scene = importer_.ReadFile(file(name).string(), 0);
    if (scene == nullptr) throw std::runtime_error(importer_.GetErrorString());
    return *scene;
  }

 private:
  Assimp::Importer importer_;
};

void expect_points(const std::vector<Vec3>& expected, const aiVector3D* came, bool turned) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Vec3& x = expected[i];
    const Vec3 there = turned ? Vec3(x.x(), x.z(), -x.y()) : x;
    EXPECT_LT((Vec3(came[i].x, came[i].y, came[i].z) - there).cwiseAbs().maxCoeff(), kSingle) << "vertex " << i;
  }
}

TEST_F(Exported, PlyFilesHoldEachObjectOfEachFrame) {
  write(Format::ply, {0, 2, 4});
  for (int k : request_.frames) {
    const auto shown = snapshot(k);
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      const aiMesh& mesh = *read(fmt::format("{}_{:05}.ply", surfaces_[s]->name, k)).mMeshes[0];
      ASSERT_EQ(mesh.mNumVertices, shown->states[s].positions.size());
      EXPECT_EQ(mesh.mNumFaces, surfaces_[s]->triangles.size());
      expect_points(shown->states[s].positions, mesh.mVertices, false);
    }
  }
}

TEST_F(Exported, ObjFilesHoldQuadsAndWeftAndWarpWithEveryDigit) {
  write(Format::obj, {3});
  const aiScene& scene = read("cloth_00003.obj");
  const aiMesh& mesh = *scene.mMeshes[0];
  ASSERT_EQ(mesh.mNumFaces, 2u);
  const frame::Surface& cloth = *surfaces_[0];
  const std::vector<Vec3> positions = snapshot(3)->states[0].positions;
  for (unsigned f = 0; f < 2; ++f) {
    ASSERT_EQ(mesh.mFaces[f].mNumIndices, 4u);
    for (unsigned c = 0; c < 4; ++c) {
      const auto vertex = static_cast<std::size_t>(cloth.quads[f][c]);
      const unsigned there = mesh.mFaces[f].mIndices[c];  // the reader renumbers corners
      expect_points({positions[vertex]}, mesh.mVertices + there, false);
      EXPECT_NEAR(mesh.mTextureCoords[0][there].x, cloth.uv[vertex].x(), kSingle);
      EXPECT_NEAR(mesh.mTextureCoords[0][there].y, cloth.uv[vertex].y(), kSingle);
    }
  }
  // assimp reads single precision; the text itself contains the doubles.
  std::ifstream in(file("cloth_00003.obj"));
  std::size_t vertex = 0;
  for (std::string line; std::getline(in, line);) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) != 3) continue;
    EXPECT_EQ(Vec3(x, y, z), positions[vertex++]);
  }
  EXPECT_EQ(vertex, positions.size());
}

// Two panels that are sewn along their common edge; in the drawing, the right panel lies apart.
TEST_F(Exported, PanelsAreApartInTextureCoordinatesAndOneInTheMesh) {
  frame::Surface& garment = *surfaces_[0];
  garment.quads.clear();
  garment.paint_uv = {{Vec2(0, 0), Vec2(0.1, 0), Vec2(0.1, 0.1)},
                      {Vec2(0, 0), Vec2(0.1, 0.1), Vec2(0, 0.1)},
                      {Vec2(0.5, 0.7), Vec2(0.6, 0.7), Vec2(0.6, 0.8)},
                      {Vec2(0.5, 0.7), Vec2(0.6, 0.8), Vec2(0.5, 0.8)}};
  for (const auto& [format, name] :
       {std::pair(Format::obj, "cloth_00003.obj"), std::pair(Format::ply, "cloth_00003.ply"),
        std::pair(Format::gltf, "flutter.glb")}) {
    request_.folder = folder_ / name;
    write(format, {3});
    const assets::LoadedMesh loaded = assets::load_mesh(file(name), {}, "a test", format == Format::ply ? "" : "cloth");
    EXPECT_EQ(loaded.mesh.positions.size(), 6U) << name;
    EXPECT_EQ(loaded.mesh.topology.triangles.size(), 4U) << name;
    ASSERT_EQ(loaded.uv.size(), 4U) << name;
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT((loaded.uv[t][k] - garment.paint_uv[t][k]).norm(), kSingle) << name << t;
  }
}

// A picture of two pixels, the right one half transparent. It occurs once, rotated by 90 degrees, 0.1 m wide.
TEST_F(Exported, PicturesLieAndLookAsOurs) {
  frame::Surface& printed = *surfaces_[0];
  frame::Paint& paint = printed.appearance.paint;
  paint.texture = std::make_shared<frame::Texture>(frame::Texture{2, 1, {255, 0, 0, 255, 0, 0, 255, 128}});
  paint.texture_from_uv << 0, 10, 0, -20, 0, 1;
  paint.wrap_u = paint.wrap_v = frame::Paint::Wrap::once;
  paint.alpha = frame::Paint::Alpha::over_color;
  write(Format::gltf, {3});
  const aiScene& scene = read("flutter.glb");
  const aiMesh& mesh = *scene.mMeshes[0];
  ASSERT_TRUE(mesh.HasTextureCoords(1));
  for (std::size_t v = 0; v < 6; ++v) {
    const Vec2& uv = printed.uv[v];
    // The exported picture has one more pixel on every side: 4 by 3 pixels.
    EXPECT_NEAR(mesh.mTextureCoords[1][v].x, (2 * 10 * uv.y() + 1) / 4, 4 * kSingle);
    EXPECT_NEAR(mesh.mTextureCoords[1][v].y, (1 - 20 * uv.x() + 1) / 3, 4 * kSingle);
    EXPECT_NEAR(mesh.mTextureCoords[0][v].x, uv.x(), kSingle);
  }
  ASSERT_EQ(scene.mNumTextures, 1U);
  const aiTexture& held = *scene.mTextures[0];
  const image::Picture picture =
      image::decode_picture({reinterpret_cast<const char*>(held.pcData), static_cast<std::size_t>(held.mWidth)});
  ASSERT_EQ(std::pair(picture.width, picture.height), std::pair(4, 3));
  const auto pixel = [&](int x, int y) { return &picture.rgba[4 * static_cast<std::size_t>(4 * y + x)]; };
  const Vec3 light = image::linear_from_srgb(printed.appearance.color);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(pixel(1, 1)[c], c == 0 ? 255 : 0) << "its own";
    const double mixed = 127.0 / 255 * light[c] + (c == 2 ? 128.0 / 255 : 0);
    EXPECT_NEAR(pixel(2, 1)[c], 255 * image::srgb_from_linear(mixed), 0.51) << "light adds up";
    for (const auto& [x, y] : {std::pair(0, 1), {3, 1}, {1, 0}, {2, 2}})
      EXPECT_NEAR(pixel(x, y)[c], 255 * printed.appearance.color[c], 0.51) << "around it: the colour";
  }
  request_.folder = folder_ / "obj";
  write(Format::obj, {3});
  EXPECT_NE(support::read_bytes(file("cloth.mtl")).find("laid turned"), std::string::npos);
}

// Weft draws such a picture opaque, and the colour of the surface around it.
TEST_F(Exported, PictureWhoseAlphaIsIgnoredStaysOpaqueIfItOccursOnce) {
  frame::Surface& printed = *surfaces_[0];
  frame::Paint& paint = printed.appearance.paint;
  paint.texture = std::make_shared<frame::Texture>(frame::Texture{1, 1, {0, 0, 255, 128}});
  paint.wrap_u = paint.wrap_v = frame::Paint::Wrap::once;
  write(Format::obj, {3});
  const image::Picture picture = image::read_picture(file("cloth.png"));
  ASSERT_EQ(std::pair(picture.width, picture.height), std::pair(3, 3));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(picture.rgba[16 + c], c == 2 ? 255 : 0) << "the pixel in the middle";
    EXPECT_NEAR(picture.rgba[c], 255 * printed.appearance.color[static_cast<int>(c)], 0.51);
  }
}

// MTL files also name a picture that is repeated and not rotated; its alpha cuts holes.
TEST_F(Exported, MaterialFilesNameThePicture) {
  frame::Surface& lace = *surfaces_[0];
  frame::Paint& paint = lace.appearance.paint;
  paint.texture = std::make_shared<frame::Texture>(frame::Texture{1, 1, {255, 255, 255, 128}});
  paint.texture_from_uv << 4, 0, 0.5, 0, 8, 0.25;
  paint.alpha = frame::Paint::Alpha::cutout;
  write(Format::obj, {3});
  const std::string text = support::read_bytes(file("cloth.mtl"));
  for (const char* line : {"map_Kd -s 4 8 1 -o 0.5 0.25 0 cloth.png\n", "map_d -s 4 8 1 -o 0.5 0.25 0 cloth.png\n"})
    EXPECT_NE(text.find(line), std::string::npos) << text;
  EXPECT_EQ(text.find("cannot be said"), std::string::npos) << text;
  EXPECT_EQ(image::read_picture(file("cloth.png")).rgba[3], 128);
}

// Readers of MTL repeat a picture along both axes, or clamp it along both; they cannot mirror it.
TEST_F(Exported, MaterialFilesSayThatAPictureIsMirrored) {
  frame::Surface& mirrored = *surfaces_[0];
  mirrored.appearance.paint.texture = std::make_shared<frame::Texture>(frame::Texture{1, 1, {255, 0, 0, 255}});
  mirrored.appearance.paint.wrap_v = frame::Paint::Wrap::mirror;
  write(Format::obj, {3});
  const std::string text = support::read_bytes(file("cloth.mtl"));
  EXPECT_NE(text.find("# cloth.png is mirrored"), std::string::npos) << text;
}

// Without texture coordinates, a picture has no place on the surface.
TEST_F(Exported, SurfacesWithoutTextureCoordinatesHaveTheirColorAlone) {
  frame::Surface& bare = *surfaces_[0];
  bare.uv.clear();
  bare.appearance.paint.texture = std::make_shared<frame::Texture>(frame::Texture{1, 1, {255, 0, 0, 255}});
  write(Format::obj, {3});
  const std::string text = support::read_bytes(file("cloth.mtl"));
  EXPECT_EQ(text.find("cloth.png"), std::string::npos) << text;
  request_.folder = folder_ / "usd";
  write(Format::usd, {3});
  EXPECT_EQ(support::read_bytes(file("flutter.usda")).find("UsdUVTexture"), std::string::npos);
}

// An object called cloth_2 has a picture, whose name differs from that of the second picture of the object cloth.
TEST_F(Exported, EveryPictureHasAFileOfItsOwn) {
  const auto painted = [](frame::Appearance& look, std::uint8_t red) {
    look.paint.texture = std::make_shared<frame::Texture>(frame::Texture{1, 1, {red, 0, 0, 255}});
  };
  frame::Surface &cloth = *surfaces_[0], &other = *surfaces_[1];
  cloth.parts = {{"front", cloth.appearance}, {"back", cloth.appearance}};
  cloth.part_of_triangle = {0, 0, 1, 1};
  painted(cloth.parts[0].appearance, 10);
  painted(cloth.parts[1].appearance, 20);
  other.name = "cloth_2";
  painted(other.appearance, 30);
  write(Format::obj, {3});
}

template <class T>
T take(std::string_view& bytes) {
  T value;
  if (bytes.size() < sizeof value) throw std::runtime_error("too short");
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

// Blender counts samples, so the cache has one sample for every frame from the first exported one on. Samples between
// exported frames are interpolated. The axes are those of the OBJ files: y up, -z forward.
TEST_F(Exported, PointCachesHaveASampleForEachFrameAndMoveTheObjFilesBesideThem) {
  write(Format::pc2, {1, 4, 7});
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    std::ifstream in(file(surfaces_[s]->name + ".pc2"), std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(in), {}};
    std::string_view bytes = content;
    EXPECT_EQ(std::string(bytes.substr(0, 12)), std::string("POINTCACHE2\0", 12));
    bytes.remove_prefix(12);
    EXPECT_EQ(take<std::int32_t>(bytes), 1);
    const std::size_t points = snapshot(1)->states[s].positions.size();
    EXPECT_EQ(take<std::int32_t>(bytes), static_cast<std::int32_t>(points));
    EXPECT_EQ(take<float>(bytes), 1.0F);
    EXPECT_EQ(take<float>(bytes), 1.0F);
    EXPECT_EQ(take<std::int32_t>(bytes), 7);
    for (int k = 1; k <= 7; ++k) {
      const int before = 1 + (k - 1) / 3 * 3;
      const auto from = snapshot(before), to = snapshot(std::min(before + 3, 7));
      for (std::size_t i = 0; i < points; ++i) {
        const Vec3 &a = from->states[s].positions[i], &b = to->states[s].positions[i];
        const Vec3 x = a + (k - before) / 3.0 * (b - a);
        for (const double along : {x.x(), x.z(), -x.y()}) EXPECT_EQ(take<float>(bytes), static_cast<float>(along));
      }
    }
    EXPECT_TRUE(bytes.empty());
    // Points of the cache are in the order of the vertices of the mesh.
    std::ifstream mesh(file(surfaces_[s]->name + ".obj"));
    std::size_t vertex = 0;
    for (std::string line; std::getline(mesh, line);) {
      double x = 0, y = 0, z = 0;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) != 3) continue;
      EXPECT_EQ(Vec3(x, -z, y), snapshot(1)->states[s].positions[vertex++]);
    }
    EXPECT_EQ(vertex, points);
  }
}

// Normal of a sheet at a vertex, from the triangles around it.
Vec3 normal_at(const frame::Surface& surface, const std::vector<Vec3>& x, Index vertex) {
  Vec3 sum = Vec3::Zero();
  for (const auto& t : surface.triangles)
    if (std::ranges::find(t, vertex) != t.end()) sum += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  return sum.normalized();
}

TEST_F(Exported, ObjFilesHaveNormalsAndAMaterial) {
  surfaces_[0]->crease_angle = 180;  // as for drawn cloth
  write(Format::obj, {3, 4});
  const aiScene& scene = read("cloth_00003.obj");
  const aiMesh& mesh = *scene.mMeshes[0];
  ASSERT_TRUE(mesh.HasNormals());
  const frame::Surface& cloth = *surfaces_[0];
  const std::vector<Vec3> x = snapshot(3)->states[0].positions;
  for (unsigned f = 0; f < 2; ++f)
    for (unsigned c = 0; c < 4; ++c) {
      const aiVector3D& n = mesh.mNormals[mesh.mFaces[f].mIndices[c]];
      EXPECT_LT((Vec3(n.x, n.y, n.z) - normal_at(cloth, x, cloth.quads[f][c])).norm(), 1e-6) << f << c;
    }
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  EXPECT_EQ(std::string(material.GetName().C_Str()), "cloth");
  aiColor3D color;
  ASSERT_EQ(material.Get(AI_MATKEY_COLOR_DIFFUSE, color), aiReturn_SUCCESS);
  EXPECT_NEAR(color.r, image::linear_from_srgb(cloth.appearance.color).x(), 1e-6);
  float shininess = 0;
  ASSERT_EQ(material.Get(AI_MATKEY_SHININESS, shininess), aiReturn_SUCCESS);
  EXPECT_NEAR(1 - std::sqrt(shininess / 1000), 0.7, 1e-5);
}

TEST_F(Exported, GltfNormalsMoveWithTheFrames) {
  surfaces_[0]->crease_angle = 180;  // as for drawn cloth
  write(Format::gltf, {2, 3});
  const aiScene& scene = read("flutter.glb");
  const aiMesh& mesh = *scene.mMeshes[0];
  ASSERT_EQ(mesh.mNumVertices, 6u);
  ASSERT_EQ(mesh.mNumAnimMeshes, 1u);
  const auto expect_normals = [&](int frame, const aiVector3D* normals) {
    ASSERT_NE(normals, nullptr);
    const std::vector<Vec3> x = snapshot(frame)->states[0].positions;
    for (int i = 0; i < 6; ++i) {
      const Vec3 n = normal_at(*surfaces_[0], x, i);
      EXPECT_LT((Vec3(normals[i].x, normals[i].y, normals[i].z) - Vec3(n.x(), n.z(), -n.y())).norm(), 3 * kSingle);
    }
  };
  expect_normals(2, mesh.mNormals);
  expect_normals(3, mesh.mAnimMeshes[0]->mNormals);
}

TEST_F(Exported, SharpEdgesHaveANormalOnEitherSide) {
  frame::Surface roof = *surfaces_[0];
  roof.crease_angle = 30;
  std::vector<Vec3> bent;
  for (int i = 0; i < 6; ++i) bent.emplace_back(0.1 * (i % 3), 0.1 * (i / 3), i % 3 == 1 ? 0.1 : 0.0);
  const NormalGroups folded = group_normals(roof, bent);
  EXPECT_EQ(folded.vertex_of.size(), 8u) << "both vertices of the ridge twice";
  for (const Vec3& n : normals_of(folded, roof, bent)) EXPECT_NEAR(std::abs(n.x()), std::sqrt(0.5), 1e-12);
  EXPECT_NE(folded.of_corner[0][1], folded.of_corner[2][0]);
}

// The weights of an animated node at a time, interpolated linearly between keys, as the file specifies.
std::vector<double> weights_at(const aiMeshMorphAnim& channel, double time, std::size_t count) {
  std::vector<double> weights(count, 0.0);
  for (unsigned k = 0; k < channel.mNumKeys; ++k) {
    const double here = channel.mKeys[k].mTime;
    const double before = k > 0 ? channel.mKeys[k - 1].mTime : here - 1;
    const double after = k + 1 < channel.mNumKeys ? channel.mKeys[k + 1].mTime : here + 1;
    const double fraction =
        std::max(0.0, time <= here ? 1 - (here - time) / (here - before) : 1 - (time - here) / (after - here));
    for (unsigned v = 0; v < channel.mKeys[k].mNumValuesAndWeights; ++v)
      weights[channel.mKeys[k].mValues[v]] += fraction * channel.mKeys[k].mWeights[v];
  }
  return weights;
}

// Positions that a reader computes from morph weights.
std::vector<Vec3> morphed(const aiMesh& mesh, const std::vector<double>& weights) {
  std::vector<Vec3> x;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const auto at = [&](const aiVector3D* list) { return Vec3(list[i].x, list[i].y, list[i].z); };
    const Vec3 start = at(mesh.mVertices);
    x.push_back(start);
    for (unsigned t = 0; t < mesh.mNumAnimMeshes; ++t)
      x.back() += weights[t] * (at(mesh.mAnimMeshes[t]->mVertices) - start);
  }
  return x;
}

TEST_F(Exported, GltfAnimationGoesThroughEveryFrameAtItsTime) {
  write(Format::gltf, {2, 3, 4, 5});
  const aiScene& scene = read("flutter.glb");
  ASSERT_EQ(scene.mNumMeshes, 2u) << "what is not visible is left out";
  const aiMesh &cloth = *scene.mMeshes[0], &floor = *scene.mMeshes[1];
  EXPECT_EQ(std::string(cloth.mName.C_Str()), "cloth");
  EXPECT_EQ(cloth.mNumFaces, 4u);
  EXPECT_EQ(cloth.mNumAnimMeshes, 3u);
  EXPECT_EQ(floor.mNumAnimMeshes, 0u);
  expect_points(snapshot(2)->states[1].positions, floor.mVertices, true);
  EXPECT_NEAR(cloth.mTextureCoords[0][5].x, 0.2, kSingle);

  ASSERT_EQ(scene.mNumAnimations, 1u);
  const aiAnimation& animation = *scene.mAnimations[0];
  ASSERT_EQ(animation.mNumMorphMeshChannels, 1u);
  const aiMeshMorphAnim& channel = *animation.mMorphMeshChannels[0];
  EXPECT_EQ(std::string(channel.mName.C_Str()), "cloth");
  const double ticks = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 1000;
  for (int k = 2; k <= 5; ++k) {
    const double time = ticks * (k - 2) / request_.fps;
    const auto here = morphed(cloth, weights_at(channel, time, 3));
    const auto half = morphed(cloth, weights_at(channel, time + 0.5 * ticks / request_.fps, 3));
    const auto shown = snapshot(k)->states[0].positions, next = snapshot(std::min(k + 1, 5))->states[0].positions;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const auto turned = [](const Vec3& x) { return Vec3(x.x(), x.z(), -x.y()); };
      // Tolerance: a sum of three single-precision numbers of at most half a metre.
      EXPECT_LT((here[i] - turned(shown[i])).norm(), 3 * kSingle) << "frame " << k;
      if (k < 5) {
        EXPECT_LT((half[i] - turned(0.5 * (shown[i] + next[i]))).norm(), 3 * kSingle) << "after frame " << k;
      }
    }
  }
}

// The weights alone would need 1 TB.
TEST_F(Exported, GltfWithTooManyFramesIsRefusedBeforeItsWeightsAreAllocated) {
  const frame::SnapshotPtr first = snapshot(0);
  GltfFile gltf(*first);
  gltf.add(*snapshot(1), 1 / request_.fps);
  for (int k = 2; k <= 500'000; ++k) gltf.add(*first, k / request_.fps);
  support::expect_error(ExitCode::output_failed, "would be one of 1e+03 GB; export fewer frames with --frames",
                        [&] { gltf.write(file("flutter.glb"), "flutter", 1); });
  EXPECT_FALSE(std::filesystem::exists(file("flutter.glb")));
}

TEST_F(Exported, GltfMaterialsHaveTheColoursInLinearLight) {
  write(Format::gltf, {0});
  const aiScene& scene = read("flutter.glb");
  const aiMaterial& material = *scene.mMaterials[scene.mMeshes[0]->mMaterialIndex];
  aiColor4D color;
  ASSERT_EQ(material.Get(AI_MATKEY_BASE_COLOR, color), aiReturn_SUCCESS);
  const Vec3 expected = image::linear_from_srgb(surfaces_[0]->appearance.color);
  EXPECT_NEAR(color.r, expected.x(), kSingle);
  EXPECT_NEAR(color.g, expected.y(), kSingle);
  EXPECT_NEAR(color.b, expected.z(), kSingle);
  float roughness = 0;
  ASSERT_EQ(material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness), aiReturn_SUCCESS);
  EXPECT_NEAR(roughness, 0.7, kSingle);
  int two_sided = 0;
  material.Get(AI_MATKEY_TWOSIDED, two_sided);
  EXPECT_EQ(two_sided, 1);
}

TEST_F(Exported, AStopLeavesNothingHalf) {
  request_.format = Format::pc2;
  request_.frames = {0, 1, 2};
  int asked = 0;
  EXPECT_FALSE(exporter::write(
      request_, [&](int k) { return snapshot(k); }, [&] { return ++asked > 2; }));
  for (const auto& entry : std::filesystem::directory_iterator(request_.folder))
    EXPECT_NE(entry.path().extension(), ".pc2") << "whole files only, no cache of two samples: " << entry.path();
}

}  // namespace
}  // namespace weft::exporter
