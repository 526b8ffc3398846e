#include "tools/cli/output_target.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "core/error.hpp"
#include "film/video/encoder.hpp"
#include "tools/cli/option_values.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFrame = "{frame";

[[noreturn]] void bad_pattern(std::string_view text) {
  throw Error(ExitCode::usage, "-o: expected one {{frame}} or {{frame:05}} in the name of the pictures, got {}", text);
}

// Parses the minimum number of digits from the text between the braces: "frame", "frame:5" or "frame:05".
int parse_digits(std::string_view field, std::string_view text) {
  if (field == "frame") return 1;
  if (field.substr(0, 6) != "frame:") bad_pattern(text);
  const auto digits = number_in<int>(field.substr(6));
  if (!digits || *digits < 1 || *digits > 10) bad_pattern(text);
  return *digits;
}

}  // namespace

FramePattern::FramePattern(std::string_view text) {
  // Braces other than {frame...} are part of the name, for example of a folder.
  const std::size_t open = text.find(kFrame), close = text.find('}', std::min(open, text.size()));
  if (open == std::string_view::npos || close == std::string_view::npos) bad_pattern(text);
  before_ = text.substr(0, open);
  after_ = text.substr(close + 1);
  if (after_.find(kFrame) != std::string::npos) bad_pattern(text);
  digits_ = parse_digits(text.substr(open + 1, close - open - 1), text);
}

fs::path FramePattern::name(int frame) const {
  return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::vector<fs::path> FramePattern::names(const FrameRange& frames) const {
  std::vector<fs::path> names;
  for (int frame = frames.begin; frame < frames.end; frame += frames.step) names.push_back(name(frame));
  return names;
}

void FramePattern::remove_others(const FrameRange& frames,
                                 const std::function<bool(const fs::path&, int)>& is_own) const {
  // The frame number may be in the name of a folder.
  const std::size_t slash = before_.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : before_.substr(0, slash + 1);
  const std::string start = slash == std::string::npos ? before_ : before_.substr(slash + 1);
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string found = entry->path().filename().string();
    int frame = 0;
    if (!found.starts_with(start)) continue;
    const auto [stop, problem] = std::from_chars(found.data() + start.size(), found.data() + found.size(), frame);
    if (problem != std::errc() || frame < 0 || frames.contains(frame)) continue;
    std::error_code ignored;
    const fs::path file = name(frame);
    if (fs::is_regular_file(fs::symlink_status(file, ignored)) && is_own(file, frame)) fs::remove(file, ignored);
  }
}

video::Codec codec_of(const fs::path& file, const VideoOptions& options) {
  const video::Codec codec = video::codec_of(file, options.codec);
  if (codec != video::Codec::h264 && options.crf)
    throw Error(ExitCode::usage, "--crf: expected --codec h264, since the other codecs have no such setting");
  return codec;
}

fs::path OutputTarget::file(int frame) const {
  return kind == Kind::images ? FramePattern(text).name(frame) : fs::path(text);
}

OutputTarget parse_output(const std::string& text, const std::string& scene_name) {
  if (text.empty()) return {OutputTarget::Kind::video, (fs::path("output") / (scene_name + ".mp4")).string()};
  const std::string ending = fs::path(text).extension().string();
  if (video::is_written(ending)) {
    if (text.find(kFrame) != std::string::npos) {
      throw Error(ExitCode::usage, "-o: a video holds all frames, so its name has no {{frame}}, got {}", text);
    }
    return {OutputTarget::Kind::video, text};
  }
  if (ending == ".png" || ending == ".exr") {
    (void)FramePattern(text);  // checks the pattern now instead of at the first picture
    return {OutputTarget::Kind::images, text};
  }
  throw Error(ExitCode::usage,
              "-o: expected a name ending in .mp4, .mov or .mkv, or in .png or .exr with {{frame:05}} in it, got {}",
              text);
}

fs::path working_cache(const OutputTarget& target, const std::string& scene_name) {
  const fs::path file = target.file(0);
  const std::string name = target.kind == OutputTarget::Kind::video ? file.stem().string() : scene_name;
  return file.parent_path() / ("." + name + ".weft-cache");
}

std::vector<fs::path> OutputTarget::files(const FrameRange& frames) const {
  return kind == Kind::images ? FramePattern(text).names(frames) : std::vector{fs::path(text)};
}

}  // namespace weft::cli
