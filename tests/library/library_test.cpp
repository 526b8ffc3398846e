// Compares the public interface with the program's own classes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>
#include <weft/pictures.hpp>
#include <weft/scene.hpp>
#include <weft/settings.hpp>
#include <weft/simulation.hpp>

#include "api/library/scene_data.hpp"
#include "library/scenes.hpp"
#include "support/scene_runs.hpp"
#include "support/test_folder.hpp"

namespace weft::library {
namespace {

using Points = std::vector<Vector>;

Points positions(const Frame& frame, std::string_view name = "sheet") {
  const auto span = frame.object(name).positions;
  return {span.begin(), span.end()};
}

Points advance(Simulation& simulation, int frames) {
  for (int k = 0; k < frames; ++k) simulation.advance();
  return positions(simulation.frame());
}

template <class Exception, class Action>
Exception thrown(const Action& action) {
  try {
    action();
  } catch (const Exception& exception) {
    return exception;
  }
  throw std::logic_error("nothing of this kind was thrown");
}

TEST(LibraryScene, MistakesHaveLineColumnAndKey) {
  const std::string text = "[[cloth]]\nname = \"a\"\nmaterial = { thickness = -1 }\nsizes = 3\n";
  const auto error = thrown<SceneError>([&] { Scene::parse(text, {"time.fps=-1"}, "folder/a.toml"); });
  ASSERT_EQ(error.mistakes().size(), 3u) << error.what();
  const Mistake& first = error.mistakes()[0];
  EXPECT_EQ(first.file, "folder/a.toml");
  EXPECT_EQ(first.line, 3);
  EXPECT_EQ(first.column, 26);
  EXPECT_EQ(first.key, "cloth.a.material.thickness");
  EXPECT_TRUE(first.text.starts_with("expected > 0 m")) << first.text;
  EXPECT_EQ(error.mistakes()[2].change, "time.fps=-1");
  EXPECT_TRUE(std::string(error.what()).starts_with("folder/a.toml:3:26: cloth.a.material.thickness: "));
}

TEST(LibraryScene, MistakesHaveTheWholeChangeThatCausedThem) {
  const std::string change = "time.step=\"" + std::string(200, 'x') + "\"\n";
  const auto error = thrown<SceneError>([&] { Scene::parse(kDrape, {"time.fps=50", change}); });
  ASSERT_EQ(error.mistakes().size(), 1u) << error.what();
  EXPECT_EQ(error.mistakes()[0].change, change);
  EXPECT_TRUE(std::string(error.what()).starts_with("--set time.step=\"" + std::string(60, 'x') + "...: time.step: "))
      << error.what();
}

TEST(LibraryScene, OfAMissingFileIsAnErrorWithItsName) {
  const auto error = thrown<SceneError>([] { Scene::load("missing.toml"); });
  EXPECT_EQ(error.mistakes().at(0).file, "missing.toml");
}

TEST(LibraryScene, ChangesAddUp) {
  const Scene scene = Scene::parse(kDrape, {"time.fps=50"}).with({"cloth.sheet.material.fabric=silk"});
  EXPECT_EQ(scene.fps(), 50);
  EXPECT_EQ(scene.frames(), 21);
  EXPECT_NE(scene.text().find("fabric = \"silk\""), std::string::npos) << scene.text();
  EXPECT_EQ(scene.cloths(), std::vector<std::string>{"sheet"});
  EXPECT_EQ(scene.obstacles(), std::vector<std::string>{"ball"});
}

TEST(LibraryScene, ALaterChangeReplacesAnEarlierKeyThatItExcludes) {
  const Scene exact = Scene::parse(kDrape, {"time.tolerance=1e-4"}), even = exact.with({"time.step=0.005"});
  EXPECT_EQ(even.data().scene.time.step, 0.005);
  EXPECT_EQ(even.data().scene.time.tolerance, std::nullopt);
  EXPECT_EQ(even.with({"time.tolerance=1e-3"}).data().scene.time.tolerance, 1e-3);
  EXPECT_EQ(even.with({"time.fps=50"}).data().scene.time.step, 0.005);
  EXPECT_THROW(exact.with({"time.step=0.005", "time.tolerance=1e-3"}), SceneError) << "one call gives both";
}

TEST(LibrarySimulation, HasTheBitsOfTheProgram) {
  production::SceneSimulation reference(support::scene_of_text(kDrape));
  Simulation simulation(Scene::parse(kDrape));
  for (int k = 1; k <= 10; ++k) {
    const simulation::FrameReport report = reference.advance();
    const Frame& frame = simulation.advance();
    const Object& sheet = frame.object("sheet");
    const auto state = reference.state();
    ASSERT_EQ(sheet.positions.size(), state.positions.size());
    EXPECT_EQ(std::memcmp(sheet.positions.data(), state.positions.data(), state.positions.size_bytes()), 0) << k;
    EXPECT_EQ(sheet.contact_forces.size(), sheet.positions.size());
    EXPECT_EQ(std::memcmp(sheet.velocities.data(), state.velocities.data(), state.velocities.size_bytes()), 0) << k;
    EXPECT_EQ(frame.number(), k);
    EXPECT_EQ(frame.time(), k / 25.0);
    EXPECT_EQ(frame.report().kinetic_energy, report.kinetic_energy);
    EXPECT_EQ(frame.report().near_pairs, report.proximities);
    EXPECT_EQ(frame.report().newton_iterations, report.newton_iterations);
  }
}

TEST(LibrarySimulation, FramesStayAsTheyWere) {
  Simulation simulation(Scene::parse(kDrape));
  const Frame start = simulation.frame();
  const Points before = positions(start);
  advance(simulation, 3);
  EXPECT_EQ(positions(start), before);
  EXPECT_NE(positions(simulation.frame()), before);
}

TEST(LibrarySimulation, StrainsAreThoseOfTheThreads) {
  Simulation simulation(Scene::parse(kDrape));
  advance(simulation, 8);
  const Object& sheet = simulation.frame().object("sheet");
  ASSERT_EQ(sheet.strains.size(), 256u);
  ASSERT_EQ(sheet.rest.size(), 256u);
  double largest = 0;
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 15; ++column) {
      const Vector &a = sheet.positions[16 * row + column], &b = sheet.positions[16 * row + column + 1];
      const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
      const double strain =
          std::abs(length / (sheet.rest[16 * row + column + 1][0] - sheet.rest[16 * row + column][0]) - 1);
      EXPECT_LE(strain, sheet.strains[16 * row + column] * (1 + 1e-6) + 1e-7);  // strains are float
      largest = std::max(largest, strain);
    }
  EXPECT_GT(largest, 1e-5);
}

TEST(LibrarySimulation, ContinuesWithTheSameBits) {
  const Scene scene = Scene::parse(kDrape);
  Simulation whole(scene), first(scene);
  const Points expected = advance(whole, 8);
  advance(first, 5);
  Simulation second(scene, {.driven = {}, .state = first.save()});
  EXPECT_EQ(second.frame().number(), 5);
  EXPECT_EQ(advance(second, 3), expected);
}

TEST(LibrarySimulation, RefusesAStateOfAnotherScene) {
  const Scene scene = Scene::parse(kDrape);
  const std::string state = Simulation(scene).save();
  EXPECT_THROW(Simulation(scene.with({"time.step=0.005"}), {.driven = {}, .state = state}), std::invalid_argument);
  EXPECT_THROW(Simulation(scene, {.driven = {}, .state = state.substr(0, state.size() / 2)}), std::invalid_argument);
  EXPECT_THROW(Simulation(scene, {.driven = {"ball"}, .state = state}), std::invalid_argument);
}

TEST(LibrarySimulation, ThreadsDoNotDisturbEachOther) {
  const Scene scene = Scene::parse(kDrape);
  Simulation reference(scene);
  const Points expected = advance(reference, 6);
  Points one, two;
  const auto run = [&](Points& result) {
    Simulation simulation(scene);
    result = advance(simulation, 6);
  };
  std::thread thread([&] { run(one); });
  run(two);
  thread.join();
  EXPECT_EQ(one, expected);
  EXPECT_EQ(two, expected);
}

// Keys of the scene, and the equivalent calls of move(), must cause the same motion.
TEST(LibraryMove, IsMotionBetweenLinearKeys) {
  const Scene scene = Scene::parse(kDrape);
  const auto written = [](double number) { return std::to_string(number); };
  const auto height = [](int frame) { return 0.02 * std::sin(0.5 * frame); };
  std::string list;
  for (int k = 0; k <= 10; ++k)
    list += "{ time = " + written(k / 25.0) + ", position = [0, 0, " + written(height(k)) + "] }, ";
  Simulation keyed(Scene::parse(kDrape + "interpolation = \"linear\"\nkeys = [" + list + "]\n"));
  Simulation driven(scene, {.driven = {"ball"}, .state = {}});
  double apart = 0;
  for (int k = 1; k <= 10; ++k) {
    driven.move("ball", {.position = {0, 0, std::stod(written(height(k)))}});
    driven.advance();
    keyed.advance();
    const Points a = positions(driven.frame()), b = positions(keyed.frame());
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) apart = std::max(apart, std::abs(a[i][c] - b[i][c]));
  }
  EXPECT_LT(apart, 1e-9);  // equal up to rounding of times and places
}

TEST(LibraryMove, PinsFollowTheHandle) {
  Simulation simulation(Scene::parse(kHanging), {.driven = {"handle"}, .state = {}});
  const Points before = positions(simulation.frame());
  for (int k = 1; k <= 5; ++k) {
    simulation.move("handle", {.position = {0.01 * k, 0, 1}});
    simulation.advance();
  }
  const Points after = positions(simulation.frame());
  for (std::size_t i = 110; i < 121; ++i) {  // the row at warp 1
    EXPECT_NEAR(after[i][0], before[i][0] + 0.05, 1e-12);
    EXPECT_NEAR(after[i][2], before[i][2], 1e-12);
  }
}

TEST(LibraryMove, StaysWhereItIsWithoutAnotherCall) {
  Simulation simulation(Scene::parse(kDrape), {.driven = {"ball"}, .state = {}});
  const Points start = positions(simulation.frame(), "ball");
  simulation.move("ball", {.position = {0, 0, 0.01}});
  simulation.advance();
  const Points moved = positions(simulation.frame(), "ball");
  simulation.advance();
  EXPECT_NE(start, moved);
  EXPECT_EQ(positions(simulation.frame(), "ball"), moved);
}

TEST(LibraryMove, IsPartOfTheSavedState) {
  const Scene scene = Scene::parse(kDrape);
  const SimulationOptions driven{.driven = {"ball"}, .state = {}};
  Simulation whole(scene, driven), first(scene, driven);
  const auto step = [](Simulation& simulation, int k) {
    if (k % 2 == 1) simulation.move("ball", {.position = {0.002 * k, 0, 0.003 * k}});
    simulation.advance();
  };
  for (int k = 1; k <= 8; ++k) step(whole, k);
  for (int k = 1; k <= 4; ++k) step(first, k);
  Simulation second(scene, {.driven = {"ball"}, .state = first.save()});
  for (int k = 5; k <= 8; ++k) step(second, k);
  EXPECT_EQ(positions(second.frame()), positions(whole.frame()));
  EXPECT_EQ(positions(second.frame(), "ball"), positions(whole.frame(), "ball"));
}

// Of two handles, the caller moves one, from the second frame on; the other one moves by its keys.
TEST(LibraryMove, StateContinuesBeforeABodyIsMoved) {
  const Scene scene = Scene::parse(kHanging + R"(
[[obstacle]]
name = "other"
shape = "sphere"
radius = 0.01
segments = 8
position = [1, 0, 1]
keys = [{ time = 0, position = [1, 0, 1] }, { time = 0.4, position = [2, 0, 1] }]
)");
  SimulationOptions options{.driven = {"other", "handle"}, .state = {}};
  Simulation whole(scene, options);
  options.state = whole.save();
  for (int k = 1; k <= 3; ++k) {
    Simulation resumed(scene, options);
    for (Simulation* simulation : {&whole, &resumed}) {
      if (k == 2) simulation->move("handle", {.position = {0, 0, 1.01}});
      simulation->advance();
    }
    for (const char* object : {"sheet", "handle", "other"})
      EXPECT_EQ(positions(resumed.frame(), object), positions(whole.frame(), object)) << object << " " << k;
    options.state = resumed.save();
  }
  options.state.resize(options.state.find('\n') + 2);
  EXPECT_THROW(Simulation(scene, options), std::invalid_argument) << "cut short";
}

TEST(LibraryMove, LeavesLayersWhereTheyAreHeldAfterAResumption) {
  const std::string held =
      "particles = [6, 6]\nsize = [0.4, 0.4]\npin = [{low = [0, 0], high = [0, 1], follow = 'hand'}]\n";
  const Scene scene = Scene::parse("[time]\npreroll = 0.08\n[[cloth]]\nname = 'inner'\nposition = [0, 0, 1]\n" + held +
                                   "[[cloth]]\nname = 'outer'\nposition = [0, 0, 1.1]\nover = 'inner'\n" + held +
                                   "[[obstacle]]\nname = 'hand'\nshape = 'box'\ncollide = false\n");
  Simulation whole(scene, {.driven = {"hand"}, .state = {}});
  for (int k = 1; k <= 2; ++k) whole.move("hand", {.position = {0, 0.02 * k, 0}}), whole.advance();
  Simulation resumed(scene, {.driven = {"hand"}, .state = whole.save()});
  whole.advance(), resumed.advance();
  for (const char* name : {"inner", "outer"})
    EXPECT_EQ(positions(resumed.frame(), name), positions(whole.frame(), name)) << name;
}

// The ball moves at 0.25 m/s along x until its release after two frames, and gets 0.5 m/s along y then.
TEST(LibraryMove, VelocityOfABodyWithAMassIsAddedAtItsRelease) {
  const Scene scene = Scene::parse(kDrape, {"physics.gravity=[0,0,0]", "obstacle.ball.mass=1",
                                            "obstacle.ball.release=0.08", "obstacle.ball.velocity=[0,0.5,0]"});
  Simulation simulation(scene, {.driven = {"ball"}, .state = {}});
  for (int k = 1; k <= 2; ++k) simulation.move("ball", {.position = {0.01 * k, 0, 0}}), simulation.advance();
  const Vector released = positions(simulation.frame(), "ball").front();
  for (int k = 1; k <= 2; ++k) simulation.advance();
  const Vector later = positions(simulation.frame(), "ball").front();
  EXPECT_NEAR(later[0] - released[0], 0.02, 1e-6);
  EXPECT_NEAR(later[1] - released[1], 0.04, 1e-6);
}

TEST(LibrarySettings, RefuseNumbersOfThreadsBelowZero) {
  EXPECT_THROW(set_threads(-1), std::invalid_argument);
  EXPECT_NO_THROW(set_threads(0));
}

TEST(LibraryMove, RefusesWhatItCannotMove) {
  const Scene scene = Scene::parse(kDrape);
  const SimulationOptions ball{.driven = {"ball"}, .state = {}};
  EXPECT_THROW(Simulation(scene.with({"obstacle.ball.mass=1"}), ball), std::invalid_argument);
  EXPECT_NO_THROW(Simulation(scene.with({"obstacle.ball.mass=1", "obstacle.ball.release=0.2"}), ball));
  EXPECT_THROW(Simulation(scene, {.driven = {"bal"}, .state = {}}), std::invalid_argument);
  EXPECT_THROW(Simulation(scene, {.driven = {"ball", "ball"}, .state = {}}), std::invalid_argument);
  Simulation still(scene), driven(scene, {.driven = {"ball"}, .state = {}});
  const auto error = thrown<std::invalid_argument>([&] { still.move("ball", {}); });
  EXPECT_STREQ(error.what(), "expected a driven body, got ball; name it in `driven` when the simulation is made");
  EXPECT_THROW(driven.move("ball", {.position = {NAN, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(driven.move("ball", {.rotation = {0, 0, 0, 0}}), std::invalid_argument);
}

TEST(LibraryErrors, OfAStartThatTouchesNameThePlace) {
  const auto error = thrown<SceneError>([] { Simulation(Scene::parse(kDrape, {"cloth.sheet.position=[0,0,0.1]"})); });
  EXPECT_NE(std::string(error.what()).find("expected surfaces that are apart at the start"), std::string::npos);
  EXPECT_TRUE(error.mistakes().at(0).file.ends_with("scene.toml"));
}

class LibraryFiles : public support::TestFolder {};

TEST_F(LibraryFiles, ThatCannotBeUsedAreErrorsWithThePlaceInTheScene) {
  support::write_bytes(folder_ / "broken.obj", "f 1 2 3\n");
  const std::string text =
      "[[cloth]]\nname = \"a\"\n\n[[obstacle]]\nname = \"b\"\nshape = \"mesh\"\nfile = \"broken.obj\"\n";
  const auto error = thrown<FileError>([&] { Simulation(Scene::parse(text, {}, folder_ / "a.toml")); });
  EXPECT_EQ(error.mistakes().at(0).file, (folder_ / "a.toml").string()) << error.what();
  EXPECT_EQ(error.mistakes().at(0).line, 7) << error.what();
  EXPECT_EQ(error.mistakes().at(0).key, "obstacle.b") << error.what();
  const auto folder = folder_ / "film: first";
  std::filesystem::create_directory(folder);
  support::write_bytes(folder / "broken.obj", "f 1 2 3\n");
  const auto same = thrown<FileError>([&] { Simulation(Scene::parse(text, {}, folder / "a.toml")); });
  EXPECT_EQ(same.mistakes().at(0).file, (folder / "a.toml").string()) << same.what();
  EXPECT_EQ(same.mistakes().at(0).key, "obstacle.b") << same.what();
}

// A change has no place in the file; the obstacle has.
TEST_F(LibraryFiles, ThatAChangeNamesAreErrorsWithThePlaceOfTheObject) {
  support::write_bytes(folder_ / "broken.obj", "f 1 2 3\n");
  const std::string text = "[[cloth]]\nname = \"a\"\n\n[[obstacle]]\nname = \"b\"\nshape = \"mesh\"\n";
  const auto error =
      thrown<FileError>([&] { Simulation(Scene::parse(text, {"obstacle.b.file=broken.obj"}, folder_ / "a.toml")); });
  EXPECT_EQ(error.mistakes().at(0).file, (folder_ / "a.toml").string()) << error.what();
  EXPECT_EQ(error.mistakes().at(0).line, 4) << error.what();
}

TEST_F(LibraryFiles, AreFoundByChangesAfterTheCurrentFolderHasChanged) {
  support::write_bytes(folder_ / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  support::write_bytes(folder_ / "s.toml", "[[obstacle]]\nname = \"a\"\nshape = \"mesh\"\nfile = \"a.obj\"\n");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  const Scene scene = Scene::load("s.toml");
  std::filesystem::current_path(before);
  EXPECT_EQ(scene.with({"time.fps=50"}).fps(), 50);
  const auto error = thrown<SceneError>([&] { scene.with({"time.fps=-1"}); });
  EXPECT_EQ(error.mistakes().at(0).file, "s.toml") << "as it was given";
}

TEST(LibraryErrors, OfAnObjectThatIsNotThereNameThoseThatAre) {
  const Simulation simulation(Scene::parse(kDrape));
  const auto error = thrown<std::out_of_range>([&] { simulation.frame().object("shet"); });
  EXPECT_STREQ(error.what(), "expected one of the objects sheet, ball, got shet");
}

TEST(LibraryWarnings, GoToTheHandlerInsteadOfStandardError) {
  std::vector<std::string> warnings;
  set_warning_handler([&](std::string_view text) { warnings.emplace_back(text); });
  ::testing::internal::CaptureStderr();
  // This causes a warning: the pin starts at another place than its first key.
  Simulation(Scene::parse(kHanging +
                          "[[cloth]]\nname = \"b\"\nposition = [5, 0, 0]\n"
                          "pin = [{ low = [0, 0], high = [0, 1], keys = [{ time = 0, offset = [0.1, 0, 0] }, "
                          "{ time = 1, offset = [0.1, 0, 0] }] }]\n"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  set_warning_handler({});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("cloth.b.pin.0"), std::string::npos) << warnings[0];
}

TEST(LibraryWarnings, SayWhatTheStartOfASimulationChanges) {
  std::vector<std::string> notes;
  set_warning_handler([&](std::string_view text) { notes.emplace_back(text); });
  ::testing::internal::CaptureStderr();
  Simulation(Scene::parse(R"(
[[cloth]]
name = "a"
size = [0.2, 0.2]
particles = [9, 9]
position = [0, 0, 1]
start = "untangle"

[[cloth]]
name = "b"
size = [0.2, 0.2]
particles = [9, 9]
position = [0, 0, 1]
rotation = [2, 0, 0]
start = "untangle"

[[obstacle]]
name = "floor"
shape = "plane"

[[obstacle]]
name = "box"
shape = "box"
size = [0.1, 0.1, 0.1]
position = [1, 0, 0.05]
mass = 1
)"));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  set_warning_handler({});
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_TRUE(notes[0].starts_with("lifted bodies by up to ")) << notes[0];
  EXPECT_TRUE(notes[1].starts_with("untangled the start: ")) << notes[1];
}

}  // namespace
}  // namespace weft::library
