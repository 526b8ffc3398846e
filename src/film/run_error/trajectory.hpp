// The motion of a scene over all frames, and the difference between two motions.
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

/// The quantity whose error is measured. Position and velocity compare particles. With contact, the motion of particles
/// is chaotic, and these two errors do not converge. The other quantities are functionals of the whole motion, which
/// converge even with contact.
enum class Quantity : std::size_t {
  position,  ///< mass-weighted root mean square error of all particles, maximum over all frames [m]
  velocity,  ///< as `position`, but error of the velocities [m/s]
  energy,    ///< kinetic + elastic + gravitational; maximum error over all frames, relative to energies_in_play
  drift,     ///< as `energy`, but error in the last frame
  centre,    ///< centre of mass in the last frame [m]
  top,       ///< height of the highest particle in the last frame [m]
  /// Projected areas of the cloths in the last frame, seen from above, relative to the surface area
  /// of the cloths in frame 0.
  shadow,
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
  std::vector<double> energy;   ///< kinetic + elastic + gravitational energy of each frame [J]
  double energies_in_play = 0;  ///< largest kinetic + largest elastic energy + range of gravitational energy [J]
  double shadow = 0;            ///< ratio of areas, see Quantity::shadow
  double top = 0;               ///< see Quantity::top [m]
  double rest_energy = 0;       ///< see Quantity::rest_energy, but not relative [J]
  Vec3 centre{0, 0, 0};         ///< see Quantity::centre [m]
};

/// Cost of a run.
struct Work {
  double cpu_s = 0;
  int steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;
};

/// Motion and cost of a run without frame 0 and the preroll.
struct Trajectory {
  struct Frame {
    std::vector<Vec3> x, v;  ///< positions [m] and velocities [m/s] of all particles; `v` may be empty: not known
  };
  std::vector<Frame> frames;
  std::vector<double> masses;  ///< masses of all particles [kg]
  Functionals functionals;
  Work work;
};

/// Records the Trajectory of a run, frame by frame.
class Recorder {
 public:
  /// `start`, `report`: snapshot and report of frame 0.
  Recorder(const scene::Scene& scene, const frame::FrameSnapshot& start, const simulation::FrameReport& report);
  /// Adds the next frame. `velocities`: of all particles [m/s]; empty if they are not known.
  void add_frame(const frame::SnapshotPtr& snapshot, const simulation::FrameReport& report,
                 std::span<const Vec3> velocities = {});
  /// Returns the trajectory. `masses`: of all particles [kg].
  Trajectory finish(std::span<const double> masses);

 private:
  std::size_t cloths_;
  Vec3 up_;
  // start_area_: surface area of all cloths in frame 0 [m²]. kinetic_, elastic_: largest energy so far [J]. low_,
  // high_: lowest and highest gravitational energy so far [J].
  double start_area_, kinetic_, elastic_, low_, high_;
  frame::SnapshotPtr last_;
  Trajectory trajectory_;
};

/// Limits on the length of a run.
struct FollowLimits {
  int last_frame = std::numeric_limits<int>::max();  ///< by default, the run ends at the scene's last frame
  int steps = std::numeric_limits<int>::max();       ///< maximum number of steps, including rejected ones
  std::function<bool()> proceed = {};  ///< called before each frame, also of the preroll; false: interrupt
};

/// Simulates the scene and records its motion. Throws Error(simulation_failed) if the simulation fails or needs too
/// many steps, and Error(interrupted) if `proceed` returns false.
Trajectory follow(const scene::Scene& scene, const FollowLimits& limits = {});

/// Errors of the functionals of a run against a reference. The errors of position and velocity are set to 0.
Errors compare(const Functionals& run, const Functionals& reference);
/// Errors of a motion against a reference. Compares particle i of `run` with particle same[i] of `reference`; if `same`
/// is empty, with particle i. Compares velocities only if both motions have them.
Errors compare(const Trajectory& run, const Trajectory& reference, const std::vector<std::size_t>& same = {});

/// Longest side of the bounding box of the largest cloth or rope [m].
double cloth_size(const frame::FrameSnapshot& snapshot);

/// The median of each member.
Functionals median(const std::vector<Functionals>& samples);

/// Whether refine() can be used: all cloths are grids, `refinement` is a multiple of 1/8, and each side gets a whole
/// number of cells, two or more.
bool can_refine(const scene::Scene& scene, double refinement);
/// Multiplies the number of cells along each side of all cloths that are grids; other cloths and ropes do not change.
void refine(scene::Scene& scene, double refinement);

/// For each particle of the scene, the index of the particle at the same place of the cloth after refine(scene, 2). All
/// cloths must be grids.
std::vector<std::size_t> matching_particles_in_refined(const scene::Scene& scene);

}  // namespace weft::run_error
