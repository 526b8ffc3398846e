// Writes video files through libav.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "film/image/image.hpp"

namespace weft::video {

/// h264 is for players: 8 bits, 4:2:0, in .mp4, .mov or .mkv. The next three codecs are for editing: h264_lossless
/// (.mkv, .mp4, .mov) and ffv1 (.mkv) are lossless, and prores is ProRes 422 HQ with 10 bits (.mov, .mkv). automatic:
/// ffv1 for .mkv, prores for .mov, else h264.
enum class Codec { automatic, h264, h264_lossless, ffv1, prores };

struct Settings {
  int width = 1280, height = 720;  ///< [pixels]; odd sizes are padded by a column or row, unless the codec is lossless
  /// [1/s]; 23.976 means 24000/1001. Frame k is shown at k / fps (in Matroska, rounded to 1 ms).
  double fps = 25;
  Codec codec = Codec::automatic;
  int crf = 18;                     ///< for h264: x264 constant quality, 1 to 51; smaller is better
  std::string preset = "veryfast";  ///< x264 preset
  /// Number of encoder threads. The output of x264 depends on it, so use the same number on all machines.
  int threads = 1;
  std::map<std::string, std::string> metadata;
};

/// Writes one video: for .mp4, by default H.264, yuv420p, BT.709, and the index before the frames. The file gets its
/// final name only in finish(). Until then, a hidden temporary file in the same folder holds the frames in fragments,
/// which can be played even if the process is killed.
class Encoder {
 public:
  /// Opens the temporary file. Throws Error(output_failed) if settings are out of range, the file
  /// cannot be written, or libav cannot start the encoder; Error(usage) as codec_of() does.
  Encoder(const std::filesystem::path& file, const Settings& wanted);
  ~Encoder();  ///< without finish(): removes the temporary file
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Appends the next frame. Throws Error(internal) if its size differs from the settings or finish() has been called,
  /// Error(output_failed) with libav's message if libav fails, for example because the disk is full.
  void add(const image::Image& image);

  /// Flushes the encoder, moves the index to the front, reads the file to verify the time of each
  /// frame, and renames it to its final name. Throws Error(output_failed), also if no frame has
  /// been added. If all frames are encoded but the finished file cannot be made, partial_name(file)
  /// keeps the frames, and the error names that file. Throws Error(internal) if finish() has
  /// already been called.
  void finish();

  int frames() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether videos with this extension, such as ".mp4", can be written.
bool is_written(const std::string& ending);

/// The codec for a file of this name: `codec` itself or, for `automatic`, the default of the extension (see Codec).
/// Throws Error(usage) if such files cannot contain `codec`.
Codec codec_of(const std::filesystem::path& file, Codec codec);

/// Name of the file that keeps all frames if the finished file cannot be made: that of `file` with ".partial" inserted
/// before the extension.
std::filesystem::path partial_name(const std::filesystem::path& file);

/// Name and version of the H.264 encoder, for `weft doctor`.
std::string encoder_description();

}  // namespace weft::video
