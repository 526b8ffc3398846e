// H.264 video files through libav.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "image/image.hpp"

namespace weft::video {

struct Settings {
  int width = 1280, height = 720;   ///< pixels; odd sizes are padded by one repeated column or row for yuv420p
  double fps = 25;                  ///< frames a second; frame k is shown at exactly k / fps
  int crf = 18;                     ///< x264 constant quality; smaller is better
  std::string preset = "veryfast";  ///< x264 preset
  int threads = 1;                  ///< of the encoder; fixed, because x264's bytes depend on it
  std::map<std::string, std::string> metadata;
};

/// Writes one MP4 file: H.264, yuv420p, BT.709, fast start. Nothing appears under the final name before finish().
class Encoder {
 public:
  /// Opens the temporary file. Throws Error(output_failed).
  Encoder(const std::filesystem::path& file, const Settings& settings);
  ~Encoder();  ///< without finish(): removes the temporary file
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Appends the next frame. The size must be that of the settings.
  void add(const image::Image& image);

  /// Flushes, moves the index to the front, renames to the final name. At least one frame must have been added.
  void finish();

  int frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Name and version of the encoder that would be used, for `weft doctor`.
std::string encoder_description();

}  // namespace weft::video
