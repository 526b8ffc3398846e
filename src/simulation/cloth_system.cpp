#include "simulation/cloth_system.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/pins.hpp"

namespace weft::simulation {
namespace {

// Groups on the preconditioner's coarsest level at most. Its dense factorisation costs 9 kPatches³ operations: as much
// as a few products with the matrix of 4,000 particles.
constexpr Index kPatches = 70;

// Motion of a particle since the last linearisation, in spacings, up to which the matrix is good enough to find the way
// with; residuals are exact always.
constexpr double kStaleMotion = 0.005;

}  // namespace

ClothSystem::ClothSystem(const scene::Scene& scene, const environment::Environment& environment) {
  std::vector<std::pair<Index, Index>> couplings;
  Index first = 0;
  forces_.resize(scene.cloths.size());
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const scene::Material& material = scene.cloths[c].material;
    const mesh::Grid& grid = environment.cloths[c].grid;
    first_.push_back(first);
    const auto masses = forces::lumped_masses(grid, material.density);
    masses_.insert(masses_.end(), masses.begin(), masses.end());
    for (const scene::Weight& weight : scene.cloths[c].weights) {
      const std::vector<Index> carriers = particles_of(weight, grid, first);
      for (Index particle : carriers)
        masses_[static_cast<std::size_t>(particle)] += weight.mass / static_cast<double>(carriers.size());
    }

    stretch_.push_back(std::make_unique<forces::Stretch>(
        grid, first,
        forces::StretchParameters{material.stretch_weft, material.stretch_warp, material.stretch_viscosity}));
    forces_[c].push_back(stretch_.back().get());
    if (material.shear > 0 || material.shear_viscosity > 0) {
      shear_.push_back(std::make_unique<forces::Shear>(
          grid, first, forces::ShearParameters{material.shear, material.shear_viscosity}));
      forces_[c].push_back(shear_.back().get());
    }
    if (material.bend > 0 || material.bend_viscosity > 0 || material.bend_friction > 0) {
      bend_.push_back(std::make_unique<forces::Bend>(
          grid, first, forces::BendParameters{material.bend, material.bend_viscosity, material.bend_friction}));
      forces_[c].push_back(bend_.back().get());
    }
    if (scene.physics.air_density > 0 && material.drag > 0)
      air_.emplace_back(grid, first,
                        forces::AirParameters{scene.physics.air_density, scene.physics.wind, material.drag});
    first += grid.size();
  }
  first_.push_back(first);
  for (const auto& cloth : environment.cloths) spacing_ = std::min({spacing_, cloth.grid.lu, cloth.grid.lv});
  std::vector<mesh::Grid> grids;
  for (const auto& cloth : environment.cloths) grids.push_back(cloth.grid);
  cut_groups(grids);

  for (const auto& of_cloth : forces_)
    for (const forces::Force* force : of_cloth) force->couple(couplings);
  base_ = solver::BlockMatrix(first, std::move(couplings));
  for (const auto& force : stretch_) force->attach(base_);
  for (const auto& force : shear_) force->attach(base_);
  for (const auto& force : bend_) force->attach(base_);
}

// Two by two, again and again, until kPatches or fewer are left in all, or one of each cloth.
void ClothSystem::cut_groups(const std::vector<mesh::Grid>& grids) {
  struct Size {
    int u, v;
  };
  std::vector<Size> sizes;
  for (const mesh::Grid& grid : grids) sizes.push_back({grid.nu, grid.nv});
  const auto halved = [](int n) { return (n + 1) / 2; };
  do {
    solver::Grouping grouping;
    for (Size& size : sizes) {
      for (int j = 0; j < size.v; ++j)
        for (int i = 0; i < size.u; ++i) grouping.of.push_back(grouping.count + i / 2 + halved(size.u) * (j / 2));
      size = {halved(size.u), halved(size.v)};
      grouping.count += size.u * size.v;
    }
    groupings_.push_back(std::move(grouping));
  } while (groupings_.back().count > std::max(kPatches, static_cast<Index>(grids.size())));
}

void ClothSystem::explicit_forces(const integrator::State& at, double h, std::span<Vec3> force) const {
  for (const forces::Air& air : air_) air.add(at.x, at.v, masses_, h, force);
}

void ClothSystem::forces(const integrator::StagePoint& at, std::span<Vec3> force) const {
  for (std::size_t c = 0; c < forces_.size(); ++c) add_cloth_forces(c, at, force, nullptr);
  if (contacts_ != nullptr) contacts_->add_forces(at.x_end, force);
  if (constraints_ != nullptr) constraints_->add_forces(at.x_end, force);
}

// force += the forces within a cloth; their Jacobian goes into the matrix, if there is one.
void ClothSystem::add_cloth_forces(std::size_t cloth, const integrator::StagePoint& at, std::span<Vec3> force,
                                   solver::BlockMatrix* matrix) const {
  latest_.resize(forces_.size());
  Evaluated& latest = latest_[cloth];
  const auto first = static_cast<std::size_t>(first_[cloth]);
  const auto count = static_cast<std::size_t>(first_[cloth + 1]) - first;
  const std::span<const Vec3> x = at.x.subspan(first, count), v = at.v.subspan(first, count);
  const bool same = std::ranges::equal(x, latest.x) && std::ranges::equal(v, latest.v);
  if (!same || matrix != nullptr) {
    // The forces number particles through all cloths.
    evaluated_.resize(at.x.size());
    std::fill_n(evaluated_.begin() + first_[cloth], count, Vec3::Zero());
    for (const forces::Force* f : forces_[cloth]) f->add({at.x, at.v, evaluated_, matrix, at.rate});
    latest.x.assign(x.begin(), x.end());
    latest.v.assign(v.begin(), v.end());
    latest.force.assign(evaluated_.begin() + first_[cloth], evaluated_.begin() + first_[cloth + 1]);
  }
  for (std::size_t i = 0; i < count; ++i) force[first + i] += latest.force[i];
}

void ClothSystem::prepare_base(double rate) const {
  if (rate == base_rate_) return;
  base_.set_zero();
  for (std::size_t i = 0; i < masses_.size(); ++i)
    base_.add_scalar(base_.diagonal(static_cast<Index>(i)), rate * rate * masses_[i]);
  for (const auto& bend : bend_) bend->add_constant_stiffness(base_);
  base_rate_ = rate;
}

void ClothSystem::linearise(const integrator::StagePoint& at, std::span<Vec3> force,
                            solver::LinearSystem& system) const {
  if (&system != linearised_into_ || at.rate != linearised_rate_) {
    linearised_at_.clear();
    linearised_into_ = &system;
    linearised_rate_ = at.rate;
  }
  const bool all = linearised_at_.empty();
  if (all) linearised_at_.assign(at.x.begin(), at.x.end());
  prepare_base(at.rate);
  for (std::size_t c = 0; c + 1 < first_.size(); ++c) {
    if (!all && !is_stale(c, at.x)) {
      add_cloth_forces(c, at, force, nullptr);
      continue;
    }
    const auto first = static_cast<std::size_t>(first_[c]), count = static_cast<std::size_t>(first_[c + 1]) - first;
    std::copy_n(at.x.begin() + first_[c], count, linearised_at_.begin() + first_[c]);
    system.matrix.copy_rows(base_, first_[c], first_[c + 1]);
    ++system.parts[c].version;
    add_cloth_forces(c, at, force, &system.matrix);
  }
  system.terms.clear();
  system.diagonal_terms.clear();
  if (contacts_ != nullptr) contacts_->linearise(at.x_end, at.end_rate, force, system);
  if (constraints_ != nullptr) constraints_->linearise(at.x_end, at.end_rate, force, system);
}

// Whether a cloth has moved too far from where its rows of the matrix were put together.
bool ClothSystem::is_stale(std::size_t cloth, std::span<const Vec3> x) const {
  const double most = kStaleMotion * spacing_;
  for (auto i = static_cast<std::size_t>(first_[cloth]); i < static_cast<std::size_t>(first_[cloth + 1]); ++i)
    if (!((x[i] - linearised_at_[i]).squaredNorm() <= most * most)) return true;
  return false;
}

solver::LinearSystem ClothSystem::make_linear_system() const {
  solver::LinearSystem system;
  system.matrix = base_;
  system.groupings = groupings_;
  for (std::size_t c = 0; c + 1 < first_.size(); ++c) system.parts.push_back({first_[c], first_[c + 1]});
  return system;
}

double ClothSystem::elastic_energy(std::span<const Vec3> x) const {
  double sum = 0;
  for (const auto& of_cloth : forces_)
    for (const forces::Force* f : of_cloth) sum += f->energy(x);
  return sum;
}

double ClothSystem::potential_energy(std::span<const Vec3> x, const Vec3& gravity) const {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum -= masses_[i] * gravity.dot(x[i]);
  return sum;
}

double ClothSystem::kinetic_energy(std::span<const Vec3> v) const {
  double sum = 0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += 0.5 * masses_[i] * v[i].squaredNorm();
  return sum;
}

double ClothSystem::max_strain(std::span<const Vec3> x) const {
  double largest = 0;
  for (const auto& stretch : stretch_) largest = std::max(largest, stretch->max_strain(x));
  return largest;
}

std::vector<float> ClothSystem::strain_per_particle(std::size_t cloth, std::span<const Vec3> x) const {
  std::vector<float> heat(static_cast<std::size_t>(first_[cloth + 1] - first_[cloth]));
  stretch_[cloth]->strain_per_particle(x, heat);
  return heat;
}

}  // namespace weft::simulation
