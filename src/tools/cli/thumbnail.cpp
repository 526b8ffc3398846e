#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/log.hpp"
#include "core/parallel.hpp"
#include "film/image/contact_sheet.hpp"
#include "film/image/png.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/render/saliency.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/scene_input.hpp"
#include "tools/cli/stages.hpp"
#include "tools/cli/start_picture.hpp"
#include "tools/cli/stills.hpp"

namespace weft::cli {
namespace {

void check_frame(int frame, const Stills& stills) {
  const std::vector<int>& frames = stills.frames();
  if (std::binary_search(frames.begin(), frames.end(), frame)) return;
  if (frame < stills.scene().frame_count)
    throw Error(ExitCode::frames_missing, "frame {} is missing; weft simulate --resume simulates the missing frames",
                frame);
  throw Error(ExitCode::usage, "--frame: expected one of the {} frames from {} to {}, got {}", frames.size(),
              frames.front(), frames.back(), frame);
}

struct Still {
  frame::SnapshotPtr snapshot;
  render::Saliency saliency;
};

/// The frame with the highest saliency; if several are equal, the first of them.
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
  return fmt::format(
      ", the most informative of {}: cloth covers {:.0f} % of the picture, folding {:.2f}, motion {:.2f}", count,
      100 * saliency.coverage, saliency.folding, saliency.motion);
}

std::string picture_name(const ThumbnailOptions& options, const Stills& stills) {
  return stills.scene().scene + (options.start ? ".start.png" : ".png");
}

/// Whether `output` is a folder: it has no extension, or there are several scenes and it is an existing folder.
bool is_folder(const ThumbnailOptions& options) {
  const bool may_exist = options.scenes.size() > 1 && std::filesystem::is_directory(options.output);
  return !options.output.empty() && (!options.output.has_extension() || may_exist);
}

/// Throws Error(interrupted) if there are several scenes and a stop signal arrived while this scene was drawn.
void check_stopped(const ThumbnailOptions& options, const Stills& stills) {
  if (stills.is_stopped() && options.scenes.size() > 1)
    throw Error(ExitCode::interrupted, "interrupted after {}", options.common.scene.string());
}

/// Metadata of a picture of `snapshot`. For a film with motion blur, they contain the shutter angle 0, since the
/// thumbnail has no motion blur. If a computed camera does not use all frames of the scene, they state which it uses.
Metadata describe_thumbnail(const Stills& stills, const frame::FrameSnapshot& snapshot, const FramePainter& painter) {
  render::Settings settings = stills.settings();
  if (snapshot.stage && snapshot.stage->motion_blur > 0) settings.motion_blur = 0;
  Metadata about = describe_pictures(stills.scene(), settings, painter.description());
  if (const std::string frames = stills.camera_frames(); !frames.empty()) about["camera_frames"] = frames;
  return describe_still(about, snapshot.frame, snapshot.time);
}

// Draws the start of the scene without simulating, even if a run would refuse it.
void draw_thumbnail_of_start(const ThumbnailOptions& options) {
  if (options.frame || std::filesystem::is_directory(options.common.scene))
    throw Error(ExitCode::usage, "--start: expected a scene and no --frame, got {}",
                options.frame ? "both" : "the cache " + options.common.scene.string());
  const std::unique_ptr<Stills> stills = open_stills(options.common);
  const std::filesystem::path file =
      still_file(*stills, options.output, picture_name(options, *stills), options.common.overwrite);
  const production::StartView start = production::view_start(load_scene(options.common));
  render::Settings settings = stills->settings();
  if (!start.places.empty() && !options.common.size) settings.height /= 2, settings.width /= 2;
  settings.camera.clear();  // each picture has its own camera
  const std::unique_ptr<FramePainter> painter = make_gl_painter(settings);
  settings.camera = stills->settings().camera;
  const std::vector<image::SheetPicture> pictures = draw_start(start, settings, *painter);
  const std::string summary = start.places.empty() ? "nothing touches or crosses" : start.description;
  const image::Image image = start.places.empty()
                                 ? pictures.front().image
                                 : image::contact_sheet(pictures, 2, summary.substr(0, summary.find(':')) + ", in red");
  // No film has this picture: frame 0 follows after untangling and preroll, and has another camera if it is computed.
  Metadata about = describe_thumbnail(*stills, *start.snapshot, *painter);
  about["state"] = "the start as given";
  image::write_png(file, image, about);
  log::info(fmt::format("{}: the start: {}", file.string(), summary));
  check_stopped(options, *stills);
}

void draw_thumbnail(const ThumbnailOptions& options) {
  if (options.start) return draw_thumbnail_of_start(options);
  const std::unique_ptr<Stills> stills = open_stills(options.common);
  const std::vector<int>& frames = stills->frames();
  if (options.frame) check_frame(*options.frame, *stills);
  const std::filesystem::path file =
      still_file(*stills, options.output, picture_name(options, *stills), options.common.overwrite);
  std::string text;
  {
    Progress progress(options.common.progress, {stills->cost(options.frame.value_or(frames.back())), 1, 1});
    const Still choice =
        options.frame ? Still{stills->at(*options.frame, progress), {}} : most_salient(*stills, frames, progress);
    const frame::FrameSnapshot& snapshot = *choice.snapshot;
    const std::unique_ptr<FramePainter> painter = make_gl_painter(stills->settings());
    painter->set_camera_path(stills->camera());
    const image::Image image = painter->draw(snapshot, nullptr).image;
    progress.advance(Stage::draw);
    image::write_png(file, image, describe_thumbnail(*stills, snapshot, *painter));
    text = fmt::format("{}: frame {} (t = {:.4g} s)", file.string(), snapshot.frame, snapshot.time);
    if (!options.frame) text += describe_choice(choice.saliency, frames.size());
  }
  log::info(text);
  check_stopped(options, *stills);
}

/// Draws one picture per scene into a folder. If a scene fails, continues with the next scene.
class Batch {
 public:
  explicit Batch(const ThumbnailOptions& options)
      : options_(options),
        folder_(options.output.empty() ? "output" : options.output),
        codes_(options.scenes.size(), ExitCode::ok) {
    if (!options.output.empty() && !is_folder(options))
      throw Error(ExitCode::usage, "-o: expected a folder for the pictures of {} scenes, got {}", options.scenes.size(),
                  options.output.string());
  }

  ExitCode run() {
    const std::vector<Drawing> drawings = plan();
    std::size_t drawn = 0;
    for (const Drawing& drawing : drawings) drawn += attempt(drawing.scene, [&] { draw_thumbnail(drawing.options); });
    log::info(fmt::format("{} of {} pictures are drawn", drawn, options_.scenes.size()));
    const auto failed = std::ranges::find_if(codes_, [](ExitCode code) { return code != ExitCode::ok; });
    return failed == codes_.end() ? ExitCode::ok : *failed;
  }

 private:
  struct Drawing {
    std::size_t scene;  // index in the list of scenes
    ThumbnailOptions options;
  };

  /// Checks all scenes and output files before the first drawing. Skips scenes that cannot be read.
  std::vector<Drawing> plan() {
    std::vector<Drawing> drawings;
    PathLedger paths;
    for (std::size_t i = 0; i < options_.scenes.size(); ++i) {
      ThumbnailOptions scene_options = options_;
      scene_options.common.scene = options_.scenes[i];
      attempt(i, [&] {
        const std::unique_ptr<Stills> stills = open_stills(scene_options.common);
        scene_options.output = folder_ / picture_name(scene_options, *stills);
        stills->add_inputs(paths);
        drawings.push_back({i, scene_options});
      });
    }
    for (const Drawing& drawing : drawings) paths.writes("-o", drawing.options.output);
    paths.check_absent(options_.common.overwrite);
    paths.check_writable();
    return drawings;
  }

  /// Returns whether `work` for a scene succeeded. Reports a failure and stores its exit code; rethrows an
  /// interruption.
  bool attempt(std::size_t scene, const std::function<void()>& work) {
    try {
      work();
      return true;
    } catch (...) {
      const Failure failure = describe_failure(std::current_exception());
      if (failure.code == ExitCode::interrupted) throw;
      report(failure);
      log::info(
          fmt::format("{}: no picture, exit code {}", options_.scenes[scene].string(), static_cast<int>(failure.code)));
      codes_[scene] = failure.code;
      return false;
    }
  }

  const ThumbnailOptions& options_;
  const std::filesystem::path folder_;
  std::vector<ExitCode> codes_;  // by scene
};

}  // namespace

ExitCode thumbnail(const ThumbnailOptions& options) {
  set_thread_count(options.common.threads);
  if (options.scenes.size() > 1 || is_folder(options)) return Batch(options).run();
  ThumbnailOptions scene_options = options;
  scene_options.common.scene = options.scenes.front();
  draw_thumbnail(scene_options);
  return ExitCode::ok;
}

}  // namespace weft::cli
