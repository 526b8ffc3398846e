// Characters of a scene, from small files that the tests write.
#include "film/environment/actor.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "environment/rod_scene.hpp"
#include "film/environment/environment.hpp"
#include "physics/mesh/topology.hpp"

namespace weft::environment {
namespace {

// Tolerance for coordinates of a few metres from single-precision files [m].
constexpr double kSingle = 1e-6;

/// Indices of the vertices at the ends of the rod, at x = -0.1. The reader reverses faces, which changes the order of
/// vertices.
constexpr std::size_t kLow = 2, kHigh = 3;

class Acting : public RodScene {
 protected:
  void SetUp() override {
    RodScene::SetUp();
    scene_.time.duration = 2;
    character_.line = 7;
    character_.column = 1;
  }

  static std::vector<Vec3> at(const Actor& actor, double t) {
    std::vector<Vec3> positions(actor.mesh.positions.size());
    actor.keys.at(t, positions);
    return positions;
  }
  void expect_refused(ExitCode code, const std::string& words) {
    support::expect_error(code, words, [&] { make(); });
  }
};

TEST_F(Acting, TurnsTheFileUpScalesItAndPutsItInItsPlace) {
  character_.scale = 0.5;
  character_.pose.position = {10, 0, 0};
  character_.pose.rotation = Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ());
  const Actor actor = make();
  EXPECT_TRUE(actor.warnings.empty());
  // y of the file points up; x of the file is rotated by 90° about z, and points along y.
  EXPECT_LT((at(actor, 0)[kLow] - Vec3(10, -0.05, 0)).norm(), kSingle);
  EXPECT_LT((at(actor, 0)[kHigh] - Vec3(10, -0.05, 1)).norm(), kSingle);
  EXPECT_EQ(actor.mesh.positions, at(actor, 0));
  scene_.up = scene::UpAxis::y;
  EXPECT_LT((at(make(), 0)[kLow] - Vec3(10, -0.05, 0)).norm(), kSingle);
  EXPECT_LT((at(make(), 0)[kHigh] - Vec3(9, -0.05, 0)).norm(), kSingle);
}

TEST_F(Acting, PlaysTheClipThatItsSceneNamesAfterDressing) {
  character_.dressing = 0.5;
  // X files are left-handed: the reader mirrors z. Turning y of the file up then turns z of the file to +y.
  const Actor walking = make();
  EXPECT_LT((at(walking, 0.4)[0] - at(walking, 0)[0]).norm(), kSingle);
  EXPECT_NEAR((at(walking, 1.5)[0] - at(walking, 0)[0]).norm(), 2, 1e-5);
  file_.clip = "Wave";
  const Actor waving = make();
  EXPECT_LT((at(waving, 1.5)[kLow] - at(waving, 0)[kLow]).norm(), kSingle);
  EXPECT_NEAR((at(waving, 1.5)[kHigh] - at(waving, 0)[kHigh]).norm(), 1, 1e-5);
}

TEST_F(Acting, GrowsFromItsBonesWhileItIsDressedAndThenMoves) {
  scene_.time.preroll = 1;
  character_.dressing = 0.8;
  const Actor whole = make();
  character_.grow = 0.5;
  const Actor growing = make();
  // The bone runs from the hips, at the origin, along y of the file to the spine and beyond it.
  const Vec3 low = at(whole, -1)[kLow], on_bone(0, 0, 0);
  EXPECT_LT((at(growing, -1)[kLow] - (on_bone + 0.1 * (low - on_bone))).norm(), kSingle);
  EXPECT_LT((at(growing, -0.75)[kLow] - (on_bone + 0.55 * (low - on_bone))).norm(), 1e-4) << "half, between keys";
  // Tolerance 0.02 m: the two motions have keys at different times, so their splines differ near the start of the
  // motion, whose speed is 2 m/s.
  for (const double t : {-0.5, -0.2, 0.5, 1.7})
    EXPECT_LT((at(growing, t)[kLow] - at(whole, t)[kLow]).norm(), 0.02) << t;
  for (const double t : {-0.5, -0.3}) EXPECT_LT((at(growing, t)[kLow] - low).norm(), 1e-3) << t;
}

TEST_F(Acting, LoopsAClipWithItsTravel) {
  file_.loop = true;
  scene_.time.duration = 6;
  const Actor actor = make();
  EXPECT_TRUE(actor.warnings.empty());
  EXPECT_NEAR((at(actor, 5.5)[0] - at(actor, 0)[0]).norm(), 11, 1e-5);
}

TEST_F(Acting, WarnsOfALoopThatDoesNotClose) {
  file_.loop = true;
  file_.clip = "Wave";
  const Actor actor = make();
  ASSERT_EQ(actor.warnings.size(), 0u) << "moving along is the clip's way";
  support::write_bytes(file_.path,  // moves up by 0.5 m
                       support::replaced(support::rod_file(), "10;3;1.0,1.0,0.0", "10;3;0.0,1.5,0.0"));
  ASSERT_EQ(make().warnings.size(), 1u);
  EXPECT_NE(make().warnings[0].find("clip \"Wave\" does not close: its end and its beginning are 0.5 m apart"),
            std::string::npos);
}

TEST_F(Acting, StoresAsManyKeysAsThePlanSays) {
  character_.source = file_;
  character_.keys_per_second = 30;
  // There are keys at 0, 1/30, ..., 2 s, and one after the end of the motion.
  const KeyFrameCount count = count_key_frames(scene_, (make(), character_));
  EXPECT_EQ(count.keys, 62u);
  EXPECT_EQ(count.vertices, 5u);
  EXPECT_EQ(count.bytes, make().keys.bytes());
  character_.dressing = 1.5;
  EXPECT_EQ(count_key_frames(scene_, (make(), character_)).bytes, make().keys.bytes());
  character_.dressing = 3;
  EXPECT_EQ(count_key_frames(scene_, (make(), character_)).keys, 1u) << "it never moves";
  EXPECT_FALSE(make().keys.is_moving());
}

scene::BodyPart part(const std::string& name) {
  scene::BodyPart part;
  part.name = name;
  return part;
}

TEST_F(Acting, KnowsPartsByJointsAndBones) {
  character_.parts = {part("spine"), part("lower"), part("Hips")};
  character_.parts[1].bone = "Hips";
  character_.parts[1].collide = false;
  const Actor actor = make(std::vector<FollowerPoints>{{"torso", {}}});
  ASSERT_EQ(actor.parts.size(), 4u);
  const auto count = [&](std::size_t p) { return std::ranges::count(actor.parts[p].vertices, 1); };
  EXPECT_EQ(count(0), 3);
  EXPECT_EQ(count(1), 5) << "with all below it";
  EXPECT_EQ(count(2), 2);
  EXPECT_EQ(count(3), 5) << "the torso, which a pin follows";
  EXPECT_FALSE(actor.parts[1].collide);
  EXPECT_TRUE(actor.parts[3].collide);
}

/// The rod, with its upper end as a hand of three fingers.
std::string hand_file() {
  const std::string still =
      "{ FrameTransformMatrix { 1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0;; } }";
  std::string text = support::replaced(support::rod_file(), "Frame Spine {", "Frame LeftHand {");
  text =
      support::replaced(text, "0.0,1.0,0.0,1.0;; } } }",
                        "0.0,1.0,0.0,1.0;; }\n Frame a " + still + " Frame b " + still + " Frame c " + still + " } }");
  text = support::replaced(text, "XSkinMeshHeader { 1; 1; 2; }", "XSkinMeshHeader { 1; 1; 4; }");
  const std::string offset = "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,-1.0,0.0,1.0;; }";
  const std::size_t skin = text.find("SkinWeights { \"Spine\"");
  text.replace(skin, text.find('}', skin) + 1 - skin,
               "SkinWeights { \"a\"; 1; 2; 1.0; " + offset + " SkinWeights { \"b\"; 1; 3; 1.0; " + offset +
                   " SkinWeights { \"c\"; 1; 4; 1.0; " + offset);
  const std::size_t wave = text.find("AnimationSet Wave");
  return text.substr(0, wave);
}

TEST_F(Acting, ExcludesHandsWithFingersFromContactUnlessTheSceneHasParts) {
  support::write_bytes(folder_ / "rod.x", hand_file());
  const Actor by_itself = make();
  ASSERT_EQ(by_itself.parts.size(), 1u);
  EXPECT_EQ(by_itself.parts[0].name, "hands");
  EXPECT_FALSE(by_itself.parts[0].collide);
  EXPECT_EQ(std::ranges::count(by_itself.parts[0].vertices, 1), 3);
  ASSERT_EQ(by_itself.warnings.size(), 1u);
  EXPECT_NE(by_itself.warnings[0].find("the hands have fingers, which would catch cloth"), std::string::npos);
  const auto counted = count_key_frames(scene_, character_).left_out;
  EXPECT_EQ(counted, (std::vector<std::pair<std::string, std::size_t>>{{"hands", 3}}));

  character_.parts = {part("left_hand")};
  const Actor as_said = make();
  ASSERT_EQ(as_said.parts.size(), 1u);
  EXPECT_TRUE(as_said.parts[0].collide);
  EXPECT_TRUE(as_said.warnings.empty());

  character_.parts.clear();
  character_.collide = false;
  EXPECT_TRUE(make().parts.empty()) << "nothing of it meets cloth";
}

// "Wave" moves Spine by 1 m within the first second, and does not move Hips.
TEST_F(Acting, CarriesWhatFollowsAPart) {
  file_.clip = "Wave";
  character_.pose.position = {10, 0, 0};
  const Vec3 place(9.8, 0.3, 1.9);
  const std::vector<FollowerPoints> following{{"Spine", {place}}, {"", {place, Vec3(10.1, 0, 0)}}, {"Hips", {place}}};
  const Actor actor = make(following);
  ASSERT_EQ(actor.mesh.positions.size(), 5u) << "followers are not drawn";
  const auto moved = [&](std::size_t follower, double t) {
    return Vec3(actor.keys.at(t, 5 + follower).position - actor.keys.at(0, 5 + follower).position);
  };
  EXPECT_LT((actor.keys.at(0, 5).position - place).norm(), kSingle);
  const Vec3 spine = at(actor, 1)[kHigh] - at(actor, 0)[kHigh];
  EXPECT_NEAR(spine.norm(), 1, 1e-5);
  EXPECT_LT((moved(0, 1) - spine).norm(), kSingle);
  EXPECT_LT((moved(1, 1) - spine).norm(), kSingle) << "the nearest skin is of Spine";
  EXPECT_LT(moved(2, 1).norm(), 0.5) << "of all of it, by the floor";
  EXPECT_LT(moved(3, 1).norm(), kSingle) << "Hips stay";
}

TEST_F(Acting, LeavesPartsOutOfContactAndClosesWhatIsLeft) {
  scene::Mannequin mannequin;
  mannequin.edge_length = 0.04;
  character_.source = mannequin;
  character_.parts = {part("arms"), part("left_upper_arm")};
  character_.parts[0].collide = false;
  const Environment environment(scene_);
  const model::Body& body = environment.model.bodies[0];
  const auto triangles = body.colliding_triangles();
  EXPECT_TRUE(mesh::inspect(triangles, body.mesh.positions.size()).border.empty());
  double low = 0, high = 0;
  for (const auto& t : triangles)
    for (const Index v : t) {
      low = std::min(low, body.mesh.positions[v].x());
      high = std::max(high, body.mesh.positions[v].x());
    }
  // The right shoulder ends 0.25 m from the middle. The left arm hangs at 45 degrees; only its upper part is kept.
  EXPECT_GT(low, -0.25);
  EXPECT_GT(high, 0.3);
  EXPECT_LT(high, 0.45);

  character_.parts = {part("all")};
  character_.parts[0].bone = "Hips";
  character_.parts[0].collide = false;
  EXPECT_FALSE(Environment(scene_).model.bodies[0].collide) << "nothing is left";
}

TEST_F(Acting, RefusesPartsThatItDoesNotHave) {
  character_.parts = {part("tail")};
  expect_refused(
      ExitCode::scene_invalid,
      "scenes/a.toml:7:1: character.rod.part.tail: expected hands, feet, arms, legs, head, torso or a joint, "
      "or a part with bone or material, got \"tail\"");
  character_.parts = {part("hands")};
  expect_refused(ExitCode::scene_invalid, "part.hands: expected a part with vertices of ");
  character_.parts = {part("a")};
  character_.parts[0].bone = "Spin";
  expect_refused(ExitCode::scene_invalid, "got \"Spin\"; did you mean \"Spine\"?");
  character_.parts[0].bone.reset();
  character_.parts[0].material = "Skin";
  expect_refused(ExitCode::scene_invalid, "part.a.material: expected a material of ");
}

TEST_F(Acting, RefusesWhatItCannotPlayByItsName) {
  file_.clip = "Wavy";
  expect_refused(ExitCode::scene_invalid, "scenes/a.toml:7:1: character.rod.clip: expected one of the 2 clips of " +
                                              file_.path.string() +
                                              ", \"Walk\", \"Wave\", got \"Wavy\"; did you mean \"Wave\"?");
  file_.clip.reset();
  character_.start = 2.5;
  expect_refused(ExitCode::scene_invalid,
                 "character.rod.start: expected a time of clip \"Walk\", at most 2 s, got 2.5");
  character_.start = 0;
  character_.scale = 1e6;
  expect_refused(ExitCode::asset_unreadable, "expected coordinates below 1e+06 m, got (");
  character_.scale.reset();
  file_.path = folder_ / "none.obj";
  support::write_bytes(file_.path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  file_.clip = "Walk";
  expect_refused(ExitCode::scene_invalid, "character.rod.clip: expected an animation in " + file_.path.string());
}

TEST_F(Acting, TakesOverTheMotionOfAnotherFileByTheNamesThatTheSceneGives) {
  support::write_bytes(folder_ / "walk.bvh", support::walk_file());
  file_.motion = folder_ / "walk.bvh";
  file_.joints = {{"Spine", std::nullopt, "Back"}};
  const Actor actor = make();
  EXPECT_TRUE(actor.warnings.empty());
  EXPECT_LT((at(actor, 0)[4] - Vec3(0.1, 0, 2)).norm(), kSingle);
  // Expected: 3 m / 5 forward (-y), as the body is a fifth of the motion; above its middle, it is bent to the side.
  const auto x = at(actor, 1);
  EXPECT_LT((x[1] - Vec3(0.1, -0.6, 0)).norm(), kSingle);
  EXPECT_LT((x[4] - Vec3(-1, -0.6, 1.1)).norm(), kSingle);

  file_.joints[0].name = "spine";
  EXPECT_TRUE(make().warnings.empty()) << "names of joints may be written as `follow` takes them";
  file_.joints[0] = {"Spine", std::nullopt, "Bak"};
  expect_refused(ExitCode::scene_invalid, "character.rod.joint.Spine: expected the name of a node of " +
                                              file_.motion->string() + ", got \"Bak\"; did you mean \"Back\"?");
  file_.joints[0] = {"Spin", std::nullopt, "Back"};
  expect_refused(ExitCode::scene_invalid, "RightToes), got \"Spin\"; did you mean \"Spine\"?");
  file_.joints.clear();
  ASSERT_EQ(make().warnings.size(), 1u);
  EXPECT_NE(make().warnings[0].find("nothing that moves Spine"), std::string::npos);
}

TEST_F(Acting, PutsABodyWhoseOriginIsInItsMiddleOnTheFloor) {
  support::write_bytes(file_.path,
                       support::replaced(support::rod_file(), "0.0,0.0,0.0,1.0;; }", "0.0,-1.0,0.0,1.0;; }"));
  support::write_bytes(folder_ / "walk.bvh", support::walk_file());
  file_.motion = folder_ / "walk.bvh";
  file_.joints = {{"Spine", std::nullopt, "Back"}};
  const Actor actor = make();
  EXPECT_NE(actor.warnings.at(0).find("its soles 1 m below its origin"), std::string::npos) << actor.warnings[0];
  EXPECT_LT((at(actor, 0)[4] - Vec3(0.1, 0, 2)).norm(), kSingle);
}

TEST_F(Acting, LeavesAMotionInPlaceOrGivesItASpeed) {
  file_.motion = folder_ / "walk.bvh";
  support::write_bytes(*file_.motion, support::walk_file());
  file_.joints = {{"Spine", std::nullopt, "Back"}};
  file_.travel = {scene::Travel::Kind::none, 0};
  const Actor still = make();
  EXPECT_LT((at(still, 1)[1] - at(still, 0)[1]).norm(), kSingle);
  file_.travel = {scene::Travel::Kind::speed, 1.5};
  character_.speed = 0.5;
  const Actor slides = make();
  ASSERT_EQ(slides.warnings.size(), 1u);
  EXPECT_NE(slides.warnings[0].find("takes no steps: feet slide at 1.5 m/s"), std::string::npos) << slides.warnings[0];
  EXPECT_NEAR((at(slides, 1)[1] - at(slides, 0)[1]).norm(), 1.5, 1e-3);
}

TEST_F(Acting, StandsUpAMotionWhoseFileHasZUp) {
  std::string file = support::walk_file();
  for (std::size_t at = 0; (at = file.find("OFFSET 0 5 0", at)) != std::string::npos; ++at)
    file.replace(at, 12, "OFFSET 0 0 5");
  file.replace(file.find("90 0 0\n"), 6, "0 0 90");
  support::write_bytes(folder_ / "walk.bvh", file);
  file_.motion = folder_ / "walk.bvh";
  file_.joints = {{"Spine", std::nullopt, "Back"}};
  const Actor actor = make();
  ASSERT_EQ(actor.warnings.size(), 1u);
  EXPECT_NE(actor.warnings[0].find("bodies stand along z, which is taken to be up"), std::string::npos);
  EXPECT_LT((at(actor, 0)[4] - Vec3(0.1, 0, 2)).norm(), kSingle);
  file_.motion_up = scene::FileUp::z;
  EXPECT_TRUE(make().warnings.empty());
  EXPECT_EQ(make().keys.bytes(), actor.keys.bytes());
}

TEST_F(Acting, WarnsOfSizesAndSpeedsThatNobodyHas) {
  file_.motion = folder_ / "walk.bvh";
  file_.joints = {{"Spine", std::nullopt, "Back"}};
  support::write_bytes(folder_ / "walk.bvh", support::replaced(support::walk_file(), "0 0 3 ", "0 0 90 "));
  const Actor actor = make();
  ASSERT_EQ(actor.warnings.size(), 1u);
  EXPECT_NE(actor.warnings[0].find("it moves at up to 18 m/s; people who run reach 9 m/s"), std::string::npos)
      << actor.warnings[0];

  // "Wave" moves Spine at 12 m/s, and with it 3 of the 5 vertices of the body. Cloth that is pinned to Spine does not
  // count.
  file_ = {};
  file_.path = folder_ / "rod.x";
  file_.clip = "Wave";
  character_.speed = 12;
  character_.keys_per_second = 120;
  const std::vector<FollowerPoints> following{{"Spine", std::vector<Vec3>(95, Vec3(0, 0, 1.9))}};
  EXPECT_TRUE(make(following).warnings.empty());

  character_.speed = 1;
  file_ = {};
  file_.path = folder_ / "tall.obj";
  support::write_bytes(file_.path, "v 0 0 0\nv 1 0 0\nv 0 170 0\nf 1 2 3\n");
  const std::string tall = make().warnings.at(0);
  EXPECT_NE(tall.find("tall.obj is 170 m tall, where 0.3 to 3 m are expected"), std::string::npos) << tall;
  EXPECT_NE(tall.find("with scale = 0.01 it is 1.7 m"), std::string::npos) << tall;
  character_.scale = 0.05;
  EXPECT_TRUE(make().warnings.empty());
  character_.scale = 0.5;
  EXPECT_EQ(make().warnings.size(), 1u);
}

TEST_F(Acting, WarnsOfABodyThatMissesTheFloor) {
  scene_.obstacles.emplace_back();
  scene_.obstacles[0].shape = scene::Plane{};
  const auto warning = [&](double height) {
    character_.pose.position = {0, 0, height};
    const std::vector<std::string> warnings = make().warnings;
    return warnings.empty() ? std::string() : warnings[0];
  };
  for (const double height : {0.0, -0.04, 0.04}) EXPECT_EQ(warning(height), "") << height;
  EXPECT_EQ(
      warning(-0.3),
      "scenes/a.toml:7:1: character.rod: its lowest point is 0.3 m below the floor in half of its motion or more; "
      "position puts it higher");
  const std::string above =
      "scenes/a.toml:7:1: character.rod: it comes no nearer to the floor than 0.3 m; position puts it lower";
  EXPECT_EQ(warning(0.3), above);
  // There is no warning: the character may stand on an obstacle, and below a moving floor there may be other obstacles.
  scene_.obstacles.emplace_back();
  scene_.obstacles[1].shape = scene::BoxShape{};
  EXPECT_EQ(warning(0.3), "");
  scene_.obstacles.pop_back();
  scene_.obstacles[0].motion.keys.emplace_back();
  EXPECT_EQ(warning(-0.3), "");
}

std::string triangle(double height) {
  return fmt::format("v 0 {0} 0\nv 1 {0} 0\nv 0 {0} 1\nf 1 2 3\n", height);
}

TEST_F(Acting, PlaysMeshFilesOneAfterTheOther) {
  for (int k = 0; k < 11; ++k) support::write_bytes(folder_ / fmt::format("f{}.obj", k), triangle(k * k / 100.0));
  character_.source = scene::MeshSequence{(folder_ / "f*.obj").string(), 10};
  scene_.time.duration = 1;
  for (const auto interpolation : {scene::Interpolation::linear, scene::Interpolation::cubic}) {
    character_.interpolation = interpolation;
    const Actor actor = make_actor(scene_, character_);
    for (int k = 0; k < 11; ++k) EXPECT_NEAR(at(actor, k / 10.0)[0].z(), k * k / 100.0, kSingle) << k;
  }
  support::write_bytes(folder_ / "f4.obj", "v 0 0.16 0\nv 1 0.16 0\nv 0 0.16 1\nf\t1 3 2\n");
  support::expect_error(ExitCode::asset_unreadable,
                        (folder_ / "f4.obj").string() +
                            ": expected faces over the same vertices as in the first file of the sequence, got others",
                        [&] { make_actor(scene_, character_); });
  support::write_bytes(folder_ / "f4.obj", triangle(0.16) + "f 1 2 3\n");
  support::expect_error(ExitCode::asset_unreadable, "f4.obj: expected 3 vertices, as in the first file",
                        [&] { make_actor(scene_, character_); });
}

TEST_F(Acting, DressingBeginsWithThePreroll) {
  character_.dressing = 0.75;
  character_.blend = 0.5;
  character_.keys_per_second = 100;
  const Actor late = make();
  scene_.time.preroll = 0.48;  // twelve frames
  const Actor shown = make();
  for (const double t : {0.2, 0.5, 0.9, 1.3})
    EXPECT_LT((at(shown, t)[kHigh] - at(late, t + 0.48)[kHigh]).norm(), 1e-3)
        << t;  // tolerance: the keys are at different times
  EXPECT_EQ(at(shown, -0.48), at(shown, 0.2));
  EXPECT_GT((at(shown, 1.3)[kHigh] - at(shown, 0)[kHigh]).norm(), 0.5);
}

TEST_F(Acting, MannequinWalksAndStandsUprightWhicheverAxisIsUp) {
  character_.source = scene::Mannequin{{}, 1.7, 1, 0, 0.06, 1.5, 1.2, false, 13};
  scene_.time.duration = 3;
  const Actor z_up = make_actor(scene_, character_);
  scene_.up = scene::UpAxis::y;
  const Actor y_up = make_actor(scene_, character_);
  for (const double t : {0.0, 1.1, 3.0}) {
    const std::vector<Vec3> a = at(z_up, t), b = at(y_up, t);
    for (std::size_t v = 0; v < a.size(); ++v)
      ASSERT_LT((Vec3(a[v].x(), a[v].z(), -a[v].y()) - b[v]).norm(), 1e-12) << v;
  }
  const auto top = [&](double t) {
    const std::vector<Vec3> x = at(z_up, t);
    return *std::ranges::max_element(x, {}, [](const Vec3& p) { return p.z(); });
  };
  EXPECT_NEAR(top(0).z(), 1.7, 0.06);  // [m]; it stands with slightly bent knees
  EXPECT_NEAR(top(3).y() - top(0).y(), -1.5, 0.05);
}

TEST_F(Acting, CharactersOfASceneMoveAsBodiesAfterItsObstacles) {
  scene_.obstacles.emplace_back();
  scene_.obstacles[0].name = "ball";
  character_.friction = 0.9;
  character_.source = file_;
  const Environment environment(scene_);
  ASSERT_EQ(environment.model.bodies.size(), 2u);
  const model::Body& body = environment.model.bodies[1];
  EXPECT_EQ(body.name, "rod");
  EXPECT_TRUE(body.deforms() && body.may_move && body.collide);
  EXPECT_EQ(body.friction, 0.9);
  std::vector<Vec3> start(body.mesh.positions.size()), later = start;
  environment.model.place(1, 0, start);
  environment.model.place(1, 1, later);
  EXPECT_EQ(start, body.mesh.positions);
  EXPECT_NEAR((later[0] - start[0]).norm(), 2, 1e-5);
  EXPECT_NEAR(environment.model.vertex(1, 0, 1).velocity.norm(), 2, 1e-4);
}

}  // namespace
}  // namespace weft::environment
