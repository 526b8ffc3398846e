#include "film/run_error/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/timer.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/run_error/shadow.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::run_error {
namespace {

constexpr int kFinestCut = 8;  // refinements are multiples of 1/8, which are exact in binary

// Whether the cloth is a grid of cells, not a mesh from a file, a sewing pattern or a rope.
bool is_grid(const scene::Cloth& cloth) {
  return scene::rectangle_particles(cloth) > 0;
}

// Sum over all cloths of the projected area, or of the surface area if `up` is zero [m²].
double area_of(const frame::FrameSnapshot& snapshot, std::size_t cloths, const Vec3& up) {
  double area = 0;
  for (std::size_t c = 0; c < cloths; ++c) {
    const auto& triangles = snapshot.surfaces[c]->triangles;
    const auto& x = snapshot.states[c].positions;
    area += up == Vec3::Zero() ? mesh::surface_area(triangles, x) : shadow_area(triangles, x, up);
  }
  return area;
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  constexpr std::string_view kNames[kQuantities] = {"position", "velocity", "energy", "energy drift",
                                                    "centre",   "top",      "shadow", "rest energy"};
  return kNames[static_cast<std::size_t>(quantity)];
}

std::string_view unit_of(Quantity quantity) {
  constexpr std::string_view kUnits[kQuantities] = {"m", "m/s", "1", "1", "m", "m", "1", "1"};
  return kUnits[static_cast<std::size_t>(quantity)];
}

Recorder::Recorder(const scene::Scene& scene, const frame::FrameSnapshot& start, const simulation::FrameReport& report)
    : cloths_(scene.cloths.size()),
      up_(scene::up_vector(scene.up)),
      start_area_(area_of(start, cloths_, Vec3::Zero())),
      kinetic_(report.kinetic_energy),
      elastic_(report.elastic_energy),
      low_(report.potential_energy),
      high_(report.potential_energy) {}

void Recorder::add_frame(const frame::SnapshotPtr& snapshot, const simulation::FrameReport& report,
                         std::span<const Vec3> velocities) {
  kinetic_ = std::max(kinetic_, report.kinetic_energy);
  elastic_ = std::max(elastic_, report.elastic_energy);
  low_ = std::min(low_, report.potential_energy);
  high_ = std::max(high_, report.potential_energy);
  Functionals& functionals = trajectory_.functionals;
  functionals.rest_energy = report.potential_energy + report.elastic_energy;
  functionals.energy.push_back(functionals.rest_energy + report.kinetic_energy);
  Trajectory::Frame& frame = trajectory_.frames.emplace_back();
  for (std::size_t c = 0; c < cloths_; ++c)
    frame.x.insert(frame.x.end(), snapshot->states[c].positions.begin(), snapshot->states[c].positions.end());
  frame.v.assign(velocities.begin(), velocities.end());
  Work& work = trajectory_.work;
  work.cpu_s += report.simulate.cpu_s;
  work.steps += report.steps;
  work.rejected_steps += report.rejected_steps;
  work.newton_iterations += report.newton_iterations;
  work.linear_iterations += report.linear_iterations;
  last_ = snapshot;
}

Trajectory Recorder::finish(std::span<const double> masses) {
  Functionals& functionals = trajectory_.functionals;
  functionals.energies_in_play = kinetic_ + elastic_ + high_ - low_;
  trajectory_.masses.assign(masses.begin(), masses.end());
  if (last_ == nullptr || cloths_ == 0) return std::move(trajectory_);
  // Ropes have no area.
  if (start_area_ > 0) functionals.shadow = area_of(*last_, cloths_, up_) / start_area_;
  const std::vector<Vec3>& x = trajectory_.frames.back().x;
  functionals.top = up_.dot(x.front());
  double mass = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    functionals.top = std::max(functionals.top, up_.dot(x[i]));
    functionals.centre += masses[i] * x[i];
    mass += masses[i];
  }
  functionals.centre /= mass;
  return std::move(trajectory_);
}

Trajectory follow(const scene::Scene& scene, const FollowLimits& limits) {
  production::SceneSimulation simulation(scene);
  const auto proceed = [&] { return !limits.proceed || limits.proceed(); };
  if (!simulation.run_preroll(proceed)) throw Error(ExitCode::interrupted, "interrupted before frame 0");
  Recorder recorder(scene, *simulation.snapshot(), simulation.initial_report());
  int steps = 0;
  double cpu_s = 0;
  for (int k = 1; k < scene.frame_count() && k <= limits.last_frame; ++k) {
    if (!proceed()) throw Error(ExitCode::interrupted, "interrupted before frame {}", k);
    const double start = process_cpu_seconds();
    const simulation::FrameReport report = simulation.advance();
    cpu_s += process_cpu_seconds() - start;
    steps += report.steps + report.rejected_steps;
    if (steps > limits.steps)
      throw Error(ExitCode::simulation_failed,
                  "frame {}: stopped, as this setting takes more than {} steps, which are too short to compare; use a "
                  "larger time.tolerance or newton_tolerance",
                  k, limits.steps);
    recorder.add_frame(simulation.snapshot(), report, simulation.state().velocities);
  }
  Trajectory trajectory = recorder.finish(simulation.state().masses);
  trajectory.work.cpu_s = cpu_s;
  return trajectory;
}

Errors compare(const Functionals& run, const Functionals& reference) {
  Errors errors{};
  // If nothing moves, the energies in play are only rounding errors. Then errors of energy are not divided by them.
  constexpr double kRounding = 1e-12;  // [J]
  const double in_play = reference.energies_in_play > kRounding ? reference.energies_in_play : 1;
  for (std::size_t k = 0; k < run.energy.size(); ++k) {
    at(errors, Quantity::drift) = std::abs(run.energy[k] - reference.energy[k]) / in_play;
    at(errors, Quantity::energy) = std::max(at(errors, Quantity::energy), at(errors, Quantity::drift));
  }
  at(errors, Quantity::shadow) = std::abs(run.shadow - reference.shadow);
  at(errors, Quantity::top) = std::abs(run.top - reference.top);
  at(errors, Quantity::rest_energy) = std::abs(run.rest_energy - reference.rest_energy) / in_play;
  at(errors, Quantity::centre) = (run.centre - reference.centre).norm();
  return errors;
}

Errors compare(const Trajectory& run, const Trajectory& reference, const std::vector<std::size_t>& same) {
  Errors errors = compare(run.functionals, reference.functionals);
  double mass = 0;
  for (double m : run.masses) mass += m;
  for (std::size_t k = 0; k < run.frames.size(); ++k) {
    const Trajectory::Frame &a = run.frames[k], &b = reference.frames[k];
    const bool speeds = !a.v.empty() && !b.v.empty();
    double positions = 0, velocities = 0;
    for (std::size_t i = 0; i < a.x.size(); ++i) {
      const std::size_t j = same.empty() ? i : same[i];
      positions += run.masses[i] * (a.x[i] - b.x[j]).squaredNorm();
      if (speeds) velocities += run.masses[i] * (a.v[i] - b.v[j]).squaredNorm();
    }
    at(errors, Quantity::position) = std::max(at(errors, Quantity::position), std::sqrt(positions / mass));
    at(errors, Quantity::velocity) = std::max(at(errors, Quantity::velocity), std::sqrt(velocities / mass));
  }
  return errors;
}

double cloth_size(const frame::FrameSnapshot& snapshot) {
  double largest = 0;
  for (std::size_t s = 0; s < snapshot.surfaces.size(); ++s) {
    const frame::ObjectKind kind = snapshot.surfaces[s]->kind;
    if (kind != frame::ObjectKind::cloth && kind != frame::ObjectKind::rope) continue;
    const Box3 box = mesh::bounding_box(snapshot.states[s].positions);
    if (!box.isEmpty()) largest = std::max(largest, box.sizes().maxCoeff());
  }
  return largest;
}

Functionals median(const std::vector<Functionals>& samples) {
  const auto of = [&](const auto& number) {
    std::vector<double> values;
    for (const Functionals& sample : samples) values.push_back(number(sample));
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  };
  Functionals middle = samples.front();
  for (std::size_t k = 0; k < middle.energy.size(); ++k)
    middle.energy[k] = of([k](const Functionals& f) { return f.energy[k]; });
  middle.energies_in_play = of([](const Functionals& f) { return f.energies_in_play; });
  middle.shadow = of([](const Functionals& f) { return f.shadow; });
  middle.top = of([](const Functionals& f) { return f.top; });
  middle.rest_energy = of([](const Functionals& f) { return f.rest_energy; });
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    middle.centre[axis] = of([axis](const Functionals& f) { return f.centre[axis]; });
  return middle;
}

bool can_refine(const scene::Scene& scene, double refinement) {
  if (std::floor(refinement * kFinestCut) != refinement * kFinestCut) return false;
  const auto whole = [&](int particles) {
    const int eighths = (particles - 1) * static_cast<int>(refinement * kFinestCut);
    return eighths % kFinestCut == 0 && eighths >= 2 * kFinestCut;
  };
  return std::all_of(scene.cloths.begin(), scene.cloths.end(), [&](const scene::Cloth& cloth) {
    return is_grid(cloth) && whole(cloth.particles_weft) && whole(cloth.particles_warp);
  });
}

void refine(scene::Scene& scene, double refinement) {
  const auto refined = [&](int particles) { return static_cast<int>((particles - 1) * refinement) + 1; };
  for (scene::Cloth& cloth : scene.cloths) {
    if (!is_grid(cloth)) continue;
    cloth.particles_weft = refined(cloth.particles_weft);
    cloth.particles_warp = refined(cloth.particles_warp);
  }
}

std::vector<std::size_t> matching_particles_in_refined(const scene::Scene& scene) {
  std::vector<std::size_t> same;
  std::size_t first = 0;
  for (const scene::Cloth& cloth : scene.cloths) {
    const auto nu = static_cast<std::size_t>(cloth.particles_weft), nv = static_cast<std::size_t>(cloth.particles_warp);
    const std::size_t fine_nu = 2 * nu - 1, fine_nv = 2 * nv - 1;
    for (std::size_t j = 0; j < nv; ++j)
      for (std::size_t i = 0; i < nu; ++i) same.push_back(first + 2 * i + fine_nu * 2 * j);
    // Particles in the middle of crossed cells come after those of the grid. They lie on grid points of the finer mesh.
    const bool crossed = cloth.shape == scene::ClothShape::crossed_triangles;
    for (std::size_t j = 0; crossed && j + 1 < nv; ++j)
      for (std::size_t i = 0; i + 1 < nu; ++i) same.push_back(first + 2 * i + 1 + fine_nu * (2 * j + 1));
    first += fine_nu * fine_nv + (crossed ? (fine_nu - 1) * (fine_nv - 1) : 0);
  }
  return same;
}

}  // namespace weft::run_error
