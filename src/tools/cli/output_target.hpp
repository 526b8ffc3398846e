// Where a command writes pictures: to one video, to one PNG or EXR file per frame, or nowhere.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "film/video/encoder.hpp"
#include "tools/cli/frame_range.hpp"

namespace weft::cli {

/// Encoding options of a video.
struct VideoOptions {
  video::Codec codec = video::Codec::automatic;
  std::optional<int> crf;  ///< for H.264; default: 18

  bool any() const { return codec != video::Codec::automatic || crf.has_value(); }
};

/// The codec of a video file. Throws Error(usage) if the options do not fit its extension.
video::Codec codec_of(const std::filesystem::path& file, const VideoOptions& options);

/// A file name with a placeholder for the frame number: `{frame}`, or `{frame:05}` for at least
/// five digits.
class FramePattern {
 public:
  /// Throws Error(usage) unless the text has exactly one placeholder, with 1 to 10 digits.
  explicit FramePattern(std::string_view text);
  FramePattern(std::string before, int digits, std::string after)
      : before_(std::move(before)), after_(std::move(after)), digits_(digits) {}

  std::filesystem::path name(int frame) const;
  std::vector<std::filesystem::path> names(const FrameRange& frames) const;
  /// Removes the files of this pattern whose frame number is not in `frames`, if `is_own` accepts them as outputs of an
  /// earlier run.
  void remove_others(const FrameRange& frames,
                     const std::function<bool(const std::filesystem::path&, int frame)>& is_own) const;

 private:
  std::string before_, after_;
  int digits_ = 1;
};

struct OutputTarget {
  enum class Kind { video, images, none };
  Kind kind = Kind::video;
  std::string text;                              ///< images: a pattern; video: the file; none: the folder of the cache
  video::Codec codec = video::Codec::automatic;  ///< of a video; automatic: that of the extension

  /// Whether pictures are written as OpenEXR with all layers of a frame.
  bool layered() const { return kind == Kind::images && std::filesystem::path(text).extension() == ".exr"; }
  /// The file of one frame (images) or of all frames (video).
  std::filesystem::path file(int frame) const;
  std::vector<std::filesystem::path> files(const FrameRange& frames) const;
};

/// Parses `-o`; empty: `output/<scene>.mp4`. Throws Error(usage) if the extension is not supported, if the name of
/// pictures lacks the placeholder, or if the name of a video has one.
OutputTarget parse_output(const std::string& text, const std::string& scene_name);

/// The cache that `weft run` keeps while it works, a hidden folder beside the output:
/// `output/.falling_band.weft-cache`. For pictures, the folder is named after the scene, so that runs of different
/// scenes can write to one folder of pictures at the same time.
std::filesystem::path working_cache(const OutputTarget& target, const std::string& scene_name);

}  // namespace weft::cli
