#include "lab/bench/speed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/archive.hpp"
#include "core/memory.hpp"
#include "film/production/scene_simulation.hpp"

namespace weft::bench {
namespace {

// Lower bounds on the bytes that one linear iteration moves, in single precision. A full block has nine numbers and a
// column index; an isotropic block, one number and a column index. A particle has its preconditioner block (three
// padded vectors) and the padded vectors of conjugate gradients: direction p, product q, solution x, residual r,
// preconditioned residual z. These vectors are moved 2 + 6 + 2 + 3 times: the product reads p and writes q; the update
// reads p and q, and reads and writes x and r; the preconditioner reads r and writes z; the new direction reads z, and
// reads and writes p.
constexpr double kPaddedVec3Bytes = 16;
constexpr double kFullBlock = 9 * 4 + 4, kIsotropicBlock = 4 + 4,
                 kParticle = 3 * kPaddedVec3Bytes + (2 + 6 + 2 + 3) * kPaddedVec3Bytes;
// The same for one Newton iteration. The linearisation clears the matrix and writes it in double precision; then it
// reads the matrix and writes a copy in single precision. Each of three evaluations (linearisation, line search,
// residual after the line search) moves positions, velocities and forces. Data of the elements are not counted.
constexpr double kFullBlockAssembled = 9 * (8 + 8 + 8 + 4), kIsotropicBlockAssembled = 8 + 8 + 8 + 4,
                 kParticleEvaluated = 3 * 3 * 24;

// Typical exponents of the cost as a power of the number of particles and of 1 / step, and typical speed-up per
// additional thread. Used only to predict run times.
constexpr double kUsualExponent = 1.3, kUsualStepExponent = 0.6, kUsualGainOfAThread = 0.4;

// FNV-1a hash.
std::uint64_t hash_of(std::span<const Vec3> points) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto* bytes = reinterpret_cast<const unsigned char*>(points.data());
  for (std::size_t i = 0; i < points.size_bytes(); ++i) hash = (hash ^ bytes[i]) * 0x100000001b3;
  return hash;
}

void count(const simulation::FrameReport& report, const StageTime& whole, SpeedRun& run) {
  ++run.frames;
  run.steps += report.steps;
  run.rejected_steps += report.rejected_steps;
  run.newton_iterations += report.newton_iterations;
  run.linear_iterations += report.linear_iterations;
  StageTime rest = whole;
  const auto add = [&](SpeedStage stage, const StageTime& time) {
    run.at(stage) += time;
    rest -= time;
  };
  add(SpeedStage::forces, report.forces);
  add(SpeedStage::preconditioner, report.preconditioner);
  add(SpeedStage::linear, report.linear);
  add(SpeedStage::collisions, report.collide);
  run.at(SpeedStage::rest) += rest;
}

/// Counts parallel loops in `counts` during its lifetime; null: counts nothing.
class Counting {
 public:
  explicit Counting(LoopCounts* counts) { counted_loops = counts; }
  ~Counting() { counted_loops = nullptr; }
  Counting(const Counting&) = delete;
  Counting& operator=(const Counting&) = delete;
};

}  // namespace

std::string_view name_of(SpeedStage stage) {
  constexpr std::string_view kNames[kSpeedStages] = {"forces",     "preconditioner", "linear solver",
                                                     "collisions", "rest",           "drawing"};
  return kNames[static_cast<std::size_t>(stage)];
}

StageTime SpeedRun::all() const {
  StageTime sum;
  for (const StageTime& stage : stages) sum += stage;
  return sum;
}

double SpeedRun::bytes_a_particle() const {
  return static_cast<double>(peak_memory - memory_before) / static_cast<double>(std::max<std::int64_t>(1, particles));
}

double SpeedRun::serial_fraction() const {
  return 1 - loops.seconds / all().wall_s;
}

double SpeedRun::largest_gain(std::size_t number) const {
  const double wall = all().wall_s;
  return wall / (wall - loops.seconds + loops.seconds_on[number]);
}

SpeedRun run_for_speed(const scene::Scene& scene, const SpeedSetting& setting, const SpeedFrames& frames,
                       const std::function<Drawing()>& open_drawing) {
  set_thread_count(setting.threads);
  stopwatch_includes_all_threads = true;
  SpeedRun run{.setting = setting, .memory_before = resident_bytes()};
  production::SceneSimulation simulation(scene);
  simulation.run_preroll();
  Drawing draw;
  if (open_drawing) draw = open_drawing();
  // Drawing the first picture compiles shaders, so it is not measured.
  if (draw) draw(*simulation.snapshot());
  for (int k = 1; k < frames.end; ++k) {
    simulation::FrameReport report;
    const StageTime whole = timed([&] {
      const Counting counting(setting.threads == 1 && k >= frames.begin ? &run.loops : nullptr);
      report = simulation.advance();
      if (draw) simulation.snapshot();
    });
    if (k < frames.begin) continue;
    count(report, whole, run);
    if (draw) run.at(SpeedStage::drawing) += timed([&] { draw(*simulation.snapshot()); });
  }
  run.peak_memory = peak_memory_bytes();
  run.particles = static_cast<std::int64_t>(simulation.particles());
  const simulation::MatrixSize matrix = simulation.matrix();
  run.full_blocks = static_cast<std::int64_t>(matrix.full_blocks);
  run.isotropic_blocks = static_cast<std::int64_t>(matrix.isotropic_blocks);
  run.positions = hash_of(simulation.state().positions);
  run.bandwidth = read_bandwidth(bytes_of_linear_iteration(run));
  return run;
}

template <class Archive>
void serialize(Archive& archive, SpeedRun& run) {
  serialize_values(archive, run.setting.size, run.setting.threads, run.setting.step, run.particles, run.full_blocks,
                   run.isotropic_blocks, run.frames, run.steps, run.rejected_steps, run.newton_iterations,
                   run.linear_iterations, run.memory_before, run.peak_memory, run.bandwidth, run.positions,
                   run.loops.loops, run.loops.chunks, run.loops.seconds);
  for (double& seconds : run.loops.seconds_on) serialize_values(archive, seconds);
  for (StageTime& stage : run.stages) serialize_values(archive, stage.wall_s, stage.cpu_s);
  serialize_plain(archive, run.failure);
}
template void serialize(ByteWriter&, SpeedRun&);
template void serialize(ByteReader&, SpeedRun&);

double bytes_of_linear_iteration(const SpeedRun& run) {
  return kFullBlock * static_cast<double>(run.full_blocks) +
         kIsotropicBlock * static_cast<double>(run.isotropic_blocks) + kParticle * static_cast<double>(run.particles);
}

double bytes_of_newton_iteration(const SpeedRun& run) {
  return kFullBlockAssembled * static_cast<double>(run.full_blocks) +
         kIsotropicBlockAssembled * static_cast<double>(run.isotropic_blocks) +
         kParticleEvaluated * static_cast<double>(run.particles);
}

double memory_bound_s(const SpeedRun& run) {
  if (run.bandwidth == 0) return 0;
  return (run.linear_iterations * bytes_of_linear_iteration(run) +
          run.newton_iterations * bytes_of_newton_iteration(run)) /
         run.bandwidth;
}

double read_bandwidth(double bytes) {
  constexpr double kMinTimedSeconds = 0.05;  // shorter timings are too noisy
  const std::vector<std::uint64_t> numbers(static_cast<std::size_t>(bytes / sizeof(std::uint64_t)) + 1, 1);
  // Each thread reads its own range again and again. Threads do not wait for each other, so the time contains no
  // synchronisation.
  const auto threads = static_cast<std::size_t>(thread_count());
  const std::size_t share = (numbers.size() + threads - 1) / threads;
  const auto read = [&](int times) {
    const WallTimer timer;
    parallel_for(numbers.size(), share, [&](std::size_t begin, std::size_t end) {
      for (int k = 0; k < times; ++k) {
        std::uint64_t sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += numbers[i];
        asm volatile("" : : "r"(sum) : "memory");  // prevents the compiler from removing the loop
      }
    });
    return timer.seconds();
  };
  int times = 1;
  while (read(times) < kMinTimedSeconds) times *= 2;
  // Takes the fastest of three measurements, because other processes can only slow them down.
  double best = 0;
  for (int k = 0; k < 3; ++k)
    best = std::max(best, times * static_cast<double>(numbers.size() * sizeof numbers[0]) / read(times));
  return best;
}

std::vector<SpeedSetting> speed_settings(const std::vector<double>& sizes, const std::vector<int>& threads,
                                         const std::vector<double>& steps) {
  const double nearest = *std::min_element(
      sizes.begin(), sizes.end(), [](double a, double b) { return std::abs(std::log(a)) < std::abs(std::log(b)); });
  std::vector<SpeedSetting> settings;
  for (double size : sizes) {
    for (int count : threads) settings.push_back({size, count, 1});
    if (size != nearest) continue;
    for (double step : steps)
      if (step != 1) settings.push_back({size, threads.front(), step});
  }
  return settings;
}

double expected_work(const SpeedSetting& setting) {
  return std::pow(setting.size * setting.size, kUsualExponent) / std::pow(setting.step, kUsualStepExponent) /
         (1 + kUsualGainOfAThread * (setting.threads - 1));
}

bool has_sizes(const scene::Scene& scene) {
  return std::ranges::any_of(scene.cloths, [](const scene::Cloth& cloth) { return rectangle_particles(cloth) > 0; });
}

std::vector<std::string> overrides_of(const scene::Scene& scene, const SpeedSetting& setting) {
  std::vector<std::string> overrides;
  const auto scaled = [&](int particles) { return std::max(2L, std::lround(setting.size * particles)); };
  for (std::size_t c = 0; setting.size != 1 && c < scene.cloths.size(); ++c) {
    const scene::Cloth& cloth = scene.cloths[c];
    if (rectangle_particles(cloth) > 0)
      overrides.push_back(
          fmt::format("cloth.{}.particles=[{},{}]", c, scaled(cloth.particles_weft), scaled(cloth.particles_warp)));
  }
  if (setting.step != 1 && scene.time.tolerance)
    overrides.push_back(fmt::format("time.tolerance={}", setting.step * *scene.time.tolerance));
  else if (setting.step != 1)
    overrides.push_back(fmt::format("time.step={}", setting.step * scene.time.step));
  return overrides;
}

}  // namespace weft::bench
