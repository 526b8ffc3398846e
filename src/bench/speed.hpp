// What a run takes: CPU and wall time by stage, iterations and memory, over sizes, threads and steps.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/timer.hpp"
#include "frame/frame_snapshot.hpp"
#include "scene/scene.hpp"

namespace weft::bench {

enum class SpeedStage : std::size_t {
  forces,          ///< evaluated, and their matrix put together
  preconditioner,  ///< set up, and applied to residuals
  linear,          ///< iterations of the linear solver
  collisions,
  rest,  ///< of the simulation: vectors of Newton's method, energies, snapshots
  drawing,
};
inline constexpr std::size_t kSpeedStages = 6;
std::string_view name_of(SpeedStage stage);

/// What is varied from run to run.
struct SpeedSetting {
  double size = 1;  ///< particles along each side, times those of the scene
  int threads = 1;
  double step = 1;  ///< time.step or time.tolerance, times that of the scene
};

struct SpeedRun {
  SpeedSetting setting;
  std::string failure = {};  ///< why nothing is known of it; empty where all is
  std::int64_t particles = 0, full_blocks = 0, isotropic_blocks = 0;
  int frames = 0;  ///< that were measured; the counts and times below are of all of them
  int steps = 0, rejected_steps = 0, newton_iterations = 0, linear_iterations = 0;
  std::array<StageTime, kSpeedStages> stages{};
  std::int64_t memory_before = 0, peak_memory = 0;  ///< of the process: before the scene was built, and at most [bytes]
  double bandwidth = 0;                             ///< see read_bandwidth() [bytes/s]
  std::uint64_t positions = 0;                      ///< a hash of the last frame's: the same bits have the same one

  bool failed() const { return !failure.empty(); }
  const StageTime& at(SpeedStage stage) const { return stages[static_cast<std::size_t>(stage)]; }
  StageTime& at(SpeedStage stage) { return stages[static_cast<std::size_t>(stage)]; }
  /// All stages.
  StageTime all() const;
  double bytes_a_particle() const;
};

/// Which frames are measured, half-open; those before are simulated too. Frame 0 takes no time.
struct SpeedFrames {
  int begin = 1, end = 9;
};

/// Runs the scene, on so many threads, and reports what it took. For a process of its own: it says what memory that
/// took, and charges stages with the time of all its threads. `open_drawing`, if there is one, is called once the scene
/// stands, and what it returns for each frame. Throws what a simulation throws.
using Drawing = std::function<void(const frame::FrameSnapshot&)>;
SpeedRun run_for_speed(const scene::Scene& scene, const SpeedSetting& setting, const SpeedFrames& frames,
                       const std::function<Drawing()>& open_drawing = {});

/// To send it from one process to another.
template <class Archive>
void serialize(Archive& archive, SpeedRun& run);

/// Bytes that must move through the processor for one iteration of the linear solver and of Newton's method, were
/// each number read and written once for each purpose: the linear ones not counted in the latter.
double bytes_of_linear_iteration(const SpeedRun& run);
double bytes_of_newton_iteration(const SpeedRun& run);
/// Time that forces, preconditioner and linear solver take at the least, were memory all there is to wait for [s].
double memory_bound_s(const SpeedRun& run);

/// How fast this machine reads `bytes` of memory again and again, with as many threads as are set [bytes/s]: at the
/// speed of the cache that they fit into.
double read_bandwidth(double bytes);

/// The settings of all runs: every size with every number of threads; at the size nearest to the scene's and with the
/// first number of threads every step. Each list has one entry at least.
std::vector<SpeedSetting> speed_settings(const std::vector<double>& sizes, const std::vector<int>& threads,
                                         const std::vector<double>& steps);
/// What a run may take, in shares of one at 1, 1, 1: to tell how long the others will.
double expected_work(const SpeedSetting& setting);

/// As `--set` has it, what makes the scene that of a setting; empty for the scene's own.
std::vector<std::string> overrides_of(const scene::Scene& scene, const SpeedSetting& setting);
/// Whether it has a cloth with `particles`.
bool has_sizes(const scene::Scene& scene);

/// A scene to measure where none is given, as TOML.
extern const char* const kSphereDrape;

}  // namespace weft::bench
