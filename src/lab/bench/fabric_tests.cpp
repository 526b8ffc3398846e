#include "lab/bench/fabric_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/temporary_file.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/run_error/shadow.hpp"

namespace weft::bench {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81;  // [m/s²]

// A scene with one level rectangular cloth, without air and contact.
scene::Scene sheet_alone(const Vec2& size, int particles_weft, int particles_warp, const scene::Material& material) {
  scene::Scene scene;
  scene.physics.air_density = 0;
  scene.contact.self = scene.contact.obstacles = false;
  scene::Cloth cloth;
  cloth.name = "specimen";
  cloth.size = size;
  cloth.particles_weft = particles_weft;
  cloth.particles_warp = particles_warp;
  cloth.material = material;
  scene.cloths.push_back(cloth);
  return scene;
}

const std::vector<Vec3>& positions_of(const production::SceneSimulation& simulation) {
  return simulation.snapshot()->states[0].positions;
}

}  // namespace

namespace cusick {
namespace {

// Pseudo-random number in [-½, ½).
double pseudo_random(int ring, int place, int seed) {
  const double number = std::sin(12.9898 * place + 78.233 * ring + 5 * seed) * 43758.5453;
  return number - std::floor(number) - 0.5;
}

}  // namespace

Specimen rings(int free, int seed) {
  const double l = (kSpecimenRadius - kPlateRadius) / free;
  const int inner = static_cast<int>(std::lround(kPlateRadius / l)), all = inner + free;
  Specimen disc;
  disc.positions.emplace_back(0, 0, 0);
  std::vector<int> first{0};
  for (int k = 1; k <= all; ++k) {
    first.push_back(static_cast<int>(disc.positions.size()));
    const double radius = k <= inner ? kPlateRadius * k / inner : kPlateRadius + (k - inner) * l;
    for (int i = 0; i < 6 * k; ++i) {
      const double along = k > inner ? 0.3 * pseudo_random(k, i, seed) : 0;
      const double across = k > inner && k < all ? 0.3 * l * pseudo_random(k, i, seed + 1) : 0;
      const double angle = 2 * kPi * (i + along) / (6 * k);
      if (k <= inner) disc.held.push_back(disc.positions.size());
      disc.positions.emplace_back((radius + across) * std::cos(angle), (radius + across) * std::sin(angle), 0);
    }
  }
  disc.held.push_back(0);
  for (int k = 1; k <= all; ++k) {
    const auto outside = [&](int i) { return first[k] + i % (6 * k); };
    const auto inside = [&](int i) { return k == 1 ? 0 : first[static_cast<std::size_t>(k) - 1] + i % (6 * (k - 1)); };
    for (int sector = 0; sector < 6; ++sector)
      for (int i = 0; i < k; ++i) {
        const int o = sector * k + i, n = sector * (k - 1) + i;
        disc.triangles.push_back({outside(o), outside(o + 1), inside(n)});
        if (i + 1 < k) disc.triangles.push_back({outside(o + 1), inside(n + 1), inside(n)});
      }
  }
  return disc;
}

std::vector<scene::Pin> pins_at(const std::vector<Vec3>& x, const std::vector<std::size_t>& held) {
  Vec3 low = x[0], high = x[0];
  for (const Vec3& point : x) low = low.cwiseMin(point), high = high.cwiseMax(point);
  std::vector<scene::Pin> pins;
  for (std::size_t i : held) {
    const Vec2 fraction = (x[i] - low).head<2>().cwiseQuotient((high - low).head<2>());
    scene::Pin pin;
    pin.low = fraction - Vec2::Constant(1e-6);
    pin.high = fraction + Vec2::Constant(1e-6);
    pins.push_back(pin);
  }
  return pins;
}

scene::Scene scene_of(const Specimen& specimen, const scene::Material& material, const std::filesystem::path& file) {
  std::string text;
  for (const Vec3& x : specimen.positions) text += fmt::format("v {:.12g} {:.12g} 0\n", x.x(), x.y());
  for (const mesh::Triangle& t : specimen.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  write_file(file, text);
  scene::Scene scene = sheet_alone({1, 1}, 3, 3, material);
  scene::Cloth& cloth = scene.cloths[0];
  cloth.shape = scene::ClothShape::mesh;
  cloth.file = file;
  cloth.pins = pins_at(specimen.positions, specimen.held);
  return scene;
}

Drape drape(scene::Scene scene, const std::vector<mesh::Triangle>& triangles, Solved solved) {
  // Value of newton_tolerance. Measured for wool, cotton, jersey and faille: a third of this value changes the drape
  // coefficient by up to 0.003; half of the time step changes it by 0.004 to 0.01.
  constexpr double kExact = 0.01;
  scene.time = {.duration = 1.5, .fps = 10, .step = 0.01};
  scene.contact.self = true;
  if (solved == Solved::exactly) scene.solver.newton_tolerance = kExact;
  production::SceneSimulation simulation(scene);
  const auto overhang = [&] {
    return run_error::shadow_area(triangles, positions_of(simulation), Vec3::UnitZ()) -
           kPi * kPlateRadius * kPlateRadius;
  };
  const double whole = overhang();
  Drape result;
  for (int k = 1; k < scene.frame_count(); ++k) {
    const simulation::FrameReport report = simulation.advance();
    result.cpu_s += report.simulate.cpu_s;
    result.strain = report.max_strain;
    result.kinetic_energy = report.kinetic_energy;
  }
  result.coefficient = overhang() / whole;
  return result;
}

}  // namespace cusick

namespace {

// Simulates a strip for 8 s. Returns the tangent of the angle between the horizontal and the line from edge to tip.
double droop(const scene::Material& material, double overhang) {
  constexpr int kCells = 40;
  const double l = overhang / kCells, width = 0.025;
  scene::Scene scene = sheet_alone({overhang + l, width}, kCells + 2, 3, material);
  scene.time = {.duration = 8, .fps = 1, .step = 0.04};
  scene.solver.newton_tolerance = 1e-3;
  scene::Cloth& cloth = scene.cloths[0];
  cloth.pose.position = {0.5 * cloth.size.x() - l, 0, 0};  // the last held column is at x = 0
  scene::Pin clamp;
  clamp.high = {1.1 / (kCells + 1), 1};
  cloth.pins = {clamp};
  production::SceneSimulation simulation(scene);
  for (int k = 1; k < scene.frame_count(); ++k) simulation.advance();
  const Vec3& tip = positions_of(simulation)[2 * (kCells + 2) - 1];
  return -tip.z() / tip.x();
}

}  // namespace

Cantilever cantilever(const scene::Material& material) {
  const double target_slope = std::tan(41.5 * kPi / 180), weight = material.density * kGravity;
  // droop() grows with about the cube of a small overhang, and with a lower power of a larger one. The iteration
  // assumes the power 2.5, and converges to 1e-3 of the length within a few attempts.
  double overhang = 2 * std::cbrt(material.bend / weight);
  for (int attempt = 0; attempt < 8; ++attempt) {
    const double change = std::pow(target_slope / droop(material, overhang), 1 / 2.5);
    overhang *= change;
    if (std::abs(change - 1) < 1e-3) break;
  }
  return {0.5 * overhang, weight * std::pow(0.5 * overhang, 3)};
}

double extension(const scene::Material& material, Direction direction, double load) {
  constexpr double kWidth = 0.05, kLength = 0.2;
  constexpr int kThreads = 6;
  const bool warp = direction == Direction::warp;
  scene::Scene scene = warp ? sheet_alone({kWidth, kLength}, kThreads, 21, material)
                            : sheet_alone({kLength, kWidth}, 21, kThreads, material);
  // With these long steps, implicit Euler (the default) damps the swinging of the load.
  scene.time = {.duration = 20, .fps = 2, .step = 0.5};
  scene.solver.newton_tolerance = 1e-3;
  scene.physics.gravity = warp ? Vec3(0, -kGravity, 0) : Vec3(-kGravity, 0, 0);
  scene::Cloth& cloth = scene.cloths[0];
  scene::Pin top;
  top.low = warp ? Vec2(0, 1) : Vec2(1, 0);
  cloth.pins = {top};
  // Each thread carries the load on its width. The two threads at the sides have half of the width.
  for (int i = 0; i < kThreads; ++i) {
    const double fraction = static_cast<double>(i) / (kThreads - 1), width = i % (kThreads - 1) == 0 ? 0.5 : 1;
    scene::Weight weight;
    weight.low = weight.high = warp ? Vec2(fraction, 0) : Vec2(0, fraction);
    weight.mass = width / (kThreads - 1) * load * kWidth / kGravity;
    cloth.weights.push_back(weight);
  }
  production::SceneSimulation simulation(scene);
  for (int k = 1; k < scene.frame_count(); ++k) simulation.advance();
  const std::vector<Vec3>& x = positions_of(simulation);
  return (x.back() - x.front()).dot(warp ? Vec3::UnitY() : Vec3::UnitX()) / kLength - 1;
}

}  // namespace weft::bench
