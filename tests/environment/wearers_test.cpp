// Bodies of characters as wearers of garments.
#include "film/environment/wearers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "film/environment/environment.hpp"
#include "film/environment/made_cloth.hpp"
#include "film/garment/fit.hpp"
#include "physics/mesh/geometry.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::environment {
namespace {

class WearerBodies : public support::TestFolder {};

/// A scene with the mannequin at rest. `more`: further keys of the character.
scene::Scene scene_of_mannequin(const std::string& more = {}) {
  return support::scene_of_text(
      "[[character]]\nname = 'model'\nsource = 'mannequin'\nedge_length = 0.05\nstance = 'rest'\nblend = 1\n" + more);
}

std::string matrix(const std::string& translation) {
  return "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0," + translation + ",1.0;;";
}

std::string frame_of(const std::string& name, const std::string& translation, const std::string& below) {
  return "Frame " + name + " { FrameTransformMatrix { " + matrix(translation) + " }\n" + below + " }\n";
}

// ASCII X file of two arms in a T-pose, with skin only at the forearms. The elbows are at x = ±0.5 m.
std::string arms_without_hands() {
  const std::string arms = frame_of("LeftUpperArm", "0.2,1.4,0.0", frame_of("LeftLowerArm", "0.3,0.0,0.0", "")) +
                           frame_of("RightUpperArm", "-0.2,1.4,0.0", frame_of("RightLowerArm", "-0.3,0.0,0.0", "")) +
                           "Mesh Arms { 8; 0.6;1.3;0.0;, 0.6;1.5;0.0;, 0.8;1.5;0.0;, 0.8;1.3;0.0;,\n"
                           " -0.6;1.3;0.0;, -0.6;1.5;0.0;, -0.8;1.5;0.0;, -0.8;1.3;0.0;;\n"
                           " 4; 3;0,1,2;, 3;0,2,3;, 3;4,6,5;, 3;4,7,6;;\n"
                           " XSkinMeshHeader { 1; 1; 2; }\n"
                           " SkinWeights { \"LeftLowerArm\"; 4; 0,1,2,3; 1.0,1.0,1.0,1.0; " +
                           matrix("-0.5,-1.4,0.0") +
                           " }\n SkinWeights { \"RightLowerArm\"; 4; 4,5,6,7; 1.0,1.0,1.0,1.0; " +
                           matrix("0.5,-1.4,0.0") + " } }\n";
  return "xof 0303txt 0032\n" + frame_of("Root", "0.0,0.0,0.0", arms);
}

TEST_F(WearerBodies, HaveArmsIfTheirRigLacksHands) {
  support::write_bytes(folder_ / "arms.x", arms_without_hands());
  scene::Scene scene;
  scene::CharacterFile file;
  file.path = folder_ / "arms.x";
  scene::Character& character = scene.characters.emplace_back();
  character.name = "robot";
  character.source = file;
  Wearers wearers(scene);
  const garment::Wearer& robot = wearers.of("robot", "here");
  // The floor is at the lowest vertex, 0.1 m below the arms.
  for (const auto& [arm, side] : {std::pair{robot.left_arm, 1.0}, {robot.right_arm, -1.0}}) {
    ASSERT_TRUE(arm.has_value()) << side;
    EXPECT_LT(((*arm)[1] - Vec3(side * 0.5, 0, 0.1)).norm(), 1e-6);
    EXPECT_LT(((*arm)[2] - Vec3(side * 0.7, 0, 0.1)).norm(), 1e-6);
  }
}

// The panels of the skirt start flat, and need no body without `fit`.
TEST(WearerMissing, IsSaidWithTheReasonForIt) {
  const auto make_scene = [](const std::string& pattern, const std::string& keys) {
    return support::scene_of_text("[[cloth]]\nname = 'cloth'\nshape = 'pattern'\nedge_length = 0.1\nfile = '" +
                                  std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + pattern + "'\n" + keys);
  };
  support::expect_error(ExitCode::scene_invalid,
                        "cloth.cloth: expected a [[character]] that wears the garment, as fit = true scales it to a "
                        "body; got none; add one, or leave out fit",
                        [&] { const Environment made(make_scene("skirt.toml", "fit = true\n")); });
  support::expect_error(ExitCode::scene_invalid, "as its panels start around parts of a body; got none; add one",
                        [&] { const Environment made(make_scene("shirt.toml", "")); });
}

// The patterns of scenes/patterns are drawn for a body like the mannequin: 1.75 m tall, 0.88 m around the chest and
// 0.68 m around the waist. Tolerances: sections are 10 mm apart, and the measures of the mannequin are stated to 1 cm.
TEST(MannequinAsWearer, NeedsHardlyAnyChangeOfThePatternsThatAreDrawnForIt) {
  const scene::Scene scene = support::scene_of_text(
      "[[character]]\nname = 'model'\nsource = 'mannequin'\nedge_length = 0.03\nheight = 1.75\nstance = 'rest'\nblend "
      "= 1\n");
  Wearers wearers(scene);
  const garment::Wearer& model = wearers.of("model", "here");
  for (const char* name : {"tshirt", "shirt", "jacket", "dress", "skirt", "trousers"}) {
    const std::string file = std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + name + ".toml";
    const garment::Fit fit = garment::fit(garment::load_pattern(file, "here"), model, "here");
    EXPECT_NEAR(fit.factors.x(), 1, 0.06) << name;
    EXPECT_NEAR(fit.factors.y(), 1, 0.02) << name;
    EXPECT_NEAR(fit.rise, 0, 1e-12) << name;
  }
}

// The top of the T-shirt starts 6 cm above the neck, that of the skirt 4 cm above the waist. A scale of 1.2 makes these
// distances longer by a fifth. If it were about the floor, it would lift both tops by more than 20 cm.
TEST(MannequinAsWearer, HasAScaledGarmentAtItsNeckOrWaistIfItIsFitted) {
  const scene::Scene scene = scene_of_mannequin();
  Wearers wearers(scene);
  for (const char* name : {"tshirt", "skirt"}) {
    scene::Cloth cloth;
    cloth.name = name;
    cloth.shape = scene::ClothShape::pattern;
    cloth.file = std::string(WEFT_SOURCE_DIR) + "/scenes/patterns/" + name + ".toml";
    cloth.edge_length = 0.06;
    cloth.fit = true;
    const auto top = [&] { return mesh::bounding_box(make_cloth(scene, cloth, wearers).cloth.start).max().z(); };
    const double as_drawn = top();
    cloth.scale = 1.2;
    EXPECT_NEAR(top(), as_drawn, 0.04) << name;
  }
}

// The wearer stands 2 m beside the origin and is turned, so that its left is not along x.
TEST_F(WearerBodies, AreTheMiddleOfGarmentsThatStartScaled) {
  const scene::Scene scene = scene_of_mannequin("position = [2, 0, 0]\nrotation = [0, 0, 30]\n");
  Wearers wearers(scene);
  const Eigen::Isometry3d to_own = wearers.of("model", "here").to_world.inverse();
  support::write_bytes(folder_ / "skirt.toml",
                       "[[panel]]\nname = 'around'\naround = 'torso'\nposition = [0, 0.55]\n"
                       "path = 'M -0.5 0 L 0.5 0 L 0.5 0.5 L -0.5 0.5 Z'\nedges = 'hem left waist right'\n"
                       "[[seam]]\na = 'around.left'\nb = 'around.right'\n");
  for (const bool flat : {false, true}) {
    scene::Cloth cloth;
    cloth.name = "skirt";
    cloth.shape = scene::ClothShape::pattern;
    cloth.file = flat ? std::filesystem::path(WEFT_SOURCE_DIR) / "scenes/patterns/skirt.toml" : folder_ / "skirt.toml";
    cloth.edge_length = 0.06;
    cloth.fit = flat;
    const std::vector<Vec3> as_sewn = make_cloth(scene, cloth, wearers).cloth.start;
    cloth.start_scale = {0.9, 0.95};
    const std::vector<Vec3> scaled = make_cloth(scene, cloth, wearers).cloth.start;
    ASSERT_EQ(scaled.size(), as_sewn.size());
    double error = 0;  // [m]
    for (std::size_t i = 0; i < scaled.size(); ++i)
      error = std::max(error, (to_own * scaled[i] - Vec3(0.9, 1, 0.95).cwiseProduct(to_own * as_sewn[i])).norm());
    EXPECT_LT(error, 1e-12) << flat;
  }
}

// The hips of the mannequin are 0.92 m around. Panels around the torso need a wearer without `fit` too.
TEST_F(WearerBodies, ThatAreTooNarrowForASkirtAreWarnedOfWithoutFitToo) {
  const scene::Scene scene = scene_of_mannequin();
  const std::string outline =
      "around = 'torso'\nposition = [0, 0.55]\npath = 'M -0.3 0 L 0.3 0 L 0.25 0.5 L -0.25 0.5 Z'\n"
      "edges = 'hem left waist right'\n";
  Wearers wearers(scene);
  scene::Cloth cloth;
  cloth.name = "skirt";
  cloth.shape = scene::ClothShape::pattern;
  cloth.file = folder_ / "skirt.toml";
  cloth.edge_length = 0.06;
  const auto warnings = [&](const std::string& waist) {
    support::write_bytes(cloth.file, "measures = { waist = " + waist + " }\n[[panel]]\nname = 'front'\n" + outline +
                                         "[[panel]]\nname = 'back'\nside = 'back'\n" + outline +
                                         "[[seam]]\na = 'front.left'\nb = 'back.left'\n"
                                         "[[seam]]\na = 'front.right'\nb = 'back.right'\n");
    return make_cloth(scene, cloth, wearers).details.warnings;
  };
  const std::vector<std::string> wide = warnings("0.9");
  ASSERT_EQ(wide.size(), 1U);
  EXPECT_NE(wide[0].find("its waist is 0.90 m around and the hips of its wearer 0.9"), std::string::npos) << wide[0];
  EXPECT_TRUE(warnings("0.7").empty());
}

}  // namespace
}  // namespace weft::environment
