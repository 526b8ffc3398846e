// Measures the cost of runs of a scene with several sizes, numbers of threads and steps: CPU and wall time of each
// stage, iterations, memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/scene/scene.hpp"

namespace weft::bench {

enum class SpeedStage : std::size_t {
  forces,          ///< evaluating forces and assembling the matrix
  preconditioner,  ///< setting up the preconditioner, and applying it outside of linear solves
  linear,          ///< linear solves
  collisions,
  rest,  ///< remainder of the simulation: vector operations of Newton's method, energies, snapshots
  drawing,
};
inline constexpr std::size_t kSpeedStages = 6;
std::string_view name_of(SpeedStage stage);

/// The values that differ between runs.
struct SpeedSetting {
  double size = 1;  ///< number of particles along each side, relative to the scene
  int threads = 1;
  double step = 1;  ///< time.step or time.tolerance, relative to the scene
};

/// Cost of one run.
struct SpeedRun {
  SpeedSetting setting;
  std::string failure = {};  ///< why the run gave no measurement; empty if it did
  /// Numbers of particles and of 3 × 3 blocks of the matrix. Isotropic blocks are multiples of the identity; all others
  /// are full.
  std::int64_t particles = 0, full_blocks = 0, isotropic_blocks = 0;
  int frames = 0;  ///< number of measured frames; counts and times below are sums over these frames
  int steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;
  std::array<StageTime, kSpeedStages> stages{};
  LoopCounts loops = {};  ///< zero if the run had several threads
  /// Resident memory of the process before the scene is built, and maximum during the run [bytes].
  std::int64_t memory_before = 0, peak_memory = 0;
  double bandwidth = 0;         ///< see read_bandwidth() [bytes/s]
  std::uint64_t positions = 0;  ///< hash of the positions in the last frame, to compare the bits of runs

  bool failed() const { return !failure.empty(); }
  const StageTime& at(SpeedStage stage) const { return stages[static_cast<std::size_t>(stage)]; }
  StageTime& at(SpeedStage stage) { return stages[static_cast<std::size_t>(stage)]; }
  /// Sum over all stages.
  StageTime all() const;
  double bytes_a_particle() const;
  /// Fraction of the wall time that the run spends outside of parallel loops of the simulation, drawing included. Only
  /// for runs with one thread.
  double serial_fraction() const;
  /// Upper bound on the speed-up with LoopCounts::kThreads[number] threads: starting and synchronising threads takes no
  /// time, and all chunks of a loop take equal times. Only for runs with one thread.
  double largest_gain(std::size_t number) const;
};

/// Frames `begin` to `end` − 1 are measured. Earlier frames are simulated but not measured.
struct SpeedFrames {
  int begin = 1, end = 9;
};

/// Draws one frame.
using Drawing = std::function<void(const frame::FrameSnapshot&)>;
/// Runs the scene and returns its cost. The caller must have applied the size and step of `setting` to the scene
/// (overrides_of()). Call run_for_speed() in a process of its own, because it measures the memory of the process, and
/// the CPU time of all threads of the process. If `open_drawing` is given, it is called after the preroll; the Drawing
/// that it returns draws frame 0, which is not measured, and each measured frame. Throws what a simulation throws.
SpeedRun run_for_speed(const scene::Scene& scene, const SpeedSetting& setting, const SpeedFrames& frames,
                       const std::function<Drawing()>& open_drawing = {});

/// Writes or reads a run (core/archive.hpp), to transfer it between processes.
template <class Archive>
void serialize(Archive& archive, SpeedRun& run);

/// Lower bound on the bytes that one linear iteration moves through memory, if each operation reads its inputs and
/// writes its results once.
double bytes_of_linear_iteration(const SpeedRun& run);
/// The same for one Newton iteration, without its linear iterations.
double bytes_of_newton_iteration(const SpeedRun& run);
/// The memory bound: time that forces, preconditioner and linear solver would take if memory bandwidth were the only
/// limit [s]; 0 if the bandwidth is unknown.
double memory_bound_s(const SpeedRun& run);

/// Measures the rate at which thread_count() threads together read `bytes` bytes again and again [bytes/s]. This is the
/// rate of the smallest cache level that can hold these bytes, or of memory.
double read_bandwidth(double bytes);

/// The settings of all runs: each size with each number of threads, at the scene's step; and each
/// other step with the size nearest to the scene's and the first number of threads. No list may be
/// empty.
std::vector<SpeedSetting> speed_settings(const std::vector<double>& sizes, const std::vector<int>& threads,
                                         const std::vector<double>& steps);
/// Rough cost relative to SpeedSetting{1, 1, 1}; used to predict the remaining time.
double expected_work(const SpeedSetting& setting);

/// The changes that apply a setting to the scene, in the syntax of `--set`; empty if nothing changes.
std::vector<std::string> overrides_of(const scene::Scene& scene, const SpeedSetting& setting);
/// Whether the scene has a cloth to which SpeedSetting::size applies: a rectangle with a number of particles.
bool has_sizes(const scene::Scene& scene);

/// The scene that is measured if the user names none, as TOML.
extern const char* const kSphereDrape;

}  // namespace weft::bench
