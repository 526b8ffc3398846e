// A body and its clothes from one file.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "environment/rod_scene.hpp"
#include "film/environment/environment.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::environment {
namespace {

// Tolerance for coordinates of a few metres from single-precision files [m].
constexpr double kSingle = 1e-6;

class SameFile : public RodScene {
 protected:
  static std::string rod_with_dress() {
    std::string file = support::rod_file();
    file.insert(
        file.find(" Mesh Rod"),
        " Frame Dress { FrameTransformMatrix { 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.2,0.0,1.0;; }\n"
        "  Mesh Cloth { 3; -0.3;0.5;0.2;, 0.3;0.5;0.2;, 0.0;1.5;0.2;; 1; 3;0,1,2;; } }\n");
    return file;
  }
};

// Faces of an inner shell face the shell around it. They must not affect which side of the outer shell is outside.
TEST_F(SameFile, MakesEachShellALimbOfItsOwn) {
  support::write_bytes(file_.path, rod_with_dress());
  const Actor actor = make();
  const std::vector<Index> shells = mesh::components(actor.mesh.topology.triangles, actor.mesh.positions.size());
  ASSERT_GT(*std::ranges::max_element(shells), 0);
  for (std::size_t v = 0; v < shells.size(); ++v)
    for (std::size_t w = 0; w < shells.size(); ++w)
      EXPECT_TRUE(shells[v] == shells[w] || actor.limbs[v] != actor.limbs[w]);
}

TEST_F(SameFile, GivesAClothWhatTheBodyThenHasNotWhereTheBodyHadIt) {
  support::write_bytes(file_.path, rod_with_dress());
  ASSERT_EQ(make().mesh.positions.size(), 8u);
  file_.without = {"Dress"};
  EXPECT_EQ(make().mesh.positions.size(), 5u);
  file_.without = {"Drs"};
  support::expect_error(ExitCode::asset_unreadable, "without: expected names of meshes or of their nodes",
                        [&] { make(); });
  file_.without.clear();
  scene::Cloth cloth;
  cloth.name = "dress";
  cloth.shape = scene::ClothShape::mesh;
  cloth.rest = scene::ClothRest::mesh;
  cloth.file = file_.path;
  cloth.object = "Dress";
  for (const scene::UpAxis up : {scene::UpAxis::z, scene::UpAxis::y}) {
    scene_.up = up;
    scene_.cloths.clear();
    const std::vector<Vec3> whole = make().mesh.positions;
    scene_.cloths.push_back(cloth);
    EXPECT_EQ(make().mesh.positions.size(), 5u);
    Wearers wearers(scene_);
    const model::Cloth dress = make_cloth(scene_, cloth, wearers).cloth;
    ASSERT_EQ(dress.start.size(), 3u);
    for (const Vec3& x : dress.start)
      EXPECT_TRUE(std::ranges::any_of(whole, [&](const Vec3& y) { return (x - y).norm() < kSingle; })) << x.transpose();
  }
}

TEST_F(SameFile, PutsAClothOnTheFloorWithItsBody) {
  support::write_bytes(file_.path, support::replaced(rod_with_dress(), "0.0,0.0,0.0,1.0;; }", "0.0,-1.0,0.0,1.0;; }"));
  const std::vector<Vec3> in_file = make().mesh.positions;
  support::write_bytes(folder_ / "walk.bvh", support::walk_file());
  file_.motion = folder_ / "walk.bvh";
  file_.joints = {{"Spine", std::nullopt, "Back"}};
  scene::Cloth& cloth = scene_.cloths.emplace_back();
  cloth.name = "dress";
  cloth.shape = scene::ClothShape::mesh;
  cloth.rest = scene::ClothRest::mesh;
  cloth.file = file_.path;
  cloth.object = "Dress";
  EXPECT_NEAR(mesh::bounding_box(make().mesh.positions).min().z(), 0, kSingle) << "the body alone";
  Wearers wearers(scene_);
  const model::Cloth dress = make_cloth(scene_, cloth, wearers).cloth;
  ASSERT_EQ(dress.start.size(), 3u);
  for (const Vec3& x : dress.start)
    EXPECT_TRUE(std::ranges::any_of(in_file, [&](const Vec3& y) { return (x - y - Vec3::UnitZ()).norm() < kSingle; }))
        << x.transpose();
}

}  // namespace
}  // namespace weft::environment
