// Tests of pins, most of which follow places on the surface of a character.
#include "physics/simulation/pins.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "physics/mesh/shapes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::simulation {
namespace {

constexpr int kFiles = 9;
constexpr double kFileRate = 20;  // mesh files per second

/// Position of a point of the body at a time [s].
using Deformation = std::function<Vec3(const Vec3&, double)>;

class PinsOnACharacter : public support::TestFolder {
 protected:
  /// A box that moves by mesh files, and a sheet 10 mm above it, of which one side is pinned to the box.
  scene::Scene scene_of(const Deformation& moved, const std::string& more = "") {
    const mesh::Mesh box = mesh::make_box(Vec3(0.6, 0.4, 0.2), 0, 1);
    for (int k = 0; k < kFiles; ++k) {
      std::string text;
      for (const Vec3& x : box.positions) {
        const Vec3 y = moved(x, k / kFileRate);
        text += fmt::format("v {} {} {}\n", y.x(), y.y(), y.z());
      }
      for (const auto& [a, b, c] : box.topology.triangles) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
      support::write_bytes(folder_ / fmt::format("body_{}.obj", k), text);
    }
    return support::scene_of_text(
        "[time]\nduration = 0.4\n[[character]]\nname = 'body'\nsource = 'sequence'\nup = 'z'\nfps = 20\nfiles = '" +
        (folder_ / "body_*.obj").string() +
        "'\n[[cloth]]\nname = 'cape'\nsize = [0.4, 0.3]\nparticles = [9, 7]\nposition = [0.03, -0.01, 1.11]\n"
        "pin = [{ low = [0, 1], high = [1, 1], follow = 'body' }]\n" +
        more);
  }
};

const Deformation kRigid = [](const Vec3& x, double t) -> Vec3 {
  const double angle = 3 * t * t;
  return Vec3(0.5 * t, 0.2 * std::sin(4 * t), 1 - t) +
         Eigen::AngleAxisd(angle, Vec3(0.48, 0.6, 0.64)).toRotationMatrix() * x;
};
const Deformation kBent = [](const Vec3& x, double t) -> Vec3 {
  return kRigid({x.x() * (1 + t), x.y(), x.z() + 0.5 * t * x.x() * x.x() + t * x.x() * x.y()}, t);
};

/// The pins of a scene, with the model to which they refer.
struct Pinned {
  model::Model model;
  Pins pins;
  explicit Pinned(const scene::Scene& scene) : model(environment::Environment(scene).model), pins(model, {0}) {}

  std::vector<integrator::HeldParticle> at(double t) const {
    std::vector<integrator::HeldParticle> held;
    pins.held_at(t, model, held);
    return held;
  }
  const Vec3& start(const integrator::HeldParticle& held) const {
    return model.cloths[0].start[held.constraint.particle];
  }
};

// If the body moves rigidly, so do the pinned particles. Tested at the key frames, where the vertices are exact.
TEST_F(PinsOnACharacter, MoveAsOneWithABodyThatDoes) {
  const Pinned pinned(scene_of(kRigid));
  ASSERT_EQ(pinned.at(0).size(), 9u);
  for (int k = 0; k < kFiles - 1; ++k)
    for (const auto& held : pinned.at(k / kFileRate)) {
      const Vec3 in_body = pinned.start(held) - kRigid(Vec3::Zero(), 0);  // the body is not rotated at time 0
      // Tolerance: files have single precision, which rounds vertices by up to 1e-7 m.
      EXPECT_LT((held.x_end - kRigid(in_body, k / kFileRate)).norm(), 1e-6) << k;
    }
}

// A pinned particle has the velocity of its place on the body, also between key frames, on a surface that stretches,
// bends and shears.
TEST_F(PinsOnACharacter, HaveTheVelocityOfTheirPlaces) {
  const Pinned pinned(scene_of(kBent));
  const double t = 0.1337, d = 1e-5;
  const auto before = pinned.at(t - d), now = pinned.at(t), after = pinned.at(t + d);
  for (std::size_t p = 0; p < now.size(); ++p) {
    const Vec3 difference = (after[p].x_end - before[p].x_end) / (2 * d);
    // Tolerance: the central difference errs by d² times a third derivative of some hundred m/s³, and by rounding,
    // 1e-16 m / d.
    EXPECT_LT((difference - now[p].v_end).norm(), 1e-7);
    EXPECT_GT(now[p].v_end.norm(), 0.5);
  }
}

// A pinned particle keeps its distance of 10 mm from a surface that bends.
TEST_F(PinsOnACharacter, KeepTheirDistanceFromTheSkin) {
  const Pinned pinned(scene_of(kBent));
  for (int k = 0; k < kFiles - 1; ++k)
    for (const auto& held : pinned.at(k / kFileRate)) {
      double min_deviation = 1;  // minimum deviation from 10 mm, over all faces [m]
      for (const auto& t : pinned.model.bodies[0].mesh.topology.triangles) {
        const auto at = [&](std::size_t c) {
          return pinned.model.vertex(0, static_cast<std::size_t>(t[c]), k / kFileRate).position;
        };
        const Vec3 n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
        min_deviation = std::min(min_deviation, std::abs(n.dot(held.x_end - at(0)) - 0.01));
      }
      EXPECT_LT(min_deviation, 1e-6) << k;
    }
}

// The body is squeezed flat along y, to a sheet of which the triangles below the pin are lines; or it begins so.
TEST_F(PinsOnACharacter, StayAtTrianglesThatCollapse) {
  for (const bool begins_flat : {false, true}) {
    model::Model model = environment::Environment(scene_of(kRigid)).model;
    std::vector<Vec3> whole(model.bodies[0].mesh.positions.size());
    for (std::size_t v = 0; v < whole.size(); ++v) whole[v] = model.vertex(0, v, 0).position;
    std::vector<Vec3> flat = whole;
    for (Vec3& x : flat) x.y() = 0;
    model.bodies[0].mover = std::make_shared<const model::Mover>(
        motion::KeyFrames(motion::Interpolation::linear, 0, 0.05, {begins_flat ? flat : whole, flat}, false));
    const Pins pins(model, {0});
    std::vector<integrator::HeldParticle> held;
    for (const double t : {0.0, 0.02, 0.05}) {
      pins.held_at(t, model, held);
      ASSERT_EQ(held.size(), 9u);
      for (const integrator::HeldParticle& particle : held) {
        const Vec3& start = model.cloths[0].start[particle.constraint.particle];
        EXPECT_LT((particle.x_end - start).norm(), begins_flat || t == 0 ? 1e-12 : 0.2) << t;
        EXPECT_TRUE(particle.v_end.allFinite()) << t;
      }
    }
  }
}

// In a run, the pinned particles follow the body, and the cloth follows them. Tested in the frames at which there is a
// key frame, where the vertices are exact.
TEST_F(PinsOnACharacter, CarryCloth) {
  const auto frames = support::run_scene(scene_of(kRigid, "[contact]\nobstacles = false\n"),
                                         {.counts_intersections = false, .keep_positions = true});
  ASSERT_EQ(frames.size(), 11u);
  const std::vector<Vec3>& start = frames[0].cloths[0];
  for (const std::size_t frame : {std::size_t{5}, std::size_t{10}}) {
    const double t = 0.04 * static_cast<double>(frame);
    const std::vector<Vec3>& x = frames[frame].cloths[0];
    for (std::size_t i = 54; i < 63; ++i) {  // the upper row
      const Vec3 in_body = start[i] - kRigid(Vec3::Zero(), 0);
      EXPECT_LT((x[i] - kRigid(in_body, t)).norm(), 1e-6) << i << ", frame " << frame;  // tolerance as above
      EXPECT_GT((x[i] - start[i]).norm(), 0.05);
    }
    // The sheet is 0.3 m long, and its threads lock at 10 %.
    for (std::size_t i = 0; i < 54; ++i)
      EXPECT_LT((x[i] - x[54 + i % 9]).norm(), 1.15 * 0.3) << i << ", frame " << frame;
  }
}

// The mannequin walks away. If two pins share a corner, the first one holds it.
TEST_F(PinsOnACharacter, FollowThePartsOfABodyWithBones) {
  const Pinned pinned(support::scene_of_text(
      "[time]\nduration = 2\n[[character]]\nname = 'body'\nsource = 'mannequin'\nedge_length = 0.05\nwalk = 1\n"
      "[[cloth]]\nname = 'cape'\nsize = [0.3, 0.3]\nparticles = 5\nposition = [0, 0.3, 1.4]\n"
      "pin = [{ low = [0, 1], high = [1, 1], follow = 'body.torso' },\n"
      "       { low = [1, 0], high = [1, 1], follow = 'body.left_hand' }]\n"));
  const auto begin = pinned.at(0), end = pinned.at(1.6);
  ASSERT_EQ(begin.size(), 9u);
  Vec3 torso = Vec3::Zero(), hand = Vec3::Zero();
  for (std::size_t p = 0; p < begin.size(); ++p) {
    // At the start, a pinned particle is where the scene puts it, up to rounding errors.
    EXPECT_LT((begin[p].x_end - pinned.start(begin[p])).norm(), 1e-12) << p;
    const bool first_pin = p < 5;
    EXPECT_EQ(begin[p].constraint.particle >= 20, first_pin) << "the upper row is of the first";
    (first_pin ? torso : hand) += (end[p].x_end - begin[p].x_end) / (first_pin ? 5 : 4);
  }
  EXPECT_LT(torso.y(), -0.05) << "it walks to where it looks";
  EXPECT_GT((hand - torso).norm(), 0.02) << "arms swing";
  const double t = 0.7137, d = 1e-5;
  const auto before = pinned.at(t - d), now = pinned.at(t), after = pinned.at(t + d);
  for (std::size_t p = 0; p < now.size(); ++p)
    EXPECT_LT(((after[p].x_end - before[p].x_end) / (2 * d) - now[p].v_end).norm(), 1e-6);
}

TEST_F(PinsOnACharacter, AreRefusedForWhatIsNoObjectOfTheScene) {
  try {
    support::scene_of_text(
        "cloth = [{ name = 'a', pin = [{ follow = 'bdy' }] }]\n"
        "character = [{ name = 'body', source = 'mannequin' }]\n");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what())
                  .find("expected the name of an obstacle or character, got \"bdy\"; did you mean body?"),
              std::string::npos)
        << error.what();
  }
}

TEST(PinStrength, IsKnownOfEveryParticle) {
  for (const char* edge : {"low = [0, 0], high = [1, 0]", "low = [0, 1], high = [1, 1]"}) {
    const scene::Scene scene = support::scene_of_text(
        fmt::format("[[cloth]]\nname = 'a'\nsize = [0.2, 0.2]\nparticles = [3, 3]\npin = [{{ {} }}]\n", edge));
    const model::Model model = environment::Environment(scene).model;
    const Pins pins(model, {0});
    int pinned = 0;
    for (Index i = 0; i < 9; ++i) pinned += pins.strength_fraction(i, 0) > 0 ? 1 : 0;
    EXPECT_EQ(pinned, 3) << edge;
  }
}

TEST(PinsThatOverlap, HoldWhatPinsBeforeThemHaveReleased) {
  const Pinned pinned(support::scene_of_text(
      "[[cloth]]\nname = 'a'\nsize = [0.2, 0.2]\nparticles = [3, 3]\npin = [\n"
      "{ low = [0, 1], high = [1, 1], release = 0.2 },\n"
      "{ low = [0, 1], high = [0.5, 1], release = 0.1 },\n"  // never holds: released before the first pin
      "{ low = [0, 1], high = [0, 1], keys = [{ time = 0.2 }, { time = 0.4, offset = [0, 0, 1] }] }]\n"));
  ASSERT_EQ(pinned.at(0.2).size(), 3u);
  for (const integrator::HeldParticle& held : pinned.at(0.2))
    EXPECT_EQ(pinned.pins.pin_of(held.constraint.particle, 0.2), 0u);
  const std::vector<integrator::HeldParticle> after = pinned.at(0.3);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_EQ(pinned.pins.pin_of(after[0].constraint.particle, 0.3), 2u);
  EXPECT_NEAR((after[0].x_end - pinned.start(after[0]) - Vec3(0, 0, 0.5)).norm(), 0, 1e-12);
}

// In double precision, 0.1 + 0.02 exceeds 0.12. If times were compared without a tolerance, pins would be released one
// step early.
TEST(PinsThatAreReleased, HoldUntilTheStepThatEndsAtTheirRelease) {
  const Pinned pinned(
      support::scene_of_text("[[cloth]]\nname = 'a'\nsize = [0.2, 0.2]\nparticles = [3, 3]\npin = [{ low = [0, 1], "
                             "high = [1, 1], release = 0.12 "
                             "}]\n"));
  ASSERT_GT(0.1 + 0.02, 0.12);
  EXPECT_EQ(pinned.at(0.1 + 0.02).size(), 3u);
  EXPECT_TRUE(pinned.pins.release_between(0.1 + 0.02, 0.14));
  EXPECT_FALSE(pinned.pins.release_between(0.1, 0.1 + 0.02));
  EXPECT_TRUE(pinned.at(0.121).empty());
}

// The pin is released at its last key, or its last key is that of a frame for which another program moves its body.
TEST(PinsThatAreReleased, HaveTheVelocityWithWhichTheyReachTheirLastKey) {
  const std::string ends = "interpolation = 'linear', keys = [{ time = 0 }, { time = 0.4, offset = [0, 0, 1] }]",
                    sheet =
                        "[[cloth]]\nname = 'a'\nsize = [0.2, 0.2]\nparticles = [3, 3]\npin = [{ low = [0, 1], high = "
                        "[1, 1], release = 1, ";
  Pinned by_keys(support::scene_of_text(sheet + ends + " }]\n"));
  Pinned by_body(support::scene_of_text(
      sheet +
      "follow = 'ball' }]\n[[obstacle]]\nname = 'ball'\nshape = 'sphere'\nradius = 0.1\nposition = [0, 0, 3]\n"
      "keys = [{ time = 0 }, { time = 0.1, position = [0, 0, 3.1] }]\n"));
  by_body.model.set_motion(
      0, {motion::Interpolation::linear, {{0, {.position = {0, 0, 3}}}, {0.4, {.position = {0, 0, 4}}}}});
  for (const Pinned* pinned : {&by_keys, &by_body}) {
    ASSERT_EQ(pinned->at(0.4).size(), 3u);
    for (const double t : {0.3, 0.4, 0.4 + 1e-14})
      for (const integrator::HeldParticle& held : pinned->at(t))
        EXPECT_LT((held.v_end - Vec3(0, 0, 2.5)).norm(), 1e-12) << t;
    for (const integrator::HeldParticle& held : pinned->at(0.41)) EXPECT_EQ(held.v_end, Vec3(0, 0, 0));
  }
}

TEST_F(PinsOnACharacter, HaveTheVelocityWithWhichItReachesItsLastKeyFrame) {
  model::Model model = environment::Environment(scene_of(kRigid)).model;
  std::vector<Vec3> begin(model.bodies[0].mesh.positions.size());
  for (std::size_t v = 0; v < begin.size(); ++v) begin[v] = model.vertex(0, v, 0).position;
  std::vector<Vec3> end = begin;
  for (Vec3& x : end) x.z() += 0.1;
  model.bodies[0].mover = std::make_shared<const model::Mover>(
      motion::KeyFrames(motion::Interpolation::linear, 0, 0.05, {begin, end}, false));
  const Pins pins(model, {0});
  std::vector<integrator::HeldParticle> held;
  pins.held_at(0.05, model, held);
  ASSERT_EQ(held.size(), 9u);
  for (const integrator::HeldParticle& particle : held) EXPECT_LT((particle.v_end - Vec3(0, 0, 2)).norm(), 1e-9);
  pins.held_at(0.06, model, held);
  for (const integrator::HeldParticle& particle : held) EXPECT_EQ(particle.v_end, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace weft::simulation
