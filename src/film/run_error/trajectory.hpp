// Motion of a scene over all frames, and the difference between two motions.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/scene/scene.hpp"
#include "physics/simulation/frame_report.hpp"

namespace weft::run_error {

/// The quantity in which an error is measured. Position and velocity compare trajectories, which diverge chaotically
/// with contact. The others are functionals, which converge even then.
enum class Quantity : std::size_t {
  position,     ///< mass-weighted root mean square, largest over all frames [m]
  velocity,     ///< likewise [m/s]
  energy,       ///< kinetic + elastic + gravitational, largest error over all frames, relative to energies_in_play
  drift,        ///< error of the same energy in the last frame, likewise relative
  centre,       ///< centre of mass in the last frame [m]
  top,          ///< height of the highest particle in the last frame [m]
  shadow,       ///< area of all cloths seen from above in the last frame, relative to their surface area at the start
  rest_energy,  ///< elastic + gravitational in the last frame, relative to energies_in_play
};
inline constexpr std::size_t kQuantities = 8;
std::string_view name_of(Quantity quantity);
std::string_view unit_of(Quantity quantity);

/// One error per quantity.
using Errors = std::array<double, kQuantities>;
inline double& at(Errors& errors, Quantity quantity) {
  return errors[static_cast<std::size_t>(quantity)];
}
inline double at(const Errors& errors, Quantity quantity) {
  return errors[static_cast<std::size_t>(quantity)];
}

/// Properties of a motion that do not refer to single particles.
struct Functionals {
  std::vector<double> energy;   ///< kinetic, elastic and gravitational, frame by frame [J]
  double energies_in_play = 0;  ///< largest kinetic + largest elastic + range of potential energy [J]
  double shadow = 0;            ///< see Quantity::shadow
  double top = 0;               ///< [m]
  double rest_energy = 0;       ///< [J]
  Vec3 centre{0, 0, 0};         ///< [m]
};

/// Cost of a run.
struct Work {
  double cpu_s = 0;
  int steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;
};

/// Record of a run, without frame 0.
struct Trajectory {
  struct Frame {
    std::vector<Vec3> x, v;  ///< of all cloths [m, m/s]; `v` is empty if only snapshots of the run exist
  };
  std::vector<Frame> frames;
  std::vector<double> masses;
  Functionals functionals;
  Work work;
};

/// Builds a Trajectory while a run proceeds.
class Recorder {
 public:
  /// `start` and `report` are those of frame 0.
  Recorder(const scene::Scene& scene, const frame::FrameSnapshot& start, const simulation::FrameReport& report);
  /// Adds the next frame, in order. `velocities`: those of all particles, or empty.
  void see(const frame::SnapshotPtr& snapshot, const simulation::FrameReport& report,
           std::span<const Vec3> velocities = {});
  /// Returns the trajectory. `masses`: those of all particles [kg].
  Trajectory finish(std::span<const double> masses);

 private:
  std::size_t cloths_;
  Vec3 up_;
  // surface area of all cloths in frame 0 [m²]; largest kinetic and elastic, lowest and highest potential energy [J]
  double start_area_, kinetic_, elastic_, low_, high_;
  frame::SnapshotPtr last_;
  Trajectory trajectory_;
};

/// Limits on the length of a run.
struct FollowLimits {
  int last_frame = std::numeric_limits<int>::max();  ///< default: the scene's last frame
  int steps = std::numeric_limits<int>::max();       ///< maximum number of steps, including rejected ones
  std::function<bool()> proceed = {};  ///< called before each frame, also of the preroll; false: interrupt
};

/// Simulates the frames of the scene. Throws Error(simulation_failed), also for too many steps, and Error(interrupted)
/// if `proceed` returns false.
Trajectory follow(const scene::Scene& scene, const FollowLimits& limits = {});

/// Errors of the functionals; those of position and velocity are 0.
Errors compare(const Functionals& run, const Functionals& reference);
/// Errors of a motion against a reference. Particle i of `run` is compared with particle same[i] of `reference`, or
/// with particle i if `same` is empty. Velocities are compared only if both motions have them.
Errors compare(const Trajectory& run, const Trajectory& reference, const std::vector<std::size_t>& same = {});

/// Longest side of the bounding box of the largest cloth or rope [m].
double cloth_size(const frame::FrameSnapshot& snapshot);

/// The median of each value.
Functionals median(const std::vector<Functionals>& samples);

/// Whether every cloth is a grid that can have `refinement` times the cells along each side: a multiple of an eighth
/// that gives a whole number of cells, at least two.
bool can_refine(const scene::Scene& scene, double refinement);
/// Gives all cloths that are grids, which ropes are not, `refinement` times the cells along each side.
void refine(scene::Scene& scene, double refinement);

/// For each particle of the scene, the particle at the same place in the scene with twice the cells along each side.
std::vector<std::size_t> matching_particles_in_refined(const scene::Scene& scene);

}  // namespace weft::run_error
