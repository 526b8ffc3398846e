#include "film/assets/mesh_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "assets/small_files.hpp"
#include "core/error.hpp"
#include "film/assets/sequence_file.hpp"
#include "physics/mesh/geometry.hpp"
#include "physics/mesh/ply.hpp"
#include "support/mesh_measures.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

namespace fs = std::filesystem;
using Quads = std::vector<mesh::Quad>;
using Triangles = std::vector<mesh::Triangle>;

class MeshFiles : public support::TestFolder {
 protected:
  fs::path put(const std::string& name, const std::string& bytes) const {
    support::write_bytes(folder_ / name, bytes);
    return folder_ / name;
  }

  LoadedMesh load(const std::string& name, const std::string& bytes, double scale = 1) const {
    return load_mesh(put(name, bytes), {scale}, "scenes/a.toml:12:8: obstacle.chair");
  }

  /// The message after the names of scene, file and `mesh file`; "loaded" if there is no error.
  std::string refusal(const std::string& name, const std::string& bytes) const { return refusal_of(put(name, bytes)); }

  static std::string refusal_of(const fs::path& file) {
    try {
      load_mesh(file, {}, "scenes/a.toml:12:8: obstacle.chair");
      return "loaded";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::asset_unreadable);
      const std::string start = "scenes/a.toml:12:8: obstacle.chair: mesh file " + file.string() + ": ";
      const std::string text = error.what();
      EXPECT_EQ(text.substr(0, start.size()), start);
      return text.substr(std::min(start.size(), text.size()));
    }
  }
};

mesh::TopologyReport inspected(const LoadedMesh& loaded) {
  return mesh::inspect(loaded.mesh.topology.triangles, loaded.mesh.positions.size());
}

double volume(const LoadedMesh& loaded) {
  return support::enclosed_volume(loaded.mesh.topology.triangles, loaded.mesh.positions);
}

TEST_F(MeshFiles, OfQuadsAloneStayQuadsAndLoseTheirSeams) {
  const LoadedMesh cube = load("cube.obj", obj_cube());
  EXPECT_EQ(cube.mesh.positions.size(), 8u);
  EXPECT_EQ(cube.joined_vertices, 16u);  // each corner had three normals
  EXPECT_EQ(cube.mesh.topology.quads.size(), 6u);
  EXPECT_EQ(cube.mesh.topology.triangles.size(), 12u);
  EXPECT_TRUE(support::watertight(inspected(cube)));
  EXPECT_NEAR(volume(cube), 1, 1e-15);
  EXPECT_TRUE(cube.mesh.uv.empty());
}

// The data of a binary PLY file may begin with any byte, even with a line feed or a space, which end lines and words in
// the header.
TEST_F(MeshFiles, OfOurOwnAreReadWhateverByteTheirDataBeginWith) {
  for (const unsigned char first : {9, 10, 13, 32})
    for (const unsigned char second : {10, 13, 32}) {
      std::vector<Vec3> positions{{0.1, 0.2, 0.3}, {1, 0, 0}, {0, 1, 0.5}};
      std::memcpy(&positions[0].x(), std::array{first, second}.data(), 2);
      mesh::write_ply(folder_ / "own.ply", positions, Triangles{{0, 1, 2}});
      const LoadedMesh loaded = load_mesh(folder_ / "own.ply", {}, "here");
      ASSERT_EQ(loaded.mesh.positions.size(), 3u) << int{first} << " " << int{second};
      EXPECT_EQ(loaded.mesh.topology.triangles, (Triangles{{0, 1, 2}}));
      for (std::size_t v = 0; v < 3; ++v)
        EXPECT_LT((loaded.mesh.positions[v] - positions[v]).norm(), 1e-7) << int{first};  // tolerance: single precision
    }
}

TEST_F(MeshFiles, KeepTheOrderInWhichFacesNameVertices) {
  const LoadedMesh loaded = load("two.obj", "v 9 9 9\nv 1 0 0\nv 0 0 0\nv 0 1 0\nv 1 1 0\nf 3 2 4\nf 2 5 4\n");
  EXPECT_EQ(loaded.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(loaded.mesh.topology.triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_TRUE(loaded.mesh.topology.quads.empty());
}

// The second triangle repeats two positions of the first; where vertices are joined, the joined vertex takes the
// largest value of each colour channel.
TEST_F(MeshFiles, KeepColoursAndGroupsOfVerticesThatTheyJoin) {
  const LoadedMesh colored = load("colors.obj",
                                  "v 0 0 0 0.25 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nv 1 0 0 1 0 0\nv 0 1 0 0 0 0\n"
                                  "v 1 1 0 0 0 0\nf 1 2 3\nf 4 6 5\n");
  EXPECT_EQ(colored.colors, (std::vector<Vec3>{{0.25, 0, 0}, {1, 0.5, 0}, {0, 0, 1}, {0, 0, 0}}));
  EXPECT_TRUE(colored.groups.empty());
  const std::string identity = "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;;";
  const LoadedMesh grouped =
      load("groups.x", "xof 0303txt 0032\nFrame Root { FrameTransformMatrix { " + identity +
                           " }\n Mesh M { 3; 0.0;0.0;0.0;, 1.0;0.0;0.0;, 0.0;1.0;0.0;;\n  1; 3;0,1,2;;\n"
                           "  XSkinMeshHeader { 1; 1; 2; }\n  SkinWeights { \"waist\"; 2; 0,1; 1.0,0.25; " +
                           identity + " }\n  SkinWeights { \"hem\"; 2; 1,2; 0.75,1.0; " + identity + " } } }\n");
  EXPECT_TRUE(grouped.colors.empty());
  ASSERT_EQ(grouped.groups.size(), 2u);
  for (std::size_t v = 0; v < 3; ++v) {
    const Vec3& x = grouped.mesh.positions[v];
    EXPECT_EQ(grouped.groups.at("waist")[v], x.x() == 1 ? 0.25 : x.y() == 0 ? 1 : 0);
    EXPECT_EQ(grouped.groups.at("hem")[v], x.x() == 1 ? 0.75 : x.y() == 0 ? 0 : 1);
  }
}

TEST_F(MeshFiles, OfTrianglesAndQuadsBecomeTriangles) {
  const LoadedMesh loaded = load("mixed.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n");
  EXPECT_TRUE(loaded.mesh.topology.quads.empty());
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 3u);
  EXPECT_EQ(mesh::surface_area(loaded.mesh.topology.triangles, loaded.mesh.positions), 1.5);
}

TEST_F(MeshFiles, WithLargerPolygonsAreTriangulatedInsideThem) {
  // An L-shaped polygon of six corners, with area 3.
  const LoadedMesh loaded = load("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 4u);
  EXPECT_EQ(mesh::surface_area(loaded.mesh.topology.triangles, loaded.mesh.positions), 3);
  for (const auto& t : loaded.mesh.topology.triangles) EXPECT_GT(mesh::area_vector(t, loaded.mesh.positions).z(), 0);
}

TEST_F(MeshFiles, OfAsciiPlyAreReadAndScaled) {
  const LoadedMesh loaded = load("t.ply", ply_tetrahedron(), 10);
  EXPECT_TRUE(support::watertight(inspected(loaded)));
  EXPECT_NEAR(volume(loaded), 1000.0 / 6, 1e-12 * 1000);
}

TEST_F(MeshFiles, OfPlyMayHaveCommentsBeforeTheirFormat) {
  std::string ply = ply_tetrahedron();
  ply.insert(ply.find("format"), "comment written by hand\nobj_info none\n");
  EXPECT_NEAR(volume(load("t.ply", ply)), 1.0 / 6, 1e-15);
}

TEST_F(MeshFiles, OfStlAreWatertightThoughTheirTrianglesShareNothing) {
  const LoadedMesh loaded = load("t.stl", stl_tetrahedron());
  EXPECT_EQ(loaded.mesh.positions.size(), 4u);
  EXPECT_EQ(loaded.joined_vertices, 8u);
  EXPECT_TRUE(support::watertight(inspected(loaded)));
  EXPECT_NEAR(volume(loaded), 1.0 / 6, 1e-15);
}

TEST_F(MeshFiles, OfGltfFollowTheirNodesAndFaceOutwardThoughMirrored) {
  const LoadedMesh loaded = load("t.gltf", gltf_tetrahedron());
  EXPECT_TRUE(support::watertight(inspected(loaded)));
  EXPECT_NEAR(volume(loaded), 1.0 / 6, 1e-15);
  const Box3 box = mesh::bounding_box(loaded.mesh.positions);
  // In the file, y is up, and z is from 1 to 2.
  EXPECT_EQ(Vec3(box.min()), Vec3(0, -2, 0));
  EXPECT_EQ(Vec3(box.max()), Vec3(1, -1, 1));
}

std::string with_up_axis_of_fbx(std::string fbx, int up) {
  const std::string unit = "\t\tP: \"UnitScaleFactor\"";
  return fbx.insert(fbx.find(unit), "\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\"," + std::to_string(up) + "\n");
}

// A square of 1 m with a corner at the origin, along x and y of the file.
TEST_F(MeshFiles, ThatSayWhichAxisIsUpAreTurnedToThatOfTheScene) {
  const Vec3 level(1, 1, 0), upright(1, 0, 1);
  struct Case {
    const char* name;
    std::string bytes;
    scene::FileUp up;
    scene::UpAxis scene_up;
    Vec3 corner;  // farthest from the origin
  };
  using scene::FileUp;
  const auto y = scene::UpAxis::y, z = scene::UpAxis::z;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  const std::string z_up_collada = support::replaced(collada_square(), "Y_UP", "Z_UP");
  const std::vector<Case> cases = {{"y.dae", collada_square(), FileUp::as_file, z, upright},
                                   {"y.dae", collada_square(), FileUp::as_file, y, level},
                                   {"z.dae", z_up_collada, FileUp::as_file, z, level},
                                   {"z.dae", z_up_collada, FileUp::as_file, y, Vec3(1, 0, -1)},
                                   {"y.fbx", with_up_axis_of_fbx(fbx_square(), 1), FileUp::as_file, z, upright},
                                   {"z.fbx", with_up_axis_of_fbx(fbx_square(), 2), FileUp::as_file, z, level},
                                   {"nothing.fbx", fbx_square(), FileUp::as_file, z, upright},
                                   {"a.obj", obj, FileUp::as_file, z, level},
                                   {"a.obj", obj, FileUp::y, z, upright},
                                   {"a.obj", obj, FileUp::z, y, Vec3(1, 0, -1)}};
  for (const Case& c : cases) {
    const LoadedMesh loaded = load_mesh(put(c.name, c.bytes), {1, c.up, c.scene_up}, "here");
    double nearest = 1;
    for (const Vec3& x : loaded.mesh.positions) nearest = std::min(nearest, (x - c.corner).norm());
    EXPECT_LT(nearest, 1e-5) << c.name << ", expected a corner at " << c.corner.transpose();
  }
}

TEST_F(MeshFiles, OfASequenceAreTurnedAsTheyStateElseFromY) {
  const auto farthest = [&](const char* name, const std::string& bytes, scene::FileUp up) {
    const std::filesystem::path file = put(name, bytes);
    const LoadedSequence loaded = load_sequence({&file, 1}, {{}, up, scene::UpAxis::z}, "here");
    return Vec3(mesh::bounding_box(loaded.positions.front()).max());
  };
  const Vec3 level(1, 1, 0), upright(1, 0, 1);
  using scene::FileUp;
  EXPECT_LT((farthest("z.fbx", with_up_axis_of_fbx(fbx_square(), 2), FileUp::as_file) - level).norm(), 1e-5);
  EXPECT_LT((farthest("z.fbx", with_up_axis_of_fbx(fbx_square(), 2), FileUp::y) - upright).norm(), 1e-5);
  EXPECT_LT((farthest("y.fbx", with_up_axis_of_fbx(fbx_square(), 1), FileUp::as_file) - upright).norm(), 1e-5);
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  EXPECT_LT((farthest("a.obj", obj, FileUp::as_file) - upright).norm(), 1e-5);
}

TEST_F(MeshFiles, OfASequenceMayHavePolygonsWhoseShapeChanges) {
  const auto hexagon = [](int dented) {  // the corner `dented` lies near the middle
    std::string obj;
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::numbers::pi / 3, radius = k == dented ? 0.1 : 1;
      obj += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
    }
    return obj + "f 1 2 3 4 5 6\n";
  };
  const std::vector<std::filesystem::path> files{put("0.obj", hexagon(0)), put("1.obj", hexagon(1))};
  const LoadedSequence loaded = load_sequence(files, {{}, scene::FileUp::as_file, scene::UpAxis::y}, "here");
  EXPECT_EQ(loaded.positions.size(), 2U);
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 4U);
}

TEST_F(MeshFiles, OfASequenceKeepTrianglesThatHaveAnAreaInAnyFile) {
  const auto fold = [](double y) {  // the second triangle unfolds in the sequence; the third never has an area
    return fmt::format("v 0 0 0\nv 1 0 0\nv 0.5 1 0\nv 0.5 {} 0\nv 2 0 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n", y);
  };
  const std::vector<std::filesystem::path> files{put("0.obj", fold(0)), put("1.obj", fold(-1)), put("2.obj", fold(0))};
  const LoadedSequence loaded = load_sequence(files, {{}, scene::FileUp::as_file, scene::UpAxis::y}, "here");
  EXPECT_EQ(loaded.mesh.topology.triangles, (Triangles{{0, 1, 2}, {1, 0, 3}}));
}

TEST_F(MeshFiles, CountVerticesThatNoTriangleHas) {
  const LoadedMesh loaded =
      load("line.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(loaded.removed_triangles, 1u);
  EXPECT_EQ(loaded.lost_vertices, 3u);
}

TEST_F(MeshFiles, ThatSayTheirUnitAreInMetresWithTheirTextureCoordinates) {
  for (const auto& [name, bytes] : {std::pair{"cm.fbx", fbx_square()}, {"inch.dae", collada_square()}}) {
    const LoadedMesh loaded = load_mesh(put(name, bytes), {2, scene::FileUp::as_file, scene::UpAxis::y}, "here");
    const Box3 box = mesh::bounding_box(loaded.mesh.positions);
    EXPECT_LT((box.max() - Vec3(2, 2, 0)).norm(), 1e-5) << name << ": " << box.max().transpose();
    EXPECT_LT(box.min().norm(), 1e-5) << name;
    ASSERT_EQ(loaded.uv.size(), 2U) << name;
    for (const auto& corners : loaded.uv)
      for (const Vec2& uv : corners) EXPECT_TRUE(uv.x() * (1 - uv.x()) == 0 && uv.y() * (1 - uv.y()) == 0) << name;
  }
}

// VRM files are binary glTF with another extension.
TEST_F(MeshFiles, OfBinaryGltfAreReadWhateverTheyAreCalled) {
  for (const char* name : {"body.vrm", "body.VRM", "body.glb"})
    EXPECT_NEAR(volume(load(name, glb_tetrahedron())), 1.0 / 6, 1e-15) << name;
}

TEST_F(MeshFiles, OfCompressedGltfAreRefusedByTheNameOfTheCompression) {
  for (const std::string name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    const std::string file =
        R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_materials_unlit", ")" + name + "\"]}";
    EXPECT_EQ(refusal("packed.gltf", file),
              "expected meshes without compression, got " + name + ", which is not read; export the file without it");
  }
}

TEST_F(MeshFiles, OfGltfWithExtensionsThatTheyRequireAreRefusedUnlessTheyAreOfLooks) {
  const auto with = [](const std::string& name) {
    return support::replaced(gltf_tetrahedron_of_integers(), "KHR_mesh_quantization", name);
  };
  EXPECT_EQ(refusal("many.gltf", with("EXT_mesh_gpu_instancing")),
            "expected no extension that the file requires, got EXT_mesh_gpu_instancing, which is not read; export the "
            "file without it");
  for (const char* name : {"KHR_materials_unlit", "EXT_texture_webp", "KHR_technique_webgl", "VRMC_vrm"})
    EXPECT_EQ(refusal("looks.gltf", with(name)), "loaded") << name;
}

// gltfpack and glTF-Transform write such files.
TEST_F(MeshFiles, OfGltfWithIntegersForFloatsAreConverted) {
  const LoadedMesh loaded = load("a.gltf", gltf_tetrahedron_of_integers());
  EXPECT_TRUE(support::watertight(inspected(loaded)));
  EXPECT_NEAR(volume(loaded), 1.0 / 6, 1e-15);
  for (std::size_t t = 0; t < 4; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = loaded.mesh.positions[loaded.mesh.topology.triangles[t][k]];  // y of the file is up, so it is z
      EXPECT_EQ(loaded.uv[t][k], Vec2(x.x(), 1 - x.z()));
    }
  const std::string cut = support::replaced(gltf_tetrahedron_of_integers(), "\"byteOffset\":76", "\"byteOffset\":80");
  EXPECT_EQ(refusal("cut.gltf", cut), "expected 1 elements of 6 bytes in a buffer, which has 84 bytes");
  // The index of the sparse part is read from the bytes of texture coordinates: 255, 0, 0, 0 are the number 255.
  const std::string astray =
      support::replaced(gltf_tetrahedron_of_integers(), "\"byteOffset\":72", "\"byteOffset\":60");
  EXPECT_EQ(refusal("astray.gltf", astray),
            "expected indices of a sparse accessor below 4, its number of elements, got 255");
}

TEST_F(MeshFiles, WithAByteOrderMarkAreReadFromBehindIt) {
  const std::string mark = "\xef\xbb\xbf";
  EXPECT_NEAR(volume(load("marked.obj", mark + obj_cube())), 1, 1e-15);
  EXPECT_NEAR(volume(load("marked.gltf", mark + gltf_tetrahedron())), 1.0 / 6, 1e-15);
}

TEST_F(MeshFiles, OfObjMayHaveCommentsBehindNumbers) {
  std::string text;
  for (const char c : obj_cube()) text += c == '\n' ? "  # 1/2 of a comment\n" : std::string(1, c);
  EXPECT_NEAR(volume(load("comments.obj", "o cube#1\n" + text)), 1, 1e-15);
}

TEST_F(MeshFiles, OfGltfHaveTheWeightsOfTheirMorphTargets) {
  // A target that doubles the size, at half its weight.
  const std::string gltf = support::replaced(gltf_tetrahedron(), R"("indices":1}])",
                                             R"("indices":1,"targets":[{"POSITION":0}]}],"weights":[0.5])");
  EXPECT_NEAR(volume(load("morph.gltf", gltf)), 1.5 * 1.5 * 1.5 / 6, 1e-6);
}

TEST_F(MeshFiles, OfGltfHaveTheirAttributesInAnyOrder) {
  const std::string gltf =
      support::replaced(gltf_tetrahedron(), R"("POSITION":0)", R"("TEXCOORD_1":0,"TEXCOORD_0":0,"POSITION":0)");
  EXPECT_NEAR(volume(load("order.gltf", gltf)), 1.0 / 6, 1e-15);
}

TEST_F(MeshFiles, OfGltfMayLackScenes) {
  const std::string gltf = support::replaced(gltf_tetrahedron(), R"("scene":0,"scenes":[{"nodes":[0]}],)", "");
  EXPECT_NEAR(volume(load("library.gltf", gltf)), 1.0 / 6, 1e-15);
}

TEST_F(MeshFiles, OfGltfHaveTheirDataInFilesWithPercentEncodedNames) {
  const std::string binary = glb_tetrahedron();
  std::string gltf = gltf_tetrahedron();
  const std::size_t uri = gltf.find("data:"), end = gltf.find('"', uri);
  put("my 100% d\xc3\xa4ta.bin", binary.substr(binary.size() - 72));
  EXPECT_NEAR(volume(load("a.gltf", gltf.replace(uri, end - uri, "my%20100%25%20d%C3%A4ta.bin"))), 1.0 / 6, 1e-15);
}

TEST_F(MeshFiles, OfGltfThatNestsTooDeepAreRefusedBeforeTheyAreRead) {
  const std::string deep = R"({"asset": {"version": "2.0"}, "nodes": )" + std::string(300'000, '[');
  const std::string words = "expected JSON of at most 128 levels of lists and objects, got more";
  EXPECT_EQ(refusal("deep.gltf", deep), words);
  std::string binary = glb_tetrahedron().substr(0, 20) + deep;
  const auto length = static_cast<std::uint32_t>(deep.size());
  std::memcpy(&binary[12], &length, sizeof length);
  EXPECT_EQ(refusal("deep.glb", binary), words);
}

/// Two squares of 0.1 m side by side. `gap`: their distance [m].
std::string two_squares(double gap) {
  const double x = 0.1 + gap;
  return "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nv " + std::to_string(x) + " 0 0.001\nv 0.3 0 0\nv 0.3 0.1 0\nv " +
         std::to_string(x) + " 0.1 0 1 0 0\nf 1 2 3 4\nf 5 6 7 8\n";
}

TEST_F(MeshFiles, AreWeldedWhereBordersNearlyMeet) {
  LoadedMesh near = load("near.obj", two_squares(0.004));
  const Welded welded = weld_borders(near, 0.1);
  EXPECT_EQ(welded.vertices, 2U);
  EXPECT_NEAR(welded.widest, std::hypot(0.004, 0.001), 1e-8);
  EXPECT_EQ(near.mesh.positions.size(), 6U);
  EXPECT_EQ(inspected(near).border.size(), 6U);
  EXPECT_NEAR(near.mesh.positions[1].x(), 0.102, 1e-8) << "in the middle";
  ASSERT_EQ(near.mesh.topology.quads.size(), 2U);
  EXPECT_EQ(near.mesh.topology.quads[1][0], near.mesh.topology.quads[0][1]);
  LoadedMesh far = load("far.obj", two_squares(0.012));
  EXPECT_EQ(weld_borders(far, 0.1).vertices, 0U);
  EXPECT_EQ(far.mesh.positions.size(), 8U);
}

TEST_F(MeshFiles, AreNotWeldedWhereThreeSheetsWouldMeet) {
  LoadedMesh three = load("three.obj", two_squares(0.004) + "v 0.102 0 0\nv 0.102 0.1 0\nv 0.1 0 0.1\nf 9 10 11\n");
  EXPECT_EQ(weld_borders(three, 0.1).vertices, 0U);
  EXPECT_EQ(three.mesh.positions.size(), 11U);
}

TEST_F(MeshFiles, WithSeveralMeshesAreMergedAndJoinedWhereTheyTouch) {
  const LoadedMesh loaded = load("two.obj",
                                 "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"
                                 "o b\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 4 5 6\n");
  EXPECT_EQ(loaded.mesh.positions.size(), 4u);
  EXPECT_EQ(inspected(loaded).border.size(), 4u);
}

TEST_F(MeshFiles, JoinZeroAndMinusZero) {
  const LoadedMesh loaded =
      load("zero.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv -0 -0 -0\nv 1 1 -0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(loaded.mesh.positions.size(), 4u);
}

TEST_F(MeshFiles, LoseFacesWithoutAreaAndSaySo) {
  const LoadedMesh loaded = load("flat.obj",
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 2 0 0\nv 0.5 1e-9 0\n"
                                 "f 1 2 3\n"    // valid
                                 "f 1 4 3\n"    // two corners coincide
                                 "f 1 2 5\n"    // corners on a line
                                 "f 1 2 6\n");  // corners almost on a line
  EXPECT_EQ(loaded.removed_triangles, 3u);
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 1u);
}

TEST_F(MeshFiles, OfQuadsWithOneWithoutAreaBecomeTriangles) {
  // The second quad has collapsed to a triangle: corners 2 and 3 coincide.
  const LoadedMesh loaded =
      load("collapsed.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 6 3\n");
  EXPECT_TRUE(loaded.mesh.topology.quads.empty());
  EXPECT_EQ(loaded.mesh.topology.triangles.size(), 3u);
  EXPECT_EQ(loaded.removed_triangles, 1u);
}

TEST_F(MeshFiles, WithoutFacesAreRefused) {
  EXPECT_EQ(refusal("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "expected faces, got none");
  EXPECT_EQ(refusal("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "expected faces with an area, got none");
}

TEST_F(MeshFiles, WithInfiniteOrHugeCoordinatesAreRefused) {
  const std::string expected = "expected coordinates below 1e+06 m, got (";
  for (const char* number : {"inf", "-inf", "nan", "1e39", "-2e6"}) {
    const std::string text = refusal("far.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 ") + number + " 0\nf 1 2 3\n");
    EXPECT_EQ(text.substr(0, expected.size()), expected) << number << ": " << text;
  }
}

TEST_F(MeshFiles, ThatAssimpCannotReadAreRefusedInItsWords) {
  EXPECT_EQ(refusal("a.ply", "ply\nnonsense\nend_header\n"), "Invalid .ply file: Missing format specification");
  EXPECT_NE(refusal("a.unheard_of", "text").find("No suitable reader found"), std::string::npos);
}

TEST_F(MeshFiles, OfPlyWithoutAnEndOfTheirHeaderAreRefusedAtOnce) {
  const std::string whole = ply_tetrahedron();
  EXPECT_EQ(refusal("cut.ply", whole.substr(0, whole.find("end_header"))),
            "expected a line end_header in the first 64 kB of a PLY file, got none");
}

TEST_F(MeshFiles, OfPlyWithTriangleStripsAreRefusedByName) {
  EXPECT_EQ(refusal("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                    "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n"),
            "expected faces, got triangle strips (tristrips), which are not read; export the file with faces");
}

TEST_F(MeshFiles, ThatAreEmptyMissingFoldersOrTooLargeAreRefusedBeforeReading) {
  EXPECT_EQ(refusal("empty.obj", ""), "expected a mesh, got an empty file");
  EXPECT_EQ(refusal_of(folder_ / "absent.obj"), "expected a readable file, got none at this path");
  EXPECT_EQ(refusal_of(folder_), "expected a regular file, got a folder or a device");
  const fs::path large = put("large.obj", "v 0 0 0\n");
  fs::resize_file(large, kMaxMeshFileBytes + 1);  // sparse: occupies no disk space
  EXPECT_EQ(refusal_of(large), "expected at most 268435456 bytes, got 268435457; reduce the mesh");
}

}  // namespace
}  // namespace weft::assets
