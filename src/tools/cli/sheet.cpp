#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "core/timer.hpp"
#include "film/image/contact_sheet.hpp"
#include "film/image/png.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/stages.hpp"
#include "tools/cli/stills.hpp"

namespace weft::cli {
namespace {

constexpr int kPictureWidth = 400;  // [pixels]; four pictures side by side fill a screen

/// Default size of each picture on the sheet, with the aspect ratio of the scene.
PictureSize small_size(const render::Settings& settings) {
  const double height = static_cast<double>(kPictureWidth) * settings.height / settings.width;
  return {kPictureWidth, std::max(1, static_cast<int>(std::lround(height)))};
}

/// Selects `count` frames as evenly as possible, with the first and the last; the middle one if
/// `count` is 1; all frames if there are at most `count`.
std::vector<int> evenly_spaced(const std::vector<int>& frames, int count) {
  const auto all = static_cast<int>(frames.size());
  if (count >= all) return frames;
  if (count == 1) return {frames[all / 2]};
  std::vector<int> chosen;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    chosen.push_back(frames[std::lround(share * (all - 1))]);
  }
  return chosen;
}

std::string heading(const Stills& stills, const std::vector<int>& frames) {
  return fmt::format("{}   {} of {} frames at {:.4g} fps", stills.scene().scene, frames.size(),
                     stills.scene().frame_count, stills.scene().fps);
}

/// A picture with the number and the time of its frame as caption.
image::SheetPicture with_caption(image::Image picture, int frame, double time_s) {
  return {std::move(picture), fmt::format("frame {}", frame), fmt::format("{:.2f} s", time_s)};
}

/// Throws Error(usage) if the sheet is too large for a PNG, before anything is simulated.
void check_sheet_size(const Stills& stills, const std::vector<int>& frames, int columns) {
  image::Image picture;  // without pixels
  picture.width = stills.settings().width;
  picture.height = stills.settings().height;
  std::vector<image::SheetPicture> pictures;
  for (const int k : frames) pictures.push_back(with_caption(picture, k, k / stills.scene().fps));
  const image::SheetSize size = image::contact_sheet_size(pictures, columns);
  if (size.is_writable()) return;
  throw Error(ExitCode::usage,
              "--count, --columns, --size: expected a sheet of at most {0}x{0} pixels, got one of {1}x{2}",
              image::kMaxPngSide, size.width, size.height);
}

}  // namespace

ExitCode sheet(const SheetOptions& options) {
  const WallTimer timer;
  set_thread_count(options.common.threads);
  const std::unique_ptr<Stills> stills = open_stills(options.common);
  stills->set_size(options.common.size.value_or(small_size(stills->settings())));
  const render::Settings& settings = stills->settings();
  const std::vector<int> frames = evenly_spaced(stills->frames(), options.count);
  check_sheet_size(*stills, frames, options.columns);
  const auto file = still_file(*stills, options.output, stills->scene().scene + ".sheet.png", options.common.overwrite);
  {
    const auto count = static_cast<int>(frames.size());
    Progress progress(options.common.progress, {stills->cost(frames.back()), count, 1});
    std::vector<frame::SnapshotPtr> snapshots;
    for (const int k : frames) snapshots.push_back(stills->at(k, progress));
    const std::unique_ptr<FramePainter> painter = make_gl_painter(settings);
    painter->set_camera_path(stills->camera());
    std::vector<image::SheetPicture> pictures;
    for (const frame::SnapshotPtr& snapshot : snapshots) {
      pictures.push_back(with_caption(painter->draw(*snapshot, nullptr).image, snapshot->frame, snapshot->time));
      progress.advance(Stage::draw);
    }
    Metadata metadata = describe_pictures(stills->scene(), settings, painter->description());
    metadata["frames"] = fmt::format("{}", fmt::join(frames, " "));
    image::write_png(file, image::contact_sheet(pictures, options.columns, heading(*stills, frames)), metadata);
  }
  log::info(fmt::format("{}: {} of {} frames in {}", file.string(), frames.size(), stills->scene().frame_count,
                        format_duration(timer.seconds())));
  return ExitCode::ok;
}

}  // namespace weft::cli
