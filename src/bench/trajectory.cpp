#include "bench/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "bench/shadow.hpp"
#include "core/error.hpp"
#include "core/timer.hpp"
#include "mesh/geometry.hpp"
#include "simulation/simulation.hpp"

namespace weft::bench {
namespace {

constexpr int kFinestCut = 8;  // cells of a scene are cut into eighths of a cell at the least; exact in binary

Vec3 up_of(const scene::Scene& scene) {
  return scene.up == scene::UpAxis::z ? Vec3::UnitZ() : Vec3::UnitY();
}

// Of all cloths, each by itself: shadow, or where `up` is zero the area of the surface [m²].
double area_of(const frame::FrameSnapshot& snapshot, std::size_t cloths, const Vec3& up) {
  double area = 0;
  for (std::size_t c = 0; c < cloths; ++c) {
    const auto& triangles = snapshot.surfaces[c]->triangles;
    const auto& x = snapshot.states[c].positions;
    area += up == Vec3::Zero() ? mesh::surface_area(triangles, x) : shadow_area(triangles, x, up);
  }
  return area;
}

/// Energies in play, gathered from frame to frame: what an error of energy is measured against.
class EnergiesInPlay {
 public:
  explicit EnergiesInPlay(const simulation::FrameReport& start)
      : low_(start.potential_energy), high_(start.potential_energy) {
    see(start);
  }
  void see(const simulation::FrameReport& report) {
    kinetic_ = std::max(kinetic_, report.kinetic_energy);
    elastic_ = std::max(elastic_, report.elastic_energy);
    low_ = std::min(low_, report.potential_energy);
    high_ = std::max(high_, report.potential_energy);
  }
  double sum() const { return kinetic_ + elastic_ + high_ - low_; }

 private:
  double kinetic_ = 0, elastic_ = 0, low_, high_;
};

void measure_end(const scene::Scene& scene, const frame::FrameSnapshot& snapshot, double start_area,
                 Trajectory& trajectory) {
  const Vec3 up = up_of(scene);
  const std::vector<Vec3>& x = trajectory.frames.back().x;
  trajectory.shadow = area_of(snapshot, scene.cloths.size(), up) / start_area;
  trajectory.top = up.dot(x.front());
  double mass = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    trajectory.top = std::max(trajectory.top, up.dot(x[i]));
    trajectory.centre += trajectory.masses[i] * x[i];
    mass += trajectory.masses[i];
  }
  trajectory.centre /= mass;
}

}  // namespace

Trajectory follow(const scene::Scene& scene, int step_limit, Run& run) {
  simulation::Simulation simulation(scene);
  Trajectory trajectory;
  const auto masses = simulation.state().masses;
  trajectory.masses.assign(masses.begin(), masses.end());
  run.particles = static_cast<int>(masses.size());
  run.steps = run.rejected_steps = run.newton_iterations = run.linear_iterations = 0;
  run.cpu_s = 0;
  const double start_area = area_of(*simulation.snapshot(), scene.cloths.size(), Vec3::Zero());
  EnergiesInPlay energies(simulation.initial_report());
  for (int k = 1; k < scene.frame_count(); ++k) {
    const double start = process_cpu_seconds();
    const simulation::FrameReport report = simulation.advance();
    run.cpu_s += process_cpu_seconds() - start;
    run.steps += report.steps;
    run.rejected_steps += report.rejected_steps;
    run.newton_iterations += report.newton_iterations;
    run.linear_iterations += report.linear_iterations;
    if (run.steps + run.rejected_steps > step_limit)
      throw Error(ExitCode::simulation_failed, "frame {}: stopped after more than {} steps", k, step_limit);
    const simulation::ParticleState state = simulation.state();
    energies.see(report);
    trajectory.rest_energy = report.potential_energy + report.elastic_energy;
    trajectory.frames.push_back({{state.positions.begin(), state.positions.end()},
                                 {state.velocities.begin(), state.velocities.end()},
                                 trajectory.rest_energy + report.kinetic_energy});
  }
  trajectory.energies_in_play = energies.sum();
  measure_end(scene, *simulation.snapshot(), start_area, trajectory);
  return trajectory;
}

Errors compare(const Trajectory& run, const Trajectory& reference, const std::vector<std::size_t>& same) {
  Errors errors{};
  const auto error = [&](Quantity quantity) -> double& { return errors[static_cast<std::size_t>(quantity)]; };
  double mass = 0;
  for (double m : run.masses) mass += m;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    const Trajectory::Frame &a = run.frames[k], &b = reference.frames[k];
    double positions = 0, velocities = 0;
    for (std::size_t i = 0; i < a.x.size(); ++i) {
      const std::size_t j = same.empty() ? i : same[i];
      positions += run.masses[i] * (a.x[i] - b.x[j]).squaredNorm();
      velocities += run.masses[i] * (a.v[i] - b.v[j]).squaredNorm();
    }
    error(Quantity::position) = std::max(error(Quantity::position), std::sqrt(positions / mass));
    error(Quantity::velocity) = std::max(error(Quantity::velocity), std::sqrt(velocities / mass));
    error(Quantity::energy) =
        std::max(error(Quantity::energy), std::abs(a.energy - b.energy) / reference.energies_in_play);
  }
  error(Quantity::shadow) = std::abs(run.shadow - reference.shadow);
  error(Quantity::top) = std::abs(run.top - reference.top);
  error(Quantity::rest_energy) = std::abs(run.rest_energy - reference.rest_energy) / reference.energies_in_play;
  error(Quantity::centre) = (run.centre - reference.centre).norm();
  return errors;
}

bool can_refine(const scene::Scene& scene, double refinement) {
  const auto whole = [&](int particles) {
    const int eighths = (particles - 1) * static_cast<int>(refinement * kFinestCut);
    return eighths % kFinestCut == 0 && eighths >= 2 * kFinestCut;
  };
  return std::all_of(scene.cloths.begin(), scene.cloths.end(), [&](const scene::Cloth& cloth) {
    return cloth.shape != scene::ClothShape::mesh && whole(cloth.particles_weft) && whole(cloth.particles_warp);
  });
}

void refine(scene::Scene& scene, double refinement) {
  const auto refined = [&](int particles) { return static_cast<int>((particles - 1) * refinement) + 1; };
  for (scene::Cloth& cloth : scene.cloths) {
    if (cloth.shape == scene::ClothShape::mesh) continue;
    cloth.particles_weft = refined(cloth.particles_weft);
    cloth.particles_warp = refined(cloth.particles_warp);
  }
}

std::vector<std::size_t> same_in_twice_as_fine(const scene::Scene& scene) {
  std::vector<std::size_t> same;
  std::size_t first = 0;
  for (const scene::Cloth& cloth : scene.cloths) {
    const auto nu = static_cast<std::size_t>(cloth.particles_weft), nv = static_cast<std::size_t>(cloth.particles_warp);
    const std::size_t fine_nu = 2 * nu - 1, fine_nv = 2 * nv - 1;
    for (std::size_t j = 0; j < nv; ++j)
      for (std::size_t i = 0; i < nu; ++i) same.push_back(first + 2 * i + fine_nu * 2 * j);
    // The middles of crossed cells, which come last, lie on the finer grid.
    const bool crossed = cloth.shape == scene::ClothShape::crossed_triangles;
    for (std::size_t j = 0; crossed && j + 1 < nv; ++j)
      for (std::size_t i = 0; i + 1 < nu; ++i) same.push_back(first + 2 * i + 1 + fine_nu * (2 * j + 1));
    first += fine_nu * fine_nv + (crossed ? (fine_nu - 1) * (fine_nv - 1) : 0);
  }
  return same;
}

}  // namespace weft::bench
