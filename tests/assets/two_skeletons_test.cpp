// Characters of glTF files whose joints do not have names of their own.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "assets/small_files.hpp"
#include "film/assets/character_file.hpp"
#include "film/character/pose.hpp"
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

TEST_F(TwoSkeletons, MayShareAMesh) {
  EXPECT_NEAR(width_of(support::replaced(gltf_of_two_skeletons(), R"("mesh":1)", R"("mesh":0)")), 6, 1e-6);
}

// The matrix of a joint is then the identity, as it is in the file.
TEST_F(TwoSkeletons, MayLackBindMatrices) {
  std::string gltf = gltf_of_two_skeletons();
  const std::string matrices = R"(,"inverseBindMatrices":2)";
  for (int skin = 0; skin < 2; ++skin) gltf = support::replaced(gltf, matrices, "");
  EXPECT_NEAR(width_of(gltf), 6, 1e-6);
}

TEST_F(TwoSkeletons, KeepTheNameOfTheFirst) {
  support::write_bytes(folder_ / "two.gltf", gltf_of_two_skeletons());
  std::string names;
  for (const character::Node& node : load_character(folder_ / "two.gltf", {}, "here").character.nodes)
    names += node.name + " ";
  EXPECT_EQ(names, "ROOT Hips Hips_1 a b ");
}

// Two nodes with meshes move by 1 m along x in a second, as the wheels of a car do.
TEST_F(TwoSkeletons, MayBeReplacedByAnimatedNodesWithEqualNames) {
  std::string gltf = gltf_of_two_skeletons();
  gltf = support::replaced(gltf, R"("name":"a","mesh":0,"skin":0)", R"("name":"wheel","mesh":0)");
  gltf = support::replaced(gltf, R"("name":"b","mesh":1,"skin":1)", R"("name":"wheel","mesh":1)");
  gltf.resize(gltf.rfind("]}"));
  gltf += R"(,{"bufferView":1,"byteOffset":12,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]},
{"bufferView":0,"componentType":5126,"count":2,"type":"VEC3"}],
"animations":[{"samplers":[{"input":4,"output":5}],"channels":[
{"sampler":0,"target":{"node":2,"path":"translation"}},{"sampler":0,"target":{"node":3,"path":"translation"}}]}]})";
  support::write_bytes(folder_ / "wheels.gltf", gltf);
  const LoadedCharacter loaded = load_character(folder_ / "wheels.gltf", {}, "here");
  const character::Character& body = loaded.character;
  ASSERT_EQ(body.clips.size(), 1U);
  std::vector<Vec3> end(body.mesh.positions.size());
  character::skin(body, character::pose_at(body, body.clips[0], 1), end);
  ASSERT_EQ(end.size(), 6U);
  EXPECT_NEAR(mesh::bounding_box(end).min().x(), 1, 1e-6) << "both have moved";
}

}  // namespace
}  // namespace weft::assets
