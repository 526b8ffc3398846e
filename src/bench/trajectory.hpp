// Whole motions of a scene, and how far two of them are apart.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "frame/frame_report.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::bench {

/// What an error is measured in. The first two compare paths, which contact lets part; the others are functionals,
/// which converge even then.
enum class Quantity : std::size_t {
  position,     ///< root of the mean square over the mass, largest of all frames [m]
  velocity,     ///< likewise [m/s]
  energy,       ///< kinetic, elastic and of height, largest of all frames, in shares of the energies in play
  drift,        ///< of that energy at the end, likewise
  centre,       ///< of mass, at the end [m]
  top,          ///< height of the highest particle, at the end [m]
  shadow,       ///< area that the cloths cover seen from above, each by itself, at the end, in shares of their area
  rest_energy,  ///< elastic and of height, at the end, in shares of the energies in play
};
inline constexpr std::size_t kQuantities = 8;
std::string_view name_of(Quantity quantity);
std::string_view unit_of(Quantity quantity);

/// One error for each quantity.
using Errors = std::array<double, kQuantities>;
inline double& at(Errors& errors, Quantity quantity) {
  return errors[static_cast<std::size_t>(quantity)];
}
inline double at(const Errors& errors, Quantity quantity) {
  return errors[static_cast<std::size_t>(quantity)];
}

/// What of a motion does not name single particles.
struct Functionals {
  std::vector<double> energy;   ///< kinetic, elastic and of height, frame by frame [J]
  double energies_in_play = 0;  ///< most kinetic and elastic energy, and largest fall [J]
  double shadow = 0;            ///< in shares of the area at the start
  double top = 0;               ///< [m]
  double rest_energy = 0;       ///< [J]
  Vec3 centre{0, 0, 0};         ///< [m]
};

/// What a run took.
struct Work {
  double cpu_s = 0;
  int steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;
};

/// All that is kept of a run, frame by frame, frame 0 not counted.
struct Trajectory {
  struct Frame {
    std::vector<Vec3> x, v;  ///< of all cloths; without v where only pictures of the run are there
  };
  std::vector<Frame> frames;
  std::vector<double> masses;
  Functionals functionals;
  Work work;
};

/// Keeps what a run shows of itself.
class Recorder {
 public:
  /// Frame 0 of the scene.
  Recorder(const scene::Scene& scene, const frame::FrameSnapshot& start, const frame::FrameReport& report);
  /// One of the frames after it, in order; `velocities` of all particles, or none.
  void see(const frame::SnapshotPtr& snapshot, const frame::FrameReport& report, std::span<const Vec3> velocities = {});
  /// What was seen; `masses` of all particles [kg].
  Trajectory finish(std::span<const double> masses);

 private:
  std::size_t cloths_;
  Vec3 up_;
  double start_area_, kinetic_, elastic_, low_, high_;  // most, most; of the potential energy
  frame::SnapshotPtr last_;
  Trajectory trajectory_;
};

/// Where a run is to end.
struct FollowLimits {
  int last_frame = std::numeric_limits<int>::max();  ///< else that of the scene
  int steps = std::numeric_limits<int>::max();       ///< rejected ones count
  std::function<bool()> proceed = {};                ///< asked before each frame
};

/// Simulates the frames of the scene. Throws Error(simulation_failed), or Error(interrupted) where `proceed` says no.
Trajectory follow(const scene::Scene& scene, const FollowLimits& limits = {});

/// Errors of functionals alone; the others are 0.
Errors compare(const Functionals& run, const Functionals& reference);
/// Errors of a motion against a reference. Particle i of the one is particle same[i] of the other; an empty list: all
/// are the same. Velocities that one of the two has not are not compared.
Errors compare(const Trajectory& run, const Trajectory& reference, const std::vector<std::size_t>& same = {});

/// Longest side of the box around the largest cloth [m].
double cloth_size(const frame::FrameSnapshot& snapshot);

/// The median of each number.
Functionals median(const std::vector<Functionals>& samples);

/// The scene with a mesh that has `refinement` times the cells along each side; whether its cells can be cut so.
bool can_refine(const scene::Scene& scene, double refinement);
void refine(scene::Scene& scene, double refinement);

/// Which particles of a scene with twice the cells lie where those of this scene are.
std::vector<std::size_t> same_in_twice_as_fine(const scene::Scene& scene);

}  // namespace weft::bench
