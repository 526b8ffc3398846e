#include "tools/cli/whole_output.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "core/input_file.hpp"
#include "film/image/exr.hpp"
#include "film/image/png.hpp"
#include "film/video/decoder.hpp"
#include "film/video/encoder.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

// Whether an output has the expected metadata; the OpenGL implementation may differ.
bool has_expected_metadata(const Metadata& found, Metadata expected) {
  expected.erase("gl");
  // Weft writes these entries only if the setting has a value. If the current setting has no value,
  // the output must not have the entry.
  for (const char* option : {"camera", "camera_frames", "look", "motion_blur", "state"})
    if (found.contains(option) && !expected.contains(option)) return false;
  return std::ranges::all_of(expected, [&](const auto& entry) {
    const auto here = found.find(entry.first);
    return here != found.end() && here->second == entry.second;
  });
}

enum class State { absent, other, part, whole };  // `other`: of another film or with other settings

State state_of_video(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
                     Metadata expected) {
  video::Decoder decoder(target.text);
  expected["frames"] = frames.text();
  // Some codecs pad odd sizes to even ones.
  const auto near = [](int found, int wanted) { return found == wanted || found == wanted + wanted % 2; };
  const bool fits = near(decoder.width(), settings.width) && near(decoder.height(), settings.height) &&
                    decoder.codec() == video::codec_of(target.text, target.codec);
  if (!fits || !has_expected_metadata(decoder.metadata(), std::move(expected))) return State::other;
  int count = 0;
  while (decoder.next()) ++count;
  return count == frames.count() ? State::whole : State::part;
}

State state_of_picture(const fs::path& file, int frame, const render::Settings& settings, Metadata expected) {
  expected["frame"] = fmt::format("{}", frame);
  image::ExrHeader found;
  if (settings.layers) {
    found = image::read_exr_header(file);
  } else {
    const image::Image image = image::read_png(file, &found.metadata);
    found.width = image.width;
    found.height = image.height;
    constexpr std::size_t kBitDepthPlace = 24;  // offset in the file; PNG specification, 11.2.2 (IHDR)
    if (read_start(file, kBitDepthPlace + 1).back() != (settings.needs_image16 ? 16 : 8)) return State::other;
  }
  const bool fits = found.width == settings.width && found.height == settings.height;
  return fits && has_expected_metadata(found.metadata, std::move(expected)) ? State::whole : State::other;
}

bool is_file(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

// State of the video, or of the picture of frames.begin.
State state_of(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
               const Metadata& expected) {
  const fs::path file = target.file(frames.begin);
  if (!is_file(file)) return State::absent;
  try {
    if (target.kind == OutputTarget::Kind::video) return state_of_video(target, frames, settings, expected);
    return state_of_picture(file, frames.begin, settings, expected);
  } catch (const Error&) {
    return State::other;  // an unreadable file counts as one of another film
  }
}

}  // namespace

Drawn find_drawn(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
                 const Metadata& expected, const fs::path& meshes, const std::vector<std::string>& objects) {
  Drawn drawn;
  const auto look_at = [&](const FrameRange& part) {
    const State state = state_of(target, part, settings, expected);
    if (state != State::part && state != State::whole) return;
    const std::vector<fs::path> with = mesh_files(meshes, objects, part);
    drawn.own.insert(target.file(part.begin));
    drawn.own.insert(with.begin(), with.end());
    if (state == State::part || !std::ranges::all_of(with, is_file)) return;
    for (int frame = part.begin; frame < part.end; frame += part.step) drawn.frames.insert(frame);
  };
  if (target.kind == OutputTarget::Kind::video) {
    look_at(frames);
  } else {
    for (int frame = frames.begin; frame < frames.end; frame += frames.step) look_at({frame, frame + 1, 1});
  }
  return drawn;
}

}  // namespace weft::cli
