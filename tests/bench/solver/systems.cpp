#include "bench/solver/systems.hpp"

#include <fmt/core.h>

#include <cmath>
#include <random>

#include "physics/simulation/step_problem.hpp"
#include "support/scene_runs.hpp"

namespace weft::bench {
namespace {

constexpr double kStep = 0.01;             // [s]
constexpr double kSlope = 1.2;             // maximum slope of a fold [rad]
constexpr double kFolds = 6;               // number of folds per metre [1/m]
constexpr double kGravity = 9.81;          // [m/s²]
constexpr double kContactStiffness = 100;  // of one contact, as in scenes [N/m]
constexpr double kShearOfStretch = 0.03;   // shear stiffness of soft cloth relative to its stretch stiffness
constexpr double kMaxShear = 30;           // [N/m]; even inextensible threads can rotate against each other

// Positions of the folded sheet. The direction of each edge along u follows a sine, and its length is the rest length:
// the sheet bends, but does not stretch along u. Along v, its weight stretches it.
std::vector<Vec3> folded(const mesh::Grid& grid, double weight, double stiffness) {
  std::vector<Vec3> x(static_cast<std::size_t>(grid.size()));
  Vec3 at_u = Vec3::Zero();
  for (int i = 0; i < grid.nu; ++i) {
    Vec3 at = at_u;
    for (int j = 0; j < grid.nv; ++j) {
      x[static_cast<std::size_t>(grid.index(i, j))] = at;
      const double below = (grid.nv - 1 - j) * grid.lv;  // length of cloth below this edge [m]
      at += Vec3(0, 0, -grid.lv * (1 + weight * below / stiffness));
    }
    const double theta = kSlope * std::sin(2 * M_PI * kFolds * (i + 0.5) * grid.lu);
    at_u += grid.lu * Vec3(std::cos(theta), std::sin(theta), 0);
  }
  return x;
}

// Adds waves across the folds, 12 cm long and 6 mm high: threads of both directions bend, and stretch by up to 5 %.
void crumple(const mesh::Grid& grid, std::span<Vec3> x) {
  for (int j = 0; j < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i)
      x[static_cast<std::size_t>(grid.index(i, j))] +=
          0.006 * std::sin(2 * M_PI * (4 * i * grid.lu + 7 * j * grid.lv)) * Vec3(1, 1, 0);
}

// Adds contacts of folds with a floor behind the sheet (minimum y). In every second row, adds contacts of each crest
// with the side of the next fold.
void add_contacts(const mesh::Grid& grid, std::span<const Vec3> x, solver::LinearSystem& system) {
  const Mat3 along_y = kContactStiffness * Vec3::UnitY() * Vec3::UnitY().transpose();
  const Mat3 along_x = kContactStiffness * Vec3::UnitX() * Vec3::UnitX().transpose();
  double low = 0, high = 0;
  for (const Vec3& p : x) low = std::min(low, p.y()), high = std::max(high, p.y());
  const int fold = std::max(2, static_cast<int>((grid.nu - 1) / kFolds));
  for (int j = 0; j + 1 < grid.nv; ++j)
    for (int i = 0; i < grid.nu; ++i) {
      const Index particle = grid.index(i, j);
      const double height = (x[static_cast<std::size_t>(particle)].y() - low) / (high - low);
      if (height < 0.05) system.diagonal_terms.push_back({particle, along_y});
      const int other = i + fold;
      if (height > 0.95 && j % 2 == 0 && other + 1 < grid.nu)
        system.terms.push_back({{particle, grid.index(other, j), grid.index(other + 1, j), grid.index(other, j + 1)},
                                {-1, 0.4, 0.3, 0.3},
                                along_x});
    }
}

}  // namespace

SheetSystem sheet_system(int side, double stiffness, Pose pose) {
  const double shear = std::min(kMaxShear, kShearOfStretch * stiffness);
  const scene::Scene scene = support::scene_of_text(
      fmt::format("[time]\nduration = 1\n[[cloth]]\nname = \"sheet\"\nsize = [1, 1]\nparticles = [{0}, {0}]\n"
                  "material = {{ stretch = {1}, shear = {2} }}\n",
                  side, stiffness, shear));
  const model::Model model = environment::Environment(scene).model;
  simulation::ClothSystem cloth(model);
  simulation::StepProblem problem(cloth);
  const mesh::Grid& grid = model.cloths[0].grid;

  SheetSystem sheet;
  sheet.side = side;
  const double weight = scene.cloths[0].material.density * kGravity;  // [N/m²]
  sheet.x = folded(grid, weight, stiffness);
  if (pose == Pose::lying) crumple(grid, sheet.x);
  const std::vector<Vec3> still(sheet.x.size(), Vec3::Zero());
  sheet.b = still;
  problem.linearise({sheet.x, still, sheet.x, 1 / kStep, 1}, 0, sheet.b);
  sheet.system = problem.linear_system();
  for (const double mass : cloth.masses()) sheet.system.norm_weights.push_back(mass / (kStep * kStep));
  if (pose == Pose::hanging)
    for (int i : {0, side - 1}) sheet.system.constraints.push_back({grid.index(i, 0), Mat3::Zero()});
  else
    add_contacts(grid, sheet.x, sheet.system);

  // The right-hand side is the weight, plus random forces of the same size on square patches of all sizes from one
  // particle to the whole sheet, to excite all wavelengths.
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> noise(-kGravity, kGravity);
  for (Vec3& entry : sheet.b) entry = Vec3(0, 0, -kGravity);
  for (int width = 1; width < side; width *= 2) {
    const int patches = (side + width - 1) / width;
    std::vector<Vec3> of_patch(static_cast<std::size_t>(patches * patches));
    for (Vec3& entry : of_patch)
      for (double& component : entry) component = noise(engine);
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        sheet.b[static_cast<std::size_t>(grid.index(i, j))] +=
            of_patch[static_cast<std::size_t>(i / width + patches * (j / width))];
  }
  for (std::size_t i = 0; i < sheet.b.size(); ++i) sheet.b[i] *= cloth.masses()[i];
  for (const auto& c : sheet.system.constraints) {
    Vec3& entry = sheet.b[static_cast<std::size_t>(c.particle)];
    entry = c.free * entry;
  }
  return sheet;
}

void multiply(const solver::LinearSystem& system, std::span<const Vec3> p, std::span<Vec3> q) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  system.matrix.multiply<Vec3>(p, q, 0, at(system.matrix.rows()));
  for (const auto& term : system.diagonal_terms) q[at(term.particle)] += term.stiffness * p[at(term.particle)];
  for (const auto& term : system.terms) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 4; ++k) sum += term.weights[k] * p[at(term.particles[k])];
    const Vec3 force = term.stiffness * sum;
    for (int k = 0; k < 4; ++k) q[at(term.particles[k])] += term.weights[k] * force;
  }
  for (const auto& c : system.constraints) q[at(c.particle)] = (c.free * q[at(c.particle)]).eval();
}

}  // namespace weft::bench
