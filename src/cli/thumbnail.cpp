#include <fmt/format.h>

#include <algorithm>

#include "cli/commands.hpp"
#include "cli/scene_input.hpp"
#include "cli/stages.hpp"
#include "cli/start_picture.hpp"
#include "cli/stills.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "image/contact_sheet.hpp"
#include "image/png.hpp"
#include "render/saliency.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {
namespace {

void check_frame(int frame, const Stills& stills) {
  const std::vector<int>& frames = stills.frames();
  if (std::binary_search(frames.begin(), frames.end(), frame)) return;
  if (frame < stills.scene().frame_count)
    throw Error(ExitCode::not_whole, "frame {} is not there; weft simulate --resume makes what is missing", frame);
  throw Error(ExitCode::usage, "--frame: expected one of the {} frames from {} to {}, got {}", frames.size(),
              frames.front(), frames.back(), frame);
}

struct Still {
  frame::SnapshotPtr snapshot;
  render::Saliency saliency;
};

/// The first of the frames that tell most.
Still most_salient(Stills& stills, const std::vector<int>& frames, Progress& progress) {
  const render::Settings& settings = stills.settings();
  Still best;
  frame::SnapshotPtr previous;
  for (const int k : frames) {
    const frame::SnapshotPtr snapshot = stills.at(k, progress);
    const double seconds = previous ? (k - previous->frame) / stills.scene().fps : 0;
    const render::Saliency saliency =
        render::saliency_of(*snapshot, previous.get(), seconds, settings.camera, settings.aspect());
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

// The start as it is given, which a run may refuse: nothing is simulated.
ExitCode thumbnail_of_start(const ThumbnailOptions& options) {
  if (options.frame || std::filesystem::is_directory(options.common.scene))
    throw Error(ExitCode::usage, "--start: expected a scene and no --frame, got {}",
                options.frame ? "both" : "the cache " + options.common.scene.string());
  const std::unique_ptr<Stills> stills = open_stills(options.common);
  const std::filesystem::path file =
      still_file(*stills, options.output, stills->scene().scene + ".start.png", options.common.overwrite);
  const simulation::StartView start = simulation::view_start(load_scene(options.common));
  render::Settings settings = stills->settings();
  if (!start.places.empty() && !options.common.size) settings.height /= 2, settings.width /= 2;
  settings.camera.clear();  // each picture has a camera of its own
  const std::unique_ptr<FramePainter> painter = make_gl_painter(settings);
  settings.camera = stills->settings().camera;
  const std::vector<image::SheetPicture> pictures = draw_start(start, settings, *painter);
  const std::string said = start.places.empty() ? "nothing touches or crosses" : start.description;
  const image::Image image = start.places.empty()
                                 ? pictures.front().image
                                 : image::contact_sheet(pictures, 2, said.substr(0, said.find(':')) + ", in red");
  const Metadata about = describe_pictures(stills->scene(), settings, painter->description());
  image::write_png(file, image, describe_still(about, start.snapshot->frame, start.snapshot->time));
  log::info(fmt::format("{}: the start: {}", file.string(), said));
  return ExitCode::ok;
}

}  // namespace

ExitCode thumbnail(const ThumbnailOptions& options) {
  set_thread_count(options.common.threads);
  if (options.start) return thumbnail_of_start(options);
  const std::unique_ptr<Stills> stills = open_stills(options.common);
  const std::vector<int>& frames = stills->frames();
  if (options.frame) check_frame(*options.frame, *stills);
  const std::filesystem::path file =
      still_file(*stills, options.output, stills->scene().scene + ".png", options.common.overwrite);
  std::string text;
  {
    Progress progress(options.common.progress, {stills->cost(options.frame.value_or(frames.back())), 1, 1});
    const Still choice =
        options.frame ? Still{stills->at(*options.frame, progress), {}} : most_salient(*stills, frames, progress);
    const frame::FrameSnapshot& snapshot = *choice.snapshot;
    const std::unique_ptr<FramePainter> painter = make_gl_painter(stills->settings());
    painter->look_through(stills->camera());
    const image::Image image = painter->draw(snapshot, nullptr).image;
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
