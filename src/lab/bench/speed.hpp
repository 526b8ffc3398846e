// Cost of a run: CPU and wall time by stage, iterations and memory, for several sizes, thread counts and steps.
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
  forces,          ///< force evaluation and matrix assembly
  preconditioner,  ///< set-up, and application to residuals
  linear,          ///< iterations of the linear solver
  collisions,
  rest,  ///< rest of the simulation: vector operations of Newton's method, energies, snapshots
  drawing,
};
inline constexpr std::size_t kSpeedStages = 6;
std::string_view name_of(SpeedStage stage);

/// The values that differ between runs.
struct SpeedSetting {
  double size = 1;  ///< particles along each side, relative to the scene
  int threads = 1;
  double step = 1;  ///< time.step or time.tolerance, relative to the scene
};

struct SpeedRun {
  SpeedSetting setting;
  std::string failure = {};  ///< why the run gave no measurement; empty if it did
  std::int64_t particles = 0, full_blocks = 0, isotropic_blocks = 0;  ///< isotropic: multiple of the 3 × 3 identity
  int frames = 0;  ///< number of measured frames; the counts and times below are sums over them
  int steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;
  std::array<StageTime, kSpeedStages> stages{};
  LoopCounts loops = {};                            ///< if the run had one thread, else zero
  std::int64_t memory_before = 0, peak_memory = 0;  ///< of the process, before building the scene and at its peak
                                                    ///< [bytes]
  double bandwidth = 0;                             ///< see read_bandwidth() [bytes/s]
  std::uint64_t positions = 0;  ///< hash of the positions in the last frame; equal bits give equal hashes

  bool failed() const { return !failure.empty(); }
  const StageTime& at(SpeedStage stage) const { return stages[static_cast<std::size_t>(stage)]; }
  StageTime& at(SpeedStage stage) { return stages[static_cast<std::size_t>(stage)]; }
  /// Sum over all stages.
  StageTime all() const;
  double bytes_a_particle() const;
  /// Fraction of the wall time in which further threads would have nothing to do. Only for runs with one thread, as is
  /// largest_gain().
  double serial_fraction() const;
  /// Speed-up that LoopCounts::kThreads[number] threads would give if threads cost nothing.
  double largest_gain(std::size_t number) const;
};

/// Measured frames `begin` to `end` − 1; earlier frames are simulated too. Frame 0, the initial state, takes no time.
struct SpeedFrames {
  int begin = 1, end = 9;
};

/// Draws one frame.
using Drawing = std::function<void(const frame::FrameSnapshot&)>;
/// Runs the scene, to which the caller has applied the size and step of `setting` (overrides_of()), and returns its
/// cost. Call it in a process of its own: it measures the memory of the process, and assigns the CPU time of all its
/// threads to stages. If `open_drawing` is given, it is called after the preroll; the function that it returns then
/// draws frame 0, which is not measured, and each measured frame. Throws what a simulation throws.
SpeedRun run_for_speed(const scene::Scene& scene, const SpeedSetting& setting, const SpeedFrames& frames,
                       const std::function<Drawing()>& open_drawing = {});

/// Transfers a run from one process to another.
template <class Archive>
void serialize(Archive& archive, SpeedRun& run);

/// Lower bound on the bytes that one linear iteration moves through memory: each operation reads its inputs and writes
/// its results once.
double bytes_of_linear_iteration(const SpeedRun& run);
/// The same for one Newton iteration, without its linear iterations.
double bytes_of_newton_iteration(const SpeedRun& run);
/// Time that forces, preconditioner and linear solver would take if memory bandwidth were the only limit [s]; 0 if the
/// bandwidth is unknown.
double memory_bound_s(const SpeedRun& run);

/// Speed at which thread_count() threads read the same `bytes` bytes repeatedly [bytes/s]. It is the speed of the
/// smallest cache level that holds these bytes, or of memory.
double read_bandwidth(double bytes);

/// The settings of all runs: every size with every number of threads; and every step at the size nearest to the
/// scene's, with the first number of threads. Each list must have at least one entry.
std::vector<SpeedSetting> speed_settings(const std::vector<double>& sizes, const std::vector<int>& threads,
                                         const std::vector<double>& steps);
/// Rough cost relative to SpeedSetting{1, 1, 1}; used to predict the remaining time.
double expected_work(const SpeedSetting& setting);

/// The changes, in the syntax of `--set`, that apply a setting to the scene; empty if nothing changes.
std::vector<std::string> overrides_of(const scene::Scene& scene, const SpeedSetting& setting);
/// Whether the scene has a cloth whose size is given by `particles`.
bool has_sizes(const scene::Scene& scene);

/// The scene that is measured if the user names none, as TOML.
extern const char* const kSphereDrape;

}  // namespace weft::bench
