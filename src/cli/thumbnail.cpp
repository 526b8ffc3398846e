#include <fmt/format.h>

#include "cli/commands.hpp"
#include "cli/output_target.hpp"
#include "cli/scene_input.hpp"
#include "cli/signals.hpp"
#include "cli/stages.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "image/png.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {
namespace {

std::filesystem::path picture_file(const ThumbnailOptions& options, const scene::Scene& scene) {
  const auto file = options.output.empty() ? std::filesystem::path("output") / (scene.name + ".png") : options.output;
  if (file.extension() != ".png") {
    throw Error(ExitCode::usage, "-o: expected a name ending in .png, got {}", file.string());
  }
  return file;
}

int chosen_frame(const ThumbnailOptions& options, const scene::Scene& scene) {
  const int count = scene.frame_count();
  const int frame = options.frame.value_or(count / 2);
  if (frame < count) return frame;
  throw Error(ExitCode::usage, "--frame: expected 0 to {}, the frames of this scene, got {}", count - 1, frame);
}

// The scene at frame k. Each frame needs all those before it.
frame::SnapshotPtr simulate_to(const scene::Scene& scene, int frame, Progress& progress) {
  const StopSignals signals;
  simulation::Simulation simulation(scene);
  const auto proceed = [&] {
    progress.advance(Stage::simulate);
    return !signals.requested();
  };
  if (!simulation.run_preroll(proceed)) throw Error(ExitCode::interrupted, "interrupted before frame 0; no picture");
  progress.advance(Stage::simulate);
  for (int k = 1; k <= frame; ++k) {
    if (signals.requested()) throw Error(ExitCode::interrupted, "interrupted before frame {}; no picture", k);
    simulation.advance();
    progress.advance(Stage::simulate);
  }
  return simulation.snapshot();
}

}  // namespace

ExitCode thumbnail(const ThumbnailOptions& options) {
  set_thread_count(options.common.threads);
  const scene::Scene scene = load_scene(options.common);
  const std::filesystem::path file = picture_file(options, scene);
  const int frame = chosen_frame(options, scene);
  check_absent(file, options.common.overwrite);
  check_writable(file);
  {
    Progress progress(options.common.progress, {scene.preroll_frames() + frame + 1, 1, 1});
    const frame::SnapshotPtr snapshot = simulate_to(scene, frame, progress);
    const render::Settings settings = render_settings(scene, options.common);
    const std::unique_ptr<FramePainter> painter = make_gl_painter(settings);
    const image::Image image = painter->draw(*snapshot);
    progress.advance(Stage::draw);
    image::write_png(file, image,
                     describe_still(describe_pictures(manifest_of(scene, settings), settings, painter->description()),
                                    frame, snapshot->time));
  }
  log::info(fmt::format("{}: frame {} (t = {:.4g} s)", file.string(), frame, frame / scene.time.fps));
  return ExitCode::ok;
}

}  // namespace weft::cli
