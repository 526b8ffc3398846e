// Models made in memory, through the public interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>
#include <weft/scene.hpp>
#include <weft/settings.hpp>
#include <weft/simulation.hpp>

#include "physics/mesh/quads.hpp"
#include "physics/mesh/shapes.hpp"
#include "physics/mesh/sheet.hpp"

namespace weft::library {
namespace {

Mesh public_mesh(const mesh::Mesh& mesh) {
  Mesh copy;
  for (const Vec3& x : mesh.positions) copy.positions.push_back({x.x(), x.y(), x.z()});
  for (const mesh::Triangle& t : mesh.topology.triangles) copy.triangles.push_back({t[0], t[1], t[2]});
  return copy;
}

// A sheet of 9 by 9 particles and a side of 0.4 m in the x-y plane.
Cloth sheet() {
  const mesh::Grid grid{.nu = 9, .nv = 9, .lu = 0.05, .lv = 0.05};
  return {.name = "sheet",
          .mesh = public_mesh(mesh::make_triangle_sheet(grid, mesh::Pattern::aligned)),
          .rest = {},
          .material = {}};
}

Body ball() {
  Body body;
  body.name = "ball";
  body.mesh = public_mesh(mesh::make_sphere(0.1, 24));
  body.pose.position = {0.02, 0.01, -0.12};
  return body;
}

Model drape() {
  Model model;
  model.cloths = {sheet()};
  model.bodies = {ball()};
  return model;
}

const char* const kSameScene = R"(
[[cloth]]
name = "sheet"
shape = "aligned_triangles"
size = [0.4, 0.4]
particles = 9
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 24
position = [0.02, 0.01, -0.12]
)";

std::vector<Vector> positions_after(Simulation& simulation, int frames) {
  for (int k = 0; k < frames; ++k) simulation.advance();
  const auto span = simulation.frame().object("sheet").positions;
  return {span.begin(), span.end()};
}

template <class Exception = std::invalid_argument>
void expect_refused(const std::string& text, const Model& model, const SimulationOptions& options = {}) {
  try {
    Simulation{model, options};
    FAIL() << "expected a refusal with " << text;
  } catch (const Exception& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << "not " << text << ": " << error.what();
  }
}

TEST(LibraryModel, HasTheBitsOfTheSceneThatSaysTheSame) {
  Model model = drape();
  Simulation of_model(model), of_scene(Scene::parse(kSameScene));
  EXPECT_EQ(positions_after(of_model, 12), positions_after(of_scene, 12));
  EXPECT_LT(of_model.frame().report().min_distance, 0.01) << "the sheet has reached the ball";
  EXPECT_EQ(of_model.frame().report().near_pairs, of_scene.frame().report().near_pairs);
  ASSERT_EQ(of_model.frame().objects().size(), 2U);
  EXPECT_EQ(of_model.frame().objects()[1].kind, Kind::obstacle);
  const auto body = of_model.frame().object("ball").positions, same = of_scene.frame().object("ball").positions;
  EXPECT_TRUE(std::ranges::equal(body, same));
}

// Every value of this model differs from its default. The sheet hits the ball, which has a mass of 20 g.
TEST(LibraryModel, PassesOnEachOfItsValues) {
  Model model;
  model.fps = 50, model.step = 0.005, model.method = Method::bdf2, model.newton_tolerance = 0.2;
  model.gravity = {0.5, 0, -8}, model.wind = {0, 1, 0}, model.air_density = 2, model.self_contact = false;
  Cloth cloth = sheet();
  cloth.material = {.density = 0.3,
                    .stretch_weft = 500,
                    .stretch_warp = 700,
                    .shear = 60,
                    .bend = 3e-5,
                    .max_stretch = 0.05,
                    .max_shear = 30,
                    .stretch_viscosity = 0.1,
                    .shear_viscosity = 0.2,
                    .bend_viscosity = 2e-6,
                    .bend_friction = 1e-4,
                    .thickness = 0.003,
                    .friction = 0.6,
                    .drag = 0.5};
  cloth.velocity = {0, 0, -1};
  Body thrown = ball(), lid = ball();
  thrown.mass = 0.02, thrown.velocity = {0.1, 0, 0}, thrown.friction = 0.1;
  lid.name = "lid", lid.collide = true, lid.friction = 0.9;
  lid.keys = {{0, {{0, 0, -0.6}, {1, 0, 0, 0}}}, {0.2, {{0.05, 0, -0.5}, {0, 0, 0, 1}}}};
  model.cloths = {cloth};
  model.bodies = {thrown, lid};
  const std::string scene = R"(
[time]
fps = 50
step = 0.005
integrator = "bdf2"
[solver]
newton_tolerance = 0.2
[physics]
gravity = [0.5, 0, -8]
wind = [0, 1, 0]
air_density = 2
[contact]
self = false
[[cloth]]
name = "sheet"
shape = "aligned_triangles"
size = [0.4, 0.4]
particles = 9
velocity = [0, 0, -1]
[cloth.material]
density = 0.3
stretch = [500, 700]
shear = 60
bend = 3e-5
max_stretch = 0.05
max_shear = 30
stretch_viscosity = 0.1
shear_viscosity = 0.2
bend_viscosity = 2e-6
bend_friction = 1e-4
thickness = 0.003
friction = 0.6
drag = 0.5
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.1
segments = 24
position = [0.02, 0.01, -0.12]
mass = 0.02
velocity = [0.1, 0, 0]
friction = 0.1
[[obstacle]]
name = "lid"
shape = "sphere"
radius = 0.1
segments = 24
friction = 0.9
keys = [{ time = 0, position = [0, 0, -0.6] }, { time = 0.2, position = [0.05, 0, -0.5], rotation = [0, 0, 180] }]
)";
  Simulation of_model(model), of_scene(Scene::parse(scene));
  EXPECT_EQ(of_model.frame().report().kinetic_energy, of_scene.frame().report().kinetic_energy);
  EXPECT_EQ(positions_after(of_model, 8), positions_after(of_scene, 8));
  EXPECT_TRUE(std::ranges::equal(of_model.frame().object("ball").positions, of_scene.frame().object("ball").positions));
}

TEST(LibraryModel, HasCottonByDefault) {
  const Material cotton = fabric("cotton"), given;
  EXPECT_EQ(cotton.density, given.density);
  EXPECT_EQ(cotton.bend, given.bend);
  EXPECT_EQ(cotton.stretch_warp, given.stretch_warp);
  EXPECT_EQ(cotton.friction, given.friction);
}

// A sheet whose fabric is shorter than its mesh along weft, by a factor of 1.1, begins with a strain of 0.1.
TEST(LibraryModel, TakesItsRestShapeFromTheFlatFabric) {
  Model model;
  model.cloths = {sheet()};
  for (const Vector& x : model.cloths[0].mesh.positions) model.cloths[0].rest.push_back({x[0] / 1.1, x[1]});
  Simulation simulation(model);
  EXPECT_NEAR(simulation.frame().report().max_strain, 0.1, 1e-9);
}

// The spans of a frame point to its own data.
TEST(LibraryModel, HasFramesThatOutliveTheirSimulation) {
  std::optional<Frame> kept;
  std::vector<Vector> before;
  {
    Model model = drape();
    Simulation simulation(model);
    before = positions_after(simulation, 1);
    kept = simulation.frame();
    simulation.advance();
  }
  EXPECT_TRUE(std::ranges::equal(kept->object("sheet").positions, before));
  EXPECT_EQ(kept->object("ball").triangles.size(), ball().mesh.triangles.size());
}

TEST(LibraryModel, HoldsPinsWhereTheyStartAndAtBodiesUntilTheirRelease) {
  Model model;
  model.gravity = {0, 0, -9.81};
  model.cloths = {sheet()};
  Body handle = ball();
  handle.name = "handle";
  handle.collide = false;
  handle.keys = {{0, {{0, 0, 0}}}, {0.4, {{0, 0, 0.2}}}};
  model.bodies = {handle};
  model.pins = {{.cloth = "sheet", .particles = {0, 8}, .body = "handle"},
                {.cloth = "sheet", .particles = {72, 80}, .body = "", .release = 0.2}};
  Simulation simulation(model);
  const std::vector<Vector> start = positions_after(simulation, 0), middle = positions_after(simulation, 4),
                            end = positions_after(simulation, 6);
  EXPECT_EQ(middle[80], start[80]);
  EXPECT_LT(end[80][2], start[80][2] - 0.05) << "released";
  for (const std::size_t i : {std::size_t{0}, std::size_t{8}}) EXPECT_NEAR(end[i][2], start[i][2] + 0.2, 1e-12);
}

TEST(LibraryModel, MovesBodiesByForcesAndByTheCaller) {
  Model model;
  model.cloths = {sheet()};
  Body thrown = ball(), hand = ball();
  thrown.name = "thrown", thrown.mass = 0.1, thrown.velocity = {1, 0, 0};
  hand.name = "hand", hand.pose.position = {0, 0, 3}, hand.collide = false;
  model.bodies = {thrown, hand};
  model.bodies[0].pose.position = {0, 3, 0};
  Simulation simulation(model, {.driven = {"hand"}, .state = {}});
  const auto first_of = [&](const char* name) { return simulation.frame().object(name).positions[0]; };
  const Vector at_start = first_of("thrown"), of_hand = first_of("hand");
  simulation.move("hand", {{0, 0, 3.5}});
  simulation.advance();
  EXPECT_NEAR(first_of("hand")[2], of_hand[2] + 0.5, 1e-12);
  EXPECT_NEAR(first_of("thrown")[0], at_start[0] + 0.04, 1e-9);
  EXPECT_LT(first_of("thrown")[2], at_start[2]);
}

TEST(LibraryModel, ContinuesFromASavedStateAndRefusesThatOfAnother) {
  Model model = drape();
  Simulation whole(model);
  positions_after(whole, 6);
  const std::string state = whole.save();
  Simulation resumed(model, {.driven = {}, .state = state});
  EXPECT_EQ(positions_after(resumed, 4), positions_after(whole, 4));
  for (const auto& change : std::vector<std::function<void(Model&)>>{
           [](Model& m) { m.cloths[0].mesh.positions[0][0] += 0.001; },
           [](Model& m) { m.cloths[0].material.bend *= 2; },
           [](Model& m) { m.pins = {{.cloth = "sheet", .particles = {0}, .body = ""}}; },
           [](Model& m) { m.bodies[0].pose.position[0] += 0.001; }, [](Model& m) { m.step = 0.02; }}) {
    Model other = model;
    change(other);
    expect_refused("state", other, {.driven = {}, .state = state});
  }
}

// Joined by commas, both lists of names are "a,b,c", but they name other bodies.
TEST(LibraryModel, RefusesAStateOfOtherDrivenBodiesWhoseNamesHaveCommas) {
  Model model;
  model.cloths = {sheet()};
  for (const char* name : {"a", "b,c", "a,b", "c"}) {
    Body body = ball();
    body.name = name, body.collide = false;
    model.bodies.push_back(body);
  }
  Simulation whole(model, {.driven = {"a", "b,c"}, .state = {}});
  whole.move("a", {{0, 0, 0.5}});
  whole.advance();
  const std::string state = whole.save();
  EXPECT_NO_THROW(Simulation(model, {.driven = {"a", "b,c"}, .state = state}));
  expect_refused("with the same driven bodies", model, {.driven = {"a,b", "c"}, .state = state});
}

// Without air, the sheet falls freely for 0.2 s, and then keeps its velocity. This must not cause a warning of gained
// energy.
TEST(LibraryWeather, ChangesGravityBetweenFrames) {
  Model model;
  model.air_density = 0;
  model.cloths = {sheet()};
  Simulation simulation(model);
  positions_after(simulation, 5);
  simulation.set_weather({0, 0, 4}, {0, 0, 0});
  positions_after(simulation, 10);
  const Frame& frame = simulation.frame();
  for (const Vector& v : frame.object("sheet").velocities) EXPECT_NEAR(v[2], -9.81 * 0.2 + 4 * 0.4, 1e-9);
  EXPECT_EQ(frame.report().warnings, std::vector<std::string>());
  EXPECT_THROW(simulation.set_weather({0, 0, NAN}, {}), std::invalid_argument);
  EXPECT_THROW(simulation.set_weather({}, {0, 1001, 0}), std::invalid_argument);
}

// Wind that is set before the first frame acts like the wind of a model that has it from the start. The saved state
// contains it.
TEST(LibraryWeather, ChangesTheWindAndIsSaved) {
  Model still, windy;
  still.cloths = windy.cloths = {sheet()};
  still.pins = windy.pins = {{.cloth = "sheet", .particles = {0, 8}}};
  windy.wind = {3, 2, 1};
  Simulation changed(still), expected(windy);
  changed.set_weather(still.gravity, windy.wind);
  const std::vector<Vector> got = positions_after(changed, 5), wanted = positions_after(expected, 5);
  for (std::size_t i = 0; i < got.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[i][c], wanted[i][c], 1e-9) << i;
  Simulation resumed(still, {.state = changed.save()});
  EXPECT_EQ(positions_after(resumed, 5), positions_after(changed, 5));
}

// A frame can be interrupted at any time and computed again, with the same bits.
TEST(LibraryInterrupt, EndsAFrameThatCanBeComputedAgain) {
  Model model = drape();
  Simulation whole(model), interrupted(model);
  positions_after(whole, 9), positions_after(interrupted, 8);
  const std::vector<Vector> before = positions_after(interrupted, 0);
  int times = 0;
  for (int last = 0;; last += 5) {
    int calls = 0;
    set_interrupt_check([&] {
      if (calls++ == last) throw std::domain_error("stop");
    });
    try {
      interrupted.advance();
      break;
    } catch (const std::domain_error&) {
      ++times;
      EXPECT_EQ(positions_after(interrupted, 0), before);
    }
  }
  set_interrupt_check({});
  EXPECT_GT(times, 5);
  EXPECT_EQ(positions_after(interrupted, 0), positions_after(whole, 0));
}

TEST(LibraryModel, WithAValueThatCannotBeIsRefusedByName) {
  const auto with = [](const std::function<void(Model&)>& change) {
    Model model = drape();
    change(model);
    return model;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused("nan, 0] as vertex 3", with([&](Model& m) { m.cloths[0].mesh.positions[3][1] = nan; }));
  expect_refused("triangles of vertices from 0 to 80, got [81, 1, 10] as triangle 2", with([](Model& m) {
                   m.cloths[0].mesh.triangles[2] = {81, 1, 10};
                 }));
  expect_refused("ball: expected triangles of three different vertices, got [4, 5, 4] as triangle 1",
                 with([](Model& m) {
                   m.bodies[0].mesh.triangles[1] = {4, 5, 4};
                 }));
  expect_refused("triangles that face the same way, got 3 edges between two that do not, the first of vertices ",
                 with([](Model& m) {
                   auto& t = m.cloths[0].mesh.triangles[40];
                   std::swap(t[0], t[1]);
                 }));
  expect_refused("sheet: expected vertices in different places, got 10 and 81 in the same one; merge them",
                 with([](Model& m) {
                   Mesh& mesh = m.cloths[0].mesh;
                   mesh.positions.push_back(mesh.positions[10]);
                   for (Triangle& t : mesh.triangles)
                     if (t[0] == 10) t[0] = 81;
                 }));
  expect_refused("edges of one or two triangles",
                 with([](Model& m) { m.cloths[0].mesh.triangles.push_back(m.cloths[0].mesh.triangles[0]); }));
  expect_refused("sheet: expected at least one triangle", with([](Model& m) { m.cloths[0].mesh.triangles.clear(); }));
  expect_refused("density [kg/m²] from 1e-12", with([](Model& m) { m.cloths[0].material.density = 0; }));
  expect_refused("a bend [N·m] from 0", with([](Model& m) { m.cloths[0].material.bend = -1; }));
  expect_refused("as many rest points as particles (81), got 1", with([](Model& m) { m.cloths[0].rest = {{0, 0}}; }));
  expect_refused("triangles that have an area at rest", with([](Model& m) {
                   m.cloths[0].rest.assign(81, RestPoint{0, 0});
                 }));
  expect_refused("names differ, got sheet twice", with([](Model& m) { m.bodies[0].name = "sheet"; }));
  expect_refused("ball: expected a unit quaternion", with([](Model& m) { m.bodies[0].pose.rotation[0] = 2; }));
  expect_refused("ball: expected keys at increasing times", with([](Model& m) {
                   m.bodies[0].keys = {{1, {}}, {1, {}}};
                 }));
  expect_refused("ball: expected a mass, or keys", with([](Model& m) {
                   m.bodies[0].mass = 1;
                   m.bodies[0].keys = {{0, {}}};
                 }));
  expect_refused("for a body with a mass", with([](Model& m) {
                   m.bodies[0].mass = 1;
                   m.bodies[0].mesh.triangles.pop_back();
                 }));
  expect_refused("sheet: expected pinned particles from 0 to 80, got 81",
                 with([](Model& m) { m.pins = {{.cloth = "sheet", .particles = {81}, .body = ""}}; }));
  expect_refused("pin: expected a cloth (sheet), got \"other\"",
                 with([](Model& m) { m.pins = {{.cloth = "other", .particles = {1}, .body = ""}}; }));
  expect_refused("vertices that triangles use, got number 81 alone", with([](Model& m) {
                   m.cloths[0].mesh.positions.push_back({0, 0, 1});
                 }));
  expect_refused("each particle once, in one pin alone, got 4 twice", with([](Model& m) {
                   m.pins = {{.cloth = "sheet", .particles = {4, 4}, .body = ""}};
                 }));
  expect_refused("each particle once, in one pin alone, got 4 twice", with([](Model& m) {
                   m.pins = {{.cloth = "sheet", .particles = {3, 4}, .body = "", .release = 0.1},
                             {.cloth = "sheet", .particles = {4}, .body = "ball"}};
                 }));
  expect_refused("a pin with particles",
                 with([](Model& m) { m.pins = {{.cloth = "sheet", .particles = {}, .body = ""}}; }));
  expect_refused("forces do not move, got ball", with([](Model& m) {
                   m.bodies[0].mass = 1;
                   m.pins = {{.cloth = "sheet", .particles = {4}, .body = "ball"}};
                 }));
  expect_refused("a release of 0 s or later",
                 with([&](Model& m) { m.pins = {{.cloth = "sheet", .particles = {4}, .body = "", .release = nan}}; }));
  expect_refused("a rest coordinate [m]", with([&](Model& m) { m.cloths[0].rest.assign(81, RestPoint{nan, 0}); }));
  expect_refused("counter-clockwise in the flat fabric", with([](Model& m) {
                   for (const Vector& x : m.cloths[0].mesh.positions) m.cloths[0].rest.push_back({-x[0], x[1]});
                 }));
  expect_refused("a 80th as high as the longest edge", with([](Model& m) {
                   m.cloths[0].mesh.positions[0] = {-0.15 - 1e-5, -0.2, 0};
                 }));
  expect_refused("ball: expected a velocity of a body with a mass", with([](Model& m) {
                   m.bodies[0].velocity = {1, 0, 0};
                 }));
  expect_refused("ball: expected a key's time", with([&](Model& m) { m.bodies[0].keys = {{nan, {}}}; }));
  expect_refused("a name in `driven`", with([](Model& m) { m.bodies[0].mass = 1; }), {.driven = {"ball"}, .state = {}});
  expect_refused("one of the methods", with([](Model& m) { m.method = static_cast<Method>(7); }));
  expect_refused("at most 1e+09 steps in a frame", with([](Model& m) { m.fps = 1e-6, m.step = 1e-7; }));
  expect_refused("model: expected a step [s]", with([](Model& m) { m.step = 0; }));
  expect_refused("model: expected gravity [m/s²] from", with([&](Model& m) { m.gravity[2] = nan; }));
  expect_refused("driven: expected bodies (ball), got bal", with([](Model&) {}), {.driven = {"bal"}, .state = {}});
}

// Meshes of other programs often have two triangles in one place. The faces of the ball are at least 98.3 mm from its
// middle: 0.1 m times the square of the cosine of half a segment, 7.5°.
TEST(LibraryModel, TakesBodiesWhoseEdgesAreOfThreeTriangles) {
  Model model = drape();
  Simulation plain(model);
  model.bodies[0].mesh.triangles.push_back(model.bodies[0].mesh.triangles[0]);
  Simulation doubled(model);
  const std::vector<Vector> last = positions_after(doubled, 12);
  EXPECT_EQ(last.size(), 81U);
  for (const Vector& x : last) EXPECT_GT(std::hypot(x[0] - 0.02, x[1] - 0.01, x[2] + 0.12), 0.098) << "outside";
  EXPECT_EQ(plain.frame().object("ball").triangles.size() + 1, doubled.frame().object("ball").triangles.size());
}

TEST(LibraryModel, ThatTouchesAtTheStartIsRefusedAsAScene) {
  Model model = drape();
  model.bodies[0].pose.position = {0, 0, 0};
  expect_refused<SceneError>("expected surfaces that are apart at the start", model);
}

TEST(LibraryFabric, IsThatOfAScene) {
  Model model;
  model.cloths = {sheet()};
  model.cloths[0].material = fabric("silk");
  Simulation of_model(model);
  Simulation of_scene(
      Scene::parse(std::string("[[cloth]]\nname = \"sheet\"\nshape = \"aligned_triangles\"\nsize = "
                               "[0.4, 0.4]\nparticles = 9\nmaterial.fabric = \"silk\"\n")));
  EXPECT_EQ(positions_after(of_model, 5), positions_after(of_scene, 5));
  EXPECT_THROW(fabric("silkk"), std::invalid_argument);
}

}  // namespace
}  // namespace weft::library
