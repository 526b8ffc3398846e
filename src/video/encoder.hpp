// Video files through libav.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "image/image.hpp"

namespace weft::video {

/// h264: 8 bits with a quarter of the colours' places, in .mp4 or .mov, for players. Others are for cutting:
/// h264_lossless and ffv1 keep the bytes of the pictures, in .mkv; prores is ProRes 422 HQ of 10 bits, in .mov.
/// automatic: by the file's ending, h264, ffv1 or prores.
enum class Codec { automatic, h264, h264_lossless, ffv1, prores };

struct Settings {
  int width = 1280, height = 720;  ///< pixels; odd sizes are padded by one repeated column or row for yuv420p
  double fps = 25;                 ///< frames a second; frame k is shown at exactly k / fps (23.976: 24000/1001)
  Codec codec = Codec::automatic;
  int crf = 18;                     ///< of h264: x264 constant quality, 1 to 51; smaller is better
  std::string preset = "veryfast";  ///< x264 preset
  int threads = 1;                  ///< of the encoder; fixed, because x264's bytes depend on it
  std::map<std::string, std::string> metadata;
};

/// Writes one video: by default MP4 with H.264, yuv420p, BT.709, fast start. Nothing appears under the final name
/// before finish(). Until then a hidden temporary file beside it holds the frames in fragments, which play even if the
/// process is killed.
class Encoder {
 public:
  /// Opens the temporary file. Throws Error(output_failed) for settings out of range and places not to be written.
  Encoder(const std::filesystem::path& file, const Settings& wanted);
  ~Encoder();  ///< without finish(): removes the temporary file
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Appends the next frame. Throws Error(internal) if its size is not that of the settings, Error(output_failed) with
  /// libav's words, as for a full disk.
  void add(const image::Image& image);

  /// Flushes, moves the index to the front, reads the file again to see that each frame is there at its time, renames
  /// to the final name. At least one frame must have been added. Throws Error(output_failed); if all frames are encoded
  /// but the finished file cannot be made, they stay as `<name>.partial.mp4` and the error says so.
  void finish();

  int frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether videos of this ending, such as ".mp4", are written.
bool is_written(const std::string& ending);

/// What the codec is for a file of this name. Throws Error(usage) for a codec that such files do not hold.
Codec codec_of(const std::filesystem::path& file, Codec codec);

/// `<name>.partial.mp4`: where the frames go first, under a temporary name, and stay if no finished file can be made.
std::filesystem::path partial_name(const std::filesystem::path& file);

/// Name and version of the encoder that would be used, for `weft doctor`.
std::string encoder_description();

}  // namespace weft::video
