// A valid scene after loading: the members for all keys, defaults, poses and fabrics.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "film/scene/fabrics.hpp"
#include "film/scene/following.hpp"
#include "film/scene/loader.hpp"
#include "scene/folder.hpp"

namespace weft::scene {
namespace {

Scene load_good(const std::string& text) {
  const LoadResult result = load_text(text, kFolder + "text.toml");
  EXPECT_EQ(result.describe(), "");
  return result.scene;
}

class EveryKey : public testing::Test {
 protected:
  const LoadResult result_ = load(kFolder + "every_key.toml");
  const Scene& scene_ = result_.scene;
  void SetUp() override {
    ASSERT_EQ(result_.describe(), "");
    ASSERT_EQ(scene_.cloths.size(), 3u);
    ASSERT_EQ(scene_.obstacles.size(), 9u);
    ASSERT_EQ(scene_.cameras.size(), 6u);
    ASSERT_EQ(scene_.lights.size(), 2u);
  }
};

TEST_F(EveryKey, OfTheRootFillsItsMember) {
  EXPECT_EQ(scene_.name, "every_key");
  EXPECT_EQ(scene_.file, kFolder + "every_key.toml");
  EXPECT_EQ(scene_.up, UpAxis::y);
  EXPECT_EQ(scene_.title, "Every \"key\"");
  EXPECT_EQ(scene_.frame_count(), 76);
}

TEST_F(EveryKey, OfPressureKeysFansAndAttachmentsFillsItsMember) {
  const Pressure& gauge = scene_.cloths[0].pressure;
  EXPECT_EQ(gauge.control, PressureControl::gauge);
  EXPECT_EQ(gauge.value, 31);
  EXPECT_EQ(gauge.interpolation, Interpolation::linear);
  ASSERT_EQ(gauge.keys.size(), 2u);
  EXPECT_EQ(gauge.keys[1].time, 0.6);
  EXPECT_EQ(gauge.keys[1].value, 41);  // inherited from the previous key
  EXPECT_EQ(scene_.cloths[1].pressure.control, PressureControl::air);
  EXPECT_EQ(scene_.cloths[1].pressure.value, 0.02);
  EXPECT_EQ(scene_.cloths[0].spin, Vec3(10, 20, 30));

  ASSERT_EQ(scene_.physics.keys.size(), 2u);
  EXPECT_EQ(scene_.physics.interpolation, Interpolation::linear);
  EXPECT_EQ(scene_.physics.keys[0].wind, Vec3(1, 2, 3));  // inherited from the table
  EXPECT_EQ(scene_.physics.keys[1].gravity, Vec3(0, -2, 0));
  EXPECT_EQ(scene_.physics.keys[1].wind, Vec3(3, 2, 1));

  ASSERT_EQ(scene_.fans.size(), 2u);
  EXPECT_EQ(scene_.fans[0].radius, 0.3);
  EXPECT_EQ(scene_.fans[0].angle, 33);
  EXPECT_EQ(scene_.fans[0].falloff, 0.5);
  ASSERT_EQ(scene_.fans[0].keys.size(), 2u);
  EXPECT_EQ(scene_.fans[0].keys[1].position, Vec3(1, 2, 3));
  EXPECT_EQ(scene_.fans[0].keys[1].speed, 8);
  EXPECT_EQ(scene_.fans[1].keys.front().direction, Vec3(0, 1, 0));
  EXPECT_EQ(scene_.fans[1].keys.front().speed, 3);

  ASSERT_EQ(scene_.attachments.size(), 1u);
  const Attachment& button = scene_.attachments[0];
  EXPECT_EQ(button.name, "button");
  EXPECT_EQ(button.cloth, "sheet");
  EXPECT_EQ(button.to, "napkin");
  EXPECT_EQ(button.low, Vec2(0.9, 0.9));
  EXPECT_EQ(button.stiffness, 700);
  EXPECT_EQ(button.length, 0.004);
  EXPECT_EQ(button.begin, 0.2);
  EXPECT_EQ(button.release, 2.1);
  EXPECT_EQ(button.breaking_load, 12);
}

TEST_F(EveryKey, OfTimePhysicsSolverAndContactFillsItsMember) {
  EXPECT_EQ(scene_.time.duration, 2.5);
  EXPECT_EQ(scene_.time.fps, 30);
  EXPECT_EQ(scene_.time.step, 0.004);
  EXPECT_EQ(scene_.time.integrator, Integrator::bdf2);
  EXPECT_EQ(scene_.physics.gravity, Vec3(0.1, -1.62, 0.2));
  EXPECT_EQ(scene_.physics.air_density, 1.1);
  EXPECT_EQ(scene_.physics.wind, Vec3(1, 2, 3));
  EXPECT_EQ(scene_.solver.newton_tolerance, 1e-4);
  EXPECT_EQ(scene_.solver.newton_iterations, 7);
  EXPECT_EQ(scene_.solver.linear_tolerance, 1e-5);
  EXPECT_EQ(scene_.solver.linear_iterations, 300);
  EXPECT_EQ(scene_.solver.halvings, 5);
  EXPECT_FALSE(scene_.contact.self);
  EXPECT_FALSE(scene_.contact.obstacles);
  EXPECT_EQ(scene_.contact.stiffness, 250);
  EXPECT_EQ(scene_.contact.response, Response::velocity_constraints);
  ASSERT_EQ(scene_.contact.pairs.size(), 1u);
  EXPECT_EQ(scene_.contact.pairs[0].first, "sheet");
  EXPECT_EQ(scene_.contact.pairs[0].second, "ball");
  EXPECT_EQ(scene_.contact.pairs[0].friction, 0.21);
  EXPECT_EQ(scene_.contact.pairs[0].static_friction, 0.34);
  const Search& search = scene_.contact.search;
  EXPECT_EQ(search.bounds, Bounds::dop18);
  EXPECT_EQ(search.tree, TreeKind::quad);
  EXPECT_EQ(search.leaf, 5);
  EXPECT_TRUE(search.open_longer_side);
  EXPECT_TRUE(search.separation_lists);
  EXPECT_TRUE(search.velocity_cones);
  EXPECT_TRUE(search.normal_cones);
  EXPECT_FALSE(search.reuse);
}

TEST_F(EveryKey, OfRenderFillsItsMember) {
  EXPECT_EQ(scene_.render.width, 640);
  EXPECT_EQ(scene_.render.height, 360);
  EXPECT_EQ(scene_.render.camera, "dolly");
  EXPECT_EQ(scene_.render.sky_color, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(scene_.render.ground_color, Vec3(0x33 / 255.0, 0x66 / 255.0, 0x99 / 255.0));
  EXPECT_EQ(scene_.render.sky_intensity, 0.7);
  EXPECT_EQ(scene_.render.heat, HeatQuantity::speed);
  EXPECT_EQ(scene_.render.heat_max, 4);
}

TEST_F(EveryKey, OfAClothFillsItsMember) {
  const Cloth& cloth = scene_.cloths[0];
  EXPECT_EQ(cloth.name, "sheet");
  EXPECT_EQ(cloth.size, Vec2(1.5, 2.5));
  EXPECT_EQ(cloth.particles_weft, 31);
  EXPECT_EQ(cloth.particles_warp, 51);
  EXPECT_EQ(cloth.grading, Vec2(2, 0.4));
  EXPECT_EQ(cloth.pose.position, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(cloth.velocity, Vec3(4, 5, 6));
  const Material& m = cloth.material;
  EXPECT_EQ(m.fabric, "denim");
  EXPECT_EQ(m.density, 0.31);
  EXPECT_EQ(m.stretch_weft, 1100);
  EXPECT_EQ(m.stretch_warp, 1200);
  EXPECT_EQ(m.shear, 130);
  EXPECT_EQ(m.bend, 1.4e-5);
  EXPECT_EQ(m.max_stretch, 0.077);
  EXPECT_EQ(m.max_shear, 37);
  EXPECT_EQ(m.stretch_viscosity, 0.15);
  EXPECT_EQ(m.shear_viscosity, 0.16);
  EXPECT_EQ(m.bend_viscosity, 1.7e-6);
  EXPECT_EQ(m.bend_friction, 3.7e-5);
  EXPECT_EQ(m.thickness, 0.0018);
  EXPECT_EQ(m.friction, 0.19);
  EXPECT_EQ(m.drag, 1.21);
  EXPECT_EQ(cloth.look.color, Vec3(0.11, 0.12, 0.13));
  EXPECT_EQ(cloth.look.back_color, Vec3(0.14, 0.15, 0.16));
  EXPECT_EQ(cloth.look.roughness, 0.17);
  EXPECT_EQ(cloth.look.thread_spacing, 0.018);
  EXPECT_FALSE(cloth.look.visible);
  EXPECT_EQ(scene_.cloths[1].over, std::vector<std::string>{scene_.cloths[0].name});
}

TEST_F(EveryKey, OfACharacterFillsItsMember) {
  ASSERT_EQ(scene_.characters.size(), 4u);
  const Character& character = scene_.characters[0];
  EXPECT_EQ(character.name, "dancer");
  const auto& file = std::get<CharacterFile>(character.source);
  EXPECT_EQ(file.path, kFolder + "triangle.obj");
  EXPECT_EQ(file.motion, kFolder + "triangle.obj");
  EXPECT_EQ(file.motion_up, FileUp::y);
  EXPECT_EQ(file.clip, "Walk");
  EXPECT_EQ(file.stance, Stance::rest);
  EXPECT_TRUE(file.loop);
  EXPECT_EQ(file.crossfade, 0.3);
  ASSERT_EQ(file.joints.size(), 1u);
  EXPECT_EQ(file.joints[0].name, "Hips");
  EXPECT_EQ(file.joints[0].body, "pelvis");
  EXPECT_EQ(file.joints[0].motion, "root");
  EXPECT_EQ(character.scale, 0.011);
  EXPECT_EQ(character.up, FileUp::z);
  EXPECT_EQ(character.pose.position, Vec3(0.31, 0.32, 0.33));
  EXPECT_LT((character.pose.rotation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_EQ(character.dressing, 1.25);
  EXPECT_EQ(character.blend, 0.55);
  EXPECT_EQ(character.grow, 0.75);
  EXPECT_EQ(character.clearance, 0.009);
  EXPECT_EQ(file.stance_arms, 85);
  EXPECT_EQ(character.start, 0.35);
  EXPECT_EQ(character.speed, 1.15);
  EXPECT_EQ(character.keys_per_second, 48);
  EXPECT_EQ(character.interpolation, Interpolation::linear);
  EXPECT_EQ(character.friction, 0.47);
  EXPECT_FALSE(character.collide);
  EXPECT_EQ(character.look.color, Vec3(0x10 / 255.0, 0x20 / 255.0, 0x30 / 255.0));
  const auto& sequence = std::get<MeshSequence>(scene_.characters[1].source);
  EXPECT_EQ(sequence.files, kFolder + "frames/*.obj");
  EXPECT_EQ(sequence.fps, 12);
}

TEST_F(EveryKey, OfAMannequinFillsItsMember) {
  const auto& mannequin = std::get<Mannequin>(scene_.characters.at(2).source);
  EXPECT_EQ(mannequin.height, 1.62);
  EXPECT_EQ(mannequin.girth, 1.1);
  EXPECT_EQ(mannequin.masculinity, 0.3);
  EXPECT_EQ(mannequin.edge_length, 0.03);
  EXPECT_EQ(mannequin.walk, 3.5);
  EXPECT_EQ(mannequin.pace, 0.9);
  EXPECT_TRUE(mannequin.turn_back);
  EXPECT_EQ(mannequin.arms_out, 21);
}

TEST_F(EveryKey, OfAPinFillsItsMember) {
  ASSERT_EQ(scene_.cloths[0].pins.size(), 2u);
  const Pin& following = scene_.cloths[0].pins[0];
  EXPECT_EQ(following.low, Vec2(0.1, 0.2));
  EXPECT_EQ(following.high, Vec2(0.3, 0.4));
  EXPECT_EQ(following.follow, "ball");
  EXPECT_EQ(following.release, 1.5);
  EXPECT_TRUE(following.motion.keys.empty());

  const PinTrack& motion = scene_.cloths[0].pins[1].motion;
  EXPECT_EQ(motion.interpolation, Interpolation::linear);
  EXPECT_EQ(following.strength, std::nullopt);
  EXPECT_EQ(scene_.cloths[0].pins[1].strength, 30);
  EXPECT_EQ(scene_.cloths[0].pins[1].fade, 0.07);
  EXPECT_EQ(following.mask, std::nullopt);
  EXPECT_EQ(following.panel, "");
  EXPECT_EQ(scene_.cloths.back().pins.at(0).panel, "front");
  EXPECT_EQ(scene_.cloths[0].pins[1].mask->filename(), "check.png");
  ASSERT_EQ(motion.keys.size(), 4u);
  EXPECT_EQ(motion.keys[0].time, 0.5);
  EXPECT_FALSE(motion.keys[2].in_world);
  EXPECT_TRUE(motion.keys[3].in_world);
  EXPECT_EQ(motion.keys[3].pose.position, Vec3(4, 5, 6));
  EXPECT_EQ(motion.keys[0].pose.position, Vec3(0, 0, 1));
  EXPECT_EQ(motion.keys[2].pose.position, Vec3(0, 0, 1)) << "a key holds what the one before has";
  EXPECT_EQ(motion.keys[1].pose.rotation.coeffs(), Quat(1, 0, 0, 0).coeffs());
  EXPECT_EQ(motion.keys[2].pose.rotation.coeffs(), Quat(0, 1, 0, 0).coeffs());
}

TEST_F(EveryKey, OfAnObstacleFillsItsMember) {
  const Obstacle& ball = scene_.obstacles[0];
  EXPECT_EQ(ball.name, "ball");
  EXPECT_EQ(std::get<Sphere>(ball.shape).radius, 0.21);
  EXPECT_EQ(ball.segments, 33);
  EXPECT_EQ(ball.pose.position, Vec3(1, 2, 3));
  EXPECT_EQ(ball.friction, 0.44);
  EXPECT_FALSE(ball.collide);
  EXPECT_EQ(ball.look.color, Vec3(0, 0, 0));
  EXPECT_EQ(ball.look.roughness, 0.05);
  EXPECT_TRUE(ball.look.checker);
  EXPECT_FALSE(ball.look.visible);
  EXPECT_EQ(ball.motion.interpolation, Interpolation::linear);
  ASSERT_EQ(ball.motion.keys.size(), 2u);
  EXPECT_EQ(ball.motion.keys[0].time, 0.25);
  EXPECT_EQ(ball.motion.keys[0].pose.position, Vec3(1, 2, 3)) << "the first key holds what the obstacle has";
  EXPECT_EQ(ball.motion.keys[1].pose.position, Vec3(4, 5, 6));
}

TEST_F(EveryKey, OfAnObstacleThatFollowsFillsItsMember) {
  const Obstacle& lid = scene_.obstacles[8];
  EXPECT_EQ(lid.follow, "ball");
  EXPECT_TRUE(has_prescribed_motion(scene_, lid)) << "as the ball does";
  EXPECT_FALSE(has_prescribed_motion(scene_, scene_.obstacles[1]));
  EXPECT_EQ(lid.look.image->filename(), "check.png");
  EXPECT_EQ(lid.look.tile_width, 0.23);
  EXPECT_EQ(lid.look.metal, 0.7);
  EXPECT_EQ(lid.look.gloss, 0.8);
}

TEST_F(EveryKey, OfEachShapeFillsItsMember) {
  const auto shape = [&](std::size_t i) -> const Shape& { return scene_.obstacles[i].shape; };
  EXPECT_EQ(std::get<BoxShape>(shape(1)).size, Vec3(1.1, 1.2, 1.3));
  EXPECT_EQ(std::get<BoxShape>(shape(1)).bevel, 0.02);
  EXPECT_EQ(std::get<Cone>(shape(2)).radius, 0.61);
  EXPECT_EQ(std::get<Cone>(shape(2)).height, 0.62);
  EXPECT_EQ(std::get<Torus>(shape(3)).radius, 0.71);
  EXPECT_EQ(std::get<Torus>(shape(3)).tube_radius, 0.072);
  EXPECT_EQ(std::get<Cylinder>(shape(4)).radius, 0.081);
  EXPECT_EQ(std::get<Cylinder>(shape(4)).height, 2.82);
  EXPECT_EQ(std::get<HalfPipe>(shape(5)).radius, 1.91);
  EXPECT_EQ(std::get<HalfPipe>(shape(5)).length, 3.92);
  EXPECT_EQ(std::get<HalfPipe>(shape(5)).thickness, 0.093);
  EXPECT_EQ(std::get<Plane>(shape(6)).size, Vec2(7, 8));
  EXPECT_FALSE(std::get<Plane>(shape(6)).infinite);
  EXPECT_EQ(std::get<MeshFile>(shape(7)).path, kFolder + "triangle.obj");
  EXPECT_EQ(std::get<MeshFile>(shape(7)).scale, 0.01);
  EXPECT_EQ(scene_.obstacles[7].line, 188) << "where the scene names its file";
  EXPECT_EQ(scene_.obstacles[7].column, 8);
}

TEST_F(EveryKey, OfPicturesFillsItsMemberAndPanelsHaveWhatTheyDoNotSayFromTheCloth) {
  const Look& look = scene_.cloths.back().look;
  EXPECT_EQ(look.image->filename(), "check.png");
  EXPECT_TRUE(look.image->is_absolute());
  EXPECT_EQ(look.image_width, 0.19);
  EXPECT_EQ(look.image_offset, Vec2(0.01, -0.02));
  EXPECT_EQ(look.image_rotation, 45);
  EXPECT_FALSE(look.image_repeat);
  EXPECT_TRUE(look.cutout);
  ASSERT_EQ(look.panels.size(), 1u);
  const PanelPaint& front = look.panels[0];
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(front.color, Vec3(0.2, 0.3, 0.4));
  EXPECT_EQ(front.image, look.image);
  EXPECT_EQ(front.image_width, 0.21);
  EXPECT_EQ(front.image_rotation, 45);
  EXPECT_FALSE(scene_.characters[0].look.as_file) << "a color that is given counts";
  EXPECT_TRUE(scene_.characters[1].look.as_file);
  EXPECT_TRUE(scene_.characters.back().look.as_file);
}

TEST_F(EveryKey, OfCamerasAndLightsFillsItsMember) {
  const Camera& still = scene_.cameras[0];
  ASSERT_EQ(still.keys.size(), 1u);
  EXPECT_EQ(still.keys[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(still.keys[0].target, Vec3(4, 5, 6));
  EXPECT_EQ(still.keys[0].field_of_view, 28);
  const Camera& dolly = scene_.cameras[1];
  EXPECT_EQ(dolly.interpolation, Interpolation::linear);
  ASSERT_EQ(dolly.keys.size(), 2u);
  EXPECT_EQ(dolly.keys[0].target, Vec3(0, 1, 0));
  EXPECT_EQ(dolly.keys[1].time, 2);
  EXPECT_EQ(dolly.keys[1].position, Vec3(6, 0, 0));
  EXPECT_EQ(dolly.keys[1].target, Vec3(0, 2, 0));
  EXPECT_EQ(dolly.keys[1].field_of_view, 40);
  const Camera& stalker = scene_.cameras[2];
  EXPECT_EQ(stalker.kind, CameraKind::follow);
  EXPECT_EQ(stalker.subjects, (std::vector<std::string>{"walker", "dress"}));
  EXPECT_EQ(stalker.azimuth, -20);
  EXPECT_EQ(stalker.elevation, 5);
  EXPECT_EQ(stalker.orbit, 12);
  EXPECT_EQ(stalker.keys[0].field_of_view, 26);
  EXPECT_EQ(stalker.margin, 0.2);
  EXPECT_EQ(stalker.smoothing, 0.8);
  const Camera& guard = scene_.cameras[3];
  EXPECT_EQ(guard.kind, CameraKind::track);
  EXPECT_EQ(guard.keys[0].position, Vec3(2, -3, 1));
  EXPECT_EQ(guard.keys[0].field_of_view, 0) << "to be found";
  const Camera& rider = scene_.cameras[4];
  EXPECT_EQ(rider.keys[0].focal_length, 85);
  EXPECT_EQ(rider.sensor_width, 23.6);
  EXPECT_EQ(rider.follow, "ball");
  EXPECT_FALSE(rider.follow_rotation);
  const Camera& zoom = scene_.cameras[5];
  EXPECT_EQ(zoom.keys[0].focal_length, 24);
  EXPECT_EQ(zoom.keys[1].focal_length, 85);

  const Light& sun = scene_.lights[0];
  EXPECT_FALSE(sun.spot);
  EXPECT_EQ(sun.color, Vec3(0.9, 0.8, 0.7));
  EXPECT_EQ(sun.softness, 3);
  ASSERT_EQ(sun.keys.size(), 1u);
  EXPECT_EQ(sun.keys[0].direction, Vec3(1, -2, 3));
  EXPECT_EQ(sun.keys[0].intensity, 1.5);
  const Light& lamp = scene_.lights[1];
  EXPECT_TRUE(lamp.spot);
  EXPECT_EQ(lamp.cone_angle, 60);
  ASSERT_EQ(lamp.keys.size(), 2u);
  EXPECT_EQ(lamp.keys[0].position, Vec3(7, 8, 9));
  EXPECT_EQ(lamp.keys[1].position, Vec3(8, 8, 9));
  EXPECT_EQ(lamp.keys[1].target, Vec3(1, 0, 1));
  EXPECT_EQ(lamp.keys[1].intensity, 0.5);
}

TEST(Scene, RotatesAboutTheFixedAxesInTheOrderXyz) {
  const Scene scene = load_good("cloth = [{ name = 'a', rotation = [90, 0, 90] }]\n");
  const Quat& q = scene.cloths[0].pose.rotation;
  // First, the rotation by 90° about x maps y to z and keeps x. Then, the rotation by 90° about z keeps z and maps x to
  // y. Tolerance: three products of unit quaternions, each rounded to a few 1e-16.
  EXPECT_LT((q * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((q * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
}

TEST(Scene, TakesQuaternionsOfAnyLength) {
  const Scene scene = load_good("cloth = [{ name = 'a', quaternion = [0, 0, 3, 4] }]\n");
  EXPECT_LT((scene.cloths[0].pose.rotation.coeffs() - Quat(0, 0, 0.6, 0.8).coeffs()).norm(), 1e-15);
}

TEST(Scene, TakesOneNumberForBothDirections) {
  const Scene scene =
      load_good("cloth = [{ name = 'a', size = 0.4, particles = 9, material.stretch = 700, pin = [{ low = 0.5 }] }]\n");
  EXPECT_EQ(scene.cloths[0].size, Vec2(0.4, 0.4));
  EXPECT_EQ(scene.cloths[0].particles_weft, 9);
  EXPECT_EQ(scene.cloths[0].particles_warp, 9);
  EXPECT_EQ(scene.cloths[0].material.stretch_weft, 700);
  EXPECT_EQ(scene.cloths[0].material.stretch_warp, 700);
  EXPECT_EQ(scene.cloths[0].pins[0].low, Vec2(0.5, 0.5));
}

TEST(Scene, DefaultsFollowTheUpAxisWhereverItIsWritten) {
  const std::string objects = "[[cloth]]\nname = 'a'\n[[light]]\nname = 'sun'\n";
  const Scene z = load_good(objects);
  EXPECT_EQ(z.physics.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(z.lights[0].keys[0].direction, Vec3(-0.4, -0.5, -1));
  const Scene y = load_good("up = 'y'\n" + objects);
  EXPECT_EQ(y.physics.gravity, Vec3(0, -9.81, 0));
  EXPECT_EQ(y.lights[0].keys[0].direction, Vec3(-0.4, -1, 0.5));
}

TEST(Scene, WhatHasNoColorHasATone) {
  const Scene scene = load_good(
      "[[cloth]]\nname = 'a'\n[[obstacle]]\nname = 'b'\nshape = 'box'\n[[obstacle]]\nname = 'c'\nshape = 'plane'\n");
  const Vec3 cloth = scene.cloths[0].look.color, box = scene.obstacles[0].look.color,
             floor = scene.obstacles[1].look.color;
  EXPECT_LT(floor.maxCoeff(), 0.79);  // sRGB; the floor reflects less than 0.6 of the light
  for (const Vec3& difference : {Vec3(cloth - box), Vec3(box - floor), Vec3(floor - cloth)})
    EXPECT_GT(difference.cwiseAbs().maxCoeff(), 0.08);
}

TEST(Fabrics, GiveTheNumbersThatASceneLeavesOut) {
  const Scene scene = load_good("cloth = [{ name = 'a', material = { density = 0.5, fabric = 'silk' } }]\n");
  const Material& material = scene.cloths[0].material;
  EXPECT_EQ(material.density, 0.5) << "a number of its own stands, wherever the fabric is written";
  EXPECT_EQ(material.bend, find_fabric("silk")->material.bend);
  EXPECT_EQ(material.thickness, find_fabric("silk")->material.thickness);
}

TEST(Fabrics, TheDefaultIsCotton) {
  const Material& cotton = fabrics().front().material;
  const Material none;
  EXPECT_EQ(cotton.fabric, "cotton");
  for (double Material::*figure :
       {&Material::density, &Material::stretch_weft, &Material::stretch_warp, &Material::shear, &Material::bend,
        &Material::max_stretch, &Material::max_shear, &Material::bend_viscosity, &Material::bend_friction,
        &Material::thickness, &Material::friction, &Material::drag})
    EXPECT_EQ(cotton.*figure, none.*figure);
}

TEST(Fabrics, AreMadeOfWhatWasMeasured) {
  const Fabric& poplin = *find_fabric("poplin");
  EXPECT_FALSE(poplin.measured.bend_weft.estimated);
  EXPECT_TRUE(poplin.measured.shear.estimated);
  // Measured: bending rigidity 0.118 gf·cm²/cm and hysteresis (2HB) 0.124 gf·cm/cm. Tolerance: the material has two
  // significant digits.
  EXPECT_NEAR(poplin.material.bend, 0.118 * 9.807e-5, 0.05 * 1.2e-5);
  EXPECT_NEAR(poplin.material.bend_friction, 0.5 * 0.124 * 9.807e-3, 0.05 * 6e-4);
  // A wool with a FAST extension E20 (at 19.6 N/m) of 1.87 % in both directions has a stiffness of 1048 N/m.
  const Material& wool = find_fabric("wool")->material;
  EXPECT_NEAR(std::sqrt(wool.stretch_weft * wool.stretch_warp), 1048, 0.25 * 1048);
}

TEST(Fabrics, EstimateBendingFromWeight) {
  // The estimate is 130 µN·m (density / 1 kg/m²)^1.35.
  const Measurements suiting = find_fabric("suiting")->measured, cotton = find_fabric("cotton")->measured;
  EXPECT_TRUE(cotton.bend_weft.estimated);
  EXPECT_NEAR(std::sqrt(cotton.bend_weft.value * cotton.bend_warp.value), 10.0e-6, 0.1e-6);
  EXPECT_NEAR(std::sqrt(suiting.bend_weft.value * suiting.bend_warp.value), 18.4e-6, 0.2e-6);
  EXPECT_NEAR(suiting.bend_warp.value / suiting.bend_weft.value, 1.4, 1e-12);
}

TEST(Pins, HoldTheParticlesOnTheirBoundsDespiteRounding) {
  Pin pin;
  pin.low = {0.1, 0};
  pin.high = {0.3, 1};
  EXPECT_TRUE(pin.holds(3 * 0.1, 0.5)) << "3 * 0.1 is a bit above 0.3";
  EXPECT_TRUE(pin.holds(0.1, 1));
  EXPECT_FALSE(pin.holds(0.3 + 1e-6, 0.5));
  EXPECT_FALSE(pin.holds(0.2, -1e-6));
}

}  // namespace
}  // namespace weft::scene
