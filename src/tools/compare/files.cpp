#include "tools/compare/files.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "film/video/decoder.hpp"

namespace weft::compare {
namespace {

using Outcome = FileComparison::Outcome;

constexpr std::array kVideoEndings{".mp4", ".mov", ".mkv", ".webm", ".avi"};

std::string size_problem(int width, int height, int test_width, int test_height) {
  return fmt::format("{}x{} pixels, the reference has {}x{}", test_width, test_height, width, height);
}

// Reads a mask; none if `file` is empty. A pixel is white if the mean of its channels is at least 128. Throws
// Error(asset_unreadable) if the file cannot be read, has another size or has no white pixel.
std::optional<Mask> read_mask(const std::filesystem::path& file, int width, int height) {
  if (file.empty()) return std::nullopt;
  const image::Image picture = image::read_png(file);
  if (picture.width != width || picture.height != height) {
    throw Error(ExitCode::asset_unreadable, "{}: expected a mask of {}x{} pixels, got {}x{}", file.string(), width,
                height, picture.width, picture.height);
  }
  Mask mask(width, height);
  for (std::size_t i = 0; i < mask.values.size(); ++i)
    mask.values[i] = picture.rgb[3 * i] + picture.rgb[3 * i + 1] + picture.rgb[3 * i + 2] >= 3 * 128 ? 1 : 0;
  if (std::ranges::count(mask.values, 1) == 0)
    throw Error(ExitCode::asset_unreadable, "{}: expected a mask with white pixels, which are compared", file.string());
  return mask;
}

// Compares two pictures or frames, adds the comparison to `result`, and returns the figures.
Figures add_frame(FileComparison& result, image::Image&& reference, image::Image&& test, const Limits& limits,
                  const std::optional<Mask>& mask) {
  Comparison frame = compare(reference, test, limits.pixel_tolerance, mask ? &*mask : nullptr);
  const bool differs = verdict(frame.figures, limits) == Verdict::differs;
  const Figures figures = frame.figures;
  const bool first_differing = differs && result.frames_differing == 0;
  const bool may_be_worst = differs || result.frames_differing == 0;
  if (result.frames == 0 || first_differing || (may_be_worst && frame.figures.flip > result.worst.figures.flip)) {
    result.worst_frame = result.frames;
    result.worst = std::move(frame);
    result.reference_picture = std::move(reference);
    result.test_picture = std::move(test);
  }
  if (first_differing) result.first_differing = result.frames;
  ++result.frames;
  result.frames_differing += differs;
  return figures;
}

// Recounts the frames that exceed a limit. Counts the frames that are spill separately; see
// is_spill().
void count_spill(FileComparison& result, std::span<const Figures> frames, const Limits& limits) {
  result.frames_differing = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (verdict(frames[k], limits) != Verdict::differs) continue;
    if (is_spill(frames, k, limits))
      ++result.frames_of_spill;
    else if (result.frames_differing++ == 0)
      result.first_differing = static_cast<int>(k);
  }
}

Outcome outcome_of(const FileComparison& result) {
  if (result.frames_differing > 0) return Outcome::differs;
  return result.worst.figures.pixels_changed > 0 ? Outcome::within : Outcome::same;
}

void compare_pictures(FileComparison& result, const Limits& limits, const std::filesystem::path& mask) {
  image::Image reference = image::read_png(result.reference), test = image::read_png(result.test);
  if (reference.width != test.width || reference.height != test.height) {
    result.outcome = Outcome::size;
    result.problem = size_problem(reference.width, reference.height, test.width, test.height);
    return;
  }
  const std::optional<Mask> where = read_mask(mask, reference.width, reference.height);
  add_frame(result, std::move(reference), std::move(test), limits, where);
  result.outcome = outcome_of(result);
}

// Decodes and counts the remaining frames.
int count_rest(video::Decoder& decoder) {
  int frames = 0;
  while (decoder.next()) ++frames;
  return frames;
}

void compare_videos(FileComparison& result, const Limits& limits, const std::filesystem::path& mask) {
  video::Decoder reference(result.reference), test(result.test);
  if (reference.width() != test.width() || reference.height() != test.height()) {
    result.outcome = Outcome::size;
    result.problem = size_problem(reference.width(), reference.height(), test.width(), test.height());
    return;
  }
  const std::optional<Mask> where = read_mask(mask, reference.width(), reference.height());
  std::optional<image::Image> a, b;
  std::vector<Figures> figures;
  while ((a = reference.next()), (b = test.next()), a && b)
    figures.push_back(add_frame(result, std::move(*a), std::move(*b), limits, where));
  if (reference.lossy() || test.lossy()) count_spill(result, figures, limits);
  result.outcome = outcome_of(result);
  const int reference_frames = result.frames + (a ? 1 + count_rest(reference) : 0);
  const int test_frames = result.frames + (b ? 1 + count_rest(test) : 0);
  if (reference_frames != test_frames) {
    result.outcome = Outcome::frame_count;
    result.problem = fmt::format("{} frames, the reference has {}", test_frames, reference_frames);
  } else if (result.frames == 0) {
    throw Error(ExitCode::asset_unreadable, "{}: holds no pictures", result.test.string());
  }
}

}  // namespace

bool is_video(const std::filesystem::path& file) {
  return std::find(kVideoEndings.begin(), kVideoEndings.end(), file.extension()) != kVideoEndings.end();
}

bool is_lossy_video(const std::filesystem::path& file) {
  if (!is_video(file)) return false;
  try {
    return video::Decoder(file).lossy();
  } catch (const Error&) {
    return false;
  }
}

const image::Metadata& heat_map_metadata() {
  static const image::Metadata kMetadata{{"weft_picture", "heat map of weft diff"}};
  return kMetadata;
}

bool is_heat_map(const std::filesystem::path& file) {
  if (file.extension() != ".png") return false;
  try {
    return image::read_png_metadata(file) == heat_map_metadata();
  } catch (const Error&) {
    return false;
  }
}

Limits limits_for(const Limits& limits, const std::filesystem::path& reference, const std::filesystem::path& test) {
  return is_lossy_video(reference) || is_lossy_video(test) ? with_encoder_noise(limits) : limits;
}

bool is_comparable(const std::filesystem::path& file) {
  return file.extension() == ".png" || is_video(file);
}

FileComparison compare_files(const std::filesystem::path& reference, const std::filesystem::path& test,
                             const Limits& limits, const std::filesystem::path& mask) {
  FileComparison result;
  result.name = test.filename();
  result.reference = reference;
  result.test = test;
  result.video = is_video(reference) && is_video(test);
  try {
    // compare_pictures() finds the video unreadable if only one of the two files is a video.
    result.video ? compare_videos(result, limits, mask) : compare_pictures(result, limits, mask);
  } catch (const Error& error) {
    if (error.code() != ExitCode::asset_unreadable) throw;
    result.outcome = Outcome::unreadable;
    result.problem = error.what();
  }
  return result;
}

image::Image first_picture(const std::filesystem::path& file) {
  if (!is_video(file)) return image::read_png(file);
  std::optional<image::Image> picture = video::Decoder(file).next();
  if (!picture) throw Error(ExitCode::asset_unreadable, "{}: holds no pictures", file.string());
  return std::move(*picture);
}

}  // namespace weft::compare
