// Characters of glTF files whose joints do not have names of their own.
#include <gtest/gtest.h>

#include <string>

#include "assets/small_files.hpp"
#include "film/assets/character_file.hpp"
#include "physics/mesh/geometry.hpp"
#include "support/test_folder.hpp"

namespace weft::assets {
namespace {

class TwoSkeletons : public support::TestFolder {
 protected:
  /// Extent along x of both triangles at rest [m].
  double width_of(const std::string& gltf) {
    support::write_bytes(folder_ / "two.gltf", gltf);
    const LoadedCharacter loaded = load_character(folder_ / "two.gltf", {}, "here");
    EXPECT_EQ(loaded.character.mesh.topology.triangles.size(), 2U);
    return mesh::bounding_box(loaded.character.mesh.positions).sizes().x();
  }
};

TEST_F(TwoSkeletons, WithEqualNamesOfJointsHoldEachItsOwnSkin) {
  EXPECT_NEAR(width_of(gltf_of_two_skeletons()), 6, 1e-6);
}

TEST_F(TwoSkeletons, MayHaveJointsWithoutNames) {
  std::string gltf = gltf_of_two_skeletons();
  for (const std::string name : {R"("name":"Hips",)", R"("name":"Hips")"})
    gltf.replace(gltf.rfind(name), name.size(), "");
  EXPECT_NEAR(width_of(gltf), 6, 1e-6);
}

// The matrix of a joint is then the identity, as it is in the file.
TEST_F(TwoSkeletons, MayLackBindMatrices) {
  std::string gltf = gltf_of_two_skeletons();
  const std::string matrices = R"(,"inverseBindMatrices":2)";
  for (int skin = 0; skin < 2; ++skin) gltf.erase(gltf.find(matrices), matrices.size());
  EXPECT_NEAR(width_of(gltf), 6, 1e-6);
}

TEST_F(TwoSkeletons, KeepTheNameOfTheFirst) {
  support::write_bytes(folder_ / "two.gltf", gltf_of_two_skeletons());
  std::string names;
  for (const character::Node& node : load_character(folder_ / "two.gltf", {}, "here").character.nodes)
    names += node.name + " ";
  EXPECT_EQ(names, "ROOT Hips Hips_1 a b ");
}

}  // namespace
}  // namespace weft::assets
