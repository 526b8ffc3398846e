// Meshes that assimp divides by their materials or primitives.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "assets/small_files.hpp"
#include "film/assets/character_file.hpp"
#include "film/assets/mesh_file.hpp"
#include "film/character/pose.hpp"
#include "physics/mesh/geometry.hpp"
#include "support/small_character.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

class MaterialSeams : public support::TestFolder {
 protected:
  /// The rod; its first triangle has another material than the other two. The most important bone of the first part is
  /// "Hips", that of the second part "Spine", which has moved up by 1 m since the skin was bound to it.
  static std::string rod_of_two_materials() {
    std::string rod = support::rod_file();
    const auto insert = [&](const std::string& before, const std::string& text) { rod.insert(rod.find(before), text); };
    const std::string material = "  Material { 1.0;1.0;1.0;1.0;; 0.0; 0.0;0.0;0.0;; 0.0;0.0;0.0;; }\n";
    insert("  XSkinMeshHeader", "  MeshMaterialList { 2; 3; 0,1,1;;\n" + material + material + "  }\n");
    return support::replaced(rod, "0.0,1.0,0.0,1.0;; } } }", "0.0,2.0,0.0,1.0;; } } }");
  }
};

TEST_F(MaterialSeams, OfCharactersAreClosed) {
  std::string rod = rod_of_two_materials();
  support::write_bytes(folder_ / "rod.x", rod);
  const character::Character body = load_character(folder_ / "rod.x", {}, "here").character;
  ASSERT_EQ(body.coloring.materials.size(), 2U);
  EXPECT_EQ(body.mesh.positions.size(), 5U);
  std::vector<Vec3> x(body.mesh.positions.size());
  character::skin(body, character::rest_pose(body), x);
  EXPECT_NEAR(mesh::bounding_box(x).max().z(), 3, 1e-6) << "where its spine holds it";
  // The same without bones.
  const std::size_t skin = rod.find("  XSkinMeshHeader");
  rod.erase(skin, rod.find("AnimTicksPerSecond") - skin);
  support::write_bytes(folder_ / "rod.x", rod.insert(skin, " } }\n"));
  EXPECT_EQ(load_character(folder_ / "rod.x", {}, "here").character.mesh.positions.size(), 5U);
}

TEST_F(MaterialSeams, OfMeshesAreClosed) {
  support::write_bytes(folder_ / "rod.x", rod_of_two_materials());
  const LoadedMesh rod = load_mesh(folder_ / "rod.x", {}, "here");
  EXPECT_EQ(rod.mesh.positions.size(), 5U);
  EXPECT_NEAR(mesh::bounding_box(rod.mesh.positions).max().y(), 2, 1e-6) << "where the bone of its first part holds it";
}

// assimp calls the parts of "Body" in glTF "Body-0" and "Body-1".
TEST_F(MaterialSeams, LeaveAMeshItsName) {
  support::write_bytes(folder_ / "body.gltf",
                       support::replaced(gltf_tetrahedron(), R"({"primitives":[)",
                                         R"({"name":"Body","primitives":[{"attributes":{"POSITION":0},"indices":1},)"));
  const auto triangles = [&](const std::string& name) {
    const MeshChoice choice{.only = {name}, .without = {}, .elsewhere = {}};
    const auto count =
        load_character(folder_ / "body.gltf", {}, "here", choice).character.mesh.topology.triangles.size();
    EXPECT_EQ(load_mesh(folder_ / "body.gltf", {}, "here", name).mesh.topology.triangles.size(), count);
    return count;
  };
  EXPECT_EQ(triangles("Body-1"), 4U);
  EXPECT_EQ(triangles("Body"), 8U);
}

}  // namespace
}  // namespace weft::assets
