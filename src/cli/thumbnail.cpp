#include <fmt/format.h>

#include <algorithm>

#include "cli/commands.hpp"
#include "cli/stages.hpp"
#include "cli/stills.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "image/png.hpp"
#include "render/saliency.hpp"

namespace weft::cli {
namespace {

void check_frame(int frame, const std::vector<int>& frames) {
  if (std::binary_search(frames.begin(), frames.end(), frame)) return;
  throw Error(ExitCode::usage, "--frame: expected one of the {} frames from {} to {}, got {}", frames.size(),
              frames.front(), frames.back(), frame);
}

struct Choice {
  frame::SnapshotPtr snapshot;
  render::Saliency saliency;
};

/// The first of the frames that tell most.
Choice most_salient(Stills& stills, const std::vector<int>& frames, Progress& progress) {
  const render::Settings& settings = stills.settings();
  const double aspect = static_cast<double>(settings.width) / settings.height;
  Choice best;
  frame::SnapshotPtr previous;
  for (const int k : frames) {
    const frame::SnapshotPtr snapshot = stills.at(k, progress);
    const double seconds = previous ? (k - previous->frame) / stills.scene().fps : 0;
    const render::Saliency saliency = render::saliency_of(*snapshot, previous.get(), seconds, settings.camera, aspect);
    if (!best.snapshot || saliency.score() > best.saliency.score()) best = {snapshot, saliency};
    previous = snapshot;
  }
  if (best.saliency.coverage == 0)
    log::warn("no frame shows any cloth: does the camera look at the scene? The first frame is drawn");
  return best;
}

std::string describe_choice(const render::Saliency& saliency, std::size_t count) {
  return fmt::format(", the most telling of {}: cloth covers {:.0f} % of the picture, folding {:.2f}, motion {:.2f}",
                     count, 100 * saliency.coverage, saliency.folding, saliency.motion);
}

}  // namespace

ExitCode thumbnail(const ThumbnailOptions& options) {
  set_thread_count(options.common.threads);
  const std::unique_ptr<Stills> stills = open_stills(options.common);
  const std::vector<int>& frames = stills->frames();
  if (options.frame) check_frame(*options.frame, frames);
  const std::filesystem::path file =
      still_file(*stills, options.output, stills->scene().scene + ".png", options.common.overwrite);
  std::string text;
  {
    Progress progress(options.common.progress, {stills->cost(options.frame.value_or(frames.back())), 1, 1});
    const Choice choice =
        options.frame ? Choice{stills->at(*options.frame, progress), {}} : most_salient(*stills, frames, progress);
    const frame::FrameSnapshot& snapshot = *choice.snapshot;
    const std::unique_ptr<FramePainter> painter = make_gl_painter(stills->settings());
    const image::Image image = painter->draw(snapshot);
    progress.advance(Stage::draw);
    const Metadata about = describe_pictures(stills->scene(), stills->settings(), painter->description());
    image::write_png(file, image, describe_still(about, snapshot.frame, snapshot.time));
    text = fmt::format("{}: frame {} (t = {:.4g} s)", file.string(), snapshot.frame, snapshot.time);
    if (!options.frame) text += describe_choice(choice.saliency, frames.size());
  }
  log::info(text);
  return ExitCode::ok;
}

}  // namespace weft::cli
