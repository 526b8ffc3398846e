#include "tools/cli/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/memory.hpp"
#include "core/timer.hpp"
#include "film/production/scene_simulation.hpp"

namespace weft::cli {
namespace {

// Limits on wall time [s] and simulated frames of a trial; more frames hardly improve the estimate.
constexpr double kMaxTrialSeconds = 5;
constexpr int kMaxTrialFrames = 10;

std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", std::max(1.0, seconds));
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

Estimate estimate_run(const scene::Scene& scene, const render::Settings& settings) {
  Estimate estimate;
  estimate.drawn = scene.frame_count();
  const int preroll = scene.preroll_frames();
  estimate.simulated = preroll + scene.frame_count() - 1;
  const WallTimer wall;
  double begin = process_cpu_seconds();
  production::SceneSimulation simulation(scene);
  estimate.setup = process_cpu_seconds() - begin;
  estimate.start = simulation.snapshot();

  begin = process_cpu_seconds();
  const auto enough = [&] {
    return estimate.trial_frames > 0 && (wall.seconds() > kMaxTrialSeconds || estimate.trial_frames >= kMaxTrialFrames);
  };
  // run_preroll() calls its argument before each frame, so no frame has been simulated at the first call.
  int asked = -1;
  const bool shown = simulation.run_preroll([&] {
    estimate.trial_frames = ++asked;
    return !enough();
  });
  frame::SnapshotPtr before;
  if (shown) {
    estimate.trial_frames = preroll;
    for (int frame = 1; frame < scene.frame_count() && !enough(); ++frame, ++estimate.trial_frames) {
      before = simulation.snapshot();
      simulation.advance();
    }
  }
  estimate.simulate = (process_cpu_seconds() - begin) / std::max(1, estimate.trial_frames);

  const frame::SnapshotPtr picture = shown ? simulation.snapshot() : production::view_start(scene).snapshot;
  render::Renderer renderer(settings);
  renderer.draw(*picture, before.get());  // compiles the shaders
  begin = process_cpu_seconds();
  renderer.draw(*picture, before.get());
  estimate.draw = process_cpu_seconds() - begin;
  estimate.peak = peak_memory_bytes();
  return estimate;
}

std::string describe(const Estimate& estimate) {
  return fmt::format(
      "about {} of CPU time to simulate, {} to draw, {:.0f} MB of memory, estimated from {} frame{}; contacts that "
      "begin later can double or triple this",
      duration_text(estimate.simulate_total()), duration_text(estimate.draw_total()),
      1e-6 * static_cast<double>(estimate.peak), estimate.trial_frames, estimate.trial_frames == 1 ? "" : "s");
}

}  // namespace weft::cli
