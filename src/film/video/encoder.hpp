// Writes video files through libav.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "film/image/image.hpp"

namespace weft::video {

/// Codecs, each with its file extensions. h264 is for players: 8 bits, 4:2:0 (.mp4, .mov, .mkv). The next three are for
/// editing: h264_lossless (.mkv, .mp4, .mov) and ffv1 (.mkv) are lossless; prores is ProRes 422 HQ with 10 bits (.mov,
/// .mkv). automatic: ffv1 for .mkv, prores for .mov, else h264.
enum class Codec { automatic, h264, h264_lossless, ffv1, prores };

/// Settings of an Encoder.
struct Settings {
  int width = 1280, height = 720;  ///< [pixels]; odd sizes are padded by a column or row, unless the codec is lossless
  /// [1/s]; 23.976 means 24000/1001. Frame k is shown at k / fps (in Matroska, rounded to 1 ms).
  double fps = 25;
  Codec codec = Codec::automatic;
  int crf = 18;                     ///< for h264: constant rate factor of x264, 1 to 51; smaller: better quality
  std::string preset = "veryfast";  ///< x264 preset
  /// Number of encoder threads. The output of x264 depends on it, so use the same number on all machines.
  int threads = 1;
  std::map<std::string, std::string> metadata;  ///< stored in the file
};

/// Writes one video. By default, an .mp4 file contains H.264 with yuv420p and BT.709, and its index precedes the
/// frames. The file gets its final name in finish(). Until then, a hidden temporary file in the same folder contains
/// the frames in fragments; it can be played even if the process is killed.
class Encoder {
 public:
  /// Opens the temporary file. Throws Error(output_failed) if a setting is out of range, the file cannot be written, or
  /// libav cannot start the encoder, and Error(usage) as codec_of() does.
  Encoder(const std::filesystem::path& file, const Settings& wanted);
  ~Encoder();  ///< removes the temporary file if finish() has not been called
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Appends the next frame. Throws Error(internal) if its size differs from the settings or finish() has been called,
  /// Error(output_failed) with libav's message if libav fails, for example because the disk is full.
  void add(const image::Image& image);

  /// Flushes the encoder, copies the frames to a file with the index in front, verifies the time of each frame in this
  /// file, and gives it its final name. Throws Error(output_failed), also if no frame has been added. If all frames are
  /// encoded but the finished file cannot be made, the file partial_name(file) keeps the frames, and the error names
  /// it. Throws Error(internal) if finish() has already been called.
  void finish();

  int frames() const;  ///< number of added frames

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
