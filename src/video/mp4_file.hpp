// MP4 files with one H.264 stream: written in fragments while frames arrive, then copied into the form that plays
// from the first byte on.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "video/libav.hpp"

namespace weft::video {

enum class Mp4Layout {
  fragmented,  ///< every frame complete in itself: what is on disk can be played whenever the process is killed
  fast_start,  ///< the index stands before the frames: browsers start and seek without the whole file
};

/// An MP4 file being written.
class Mp4Writer {
 public:
  /// Opens `file`, an absolute path lest libav take a colon in it for a protocol, and writes its header. Packets come
  /// in units of one frame, 1 / `rate` seconds. Errors name `reported_file`, the name that the user knows. Throws
  /// Error(output_failed).
  Mp4Writer(const std::filesystem::path& file, std::filesystem::path reported_file, Mp4Layout layout,
            const AVCodecParameters& codec, AVRational rate, const std::map<std::string, std::string>& metadata);

  /// Appends a packet, in decoding order; changes its times to the file's unit. Throws Error(output_failed).
  void write(AVPacket& packet);

  /// Writes the index and closes the file. Throws Error(output_failed).
  void close();

 private:
  std::filesystem::path reported_file_;
  AVRational frame_duration_;
  OutputPtr output_;
};

/// Copies the packets of the files `from`, one after the other, into a new fast start file `to`, so that the first
/// frame is shown at time zero. Throws Error(output_failed), also where they are not encoded alike.
void copy_to_fast_start(std::span<const std::filesystem::path> from, const std::filesystem::path& to,
                        const std::filesystem::path& reported_file, AVRational rate,
                        const std::map<std::string, std::string>& metadata);

/// Reads `file` again: throws Error(output_failed) unless it has each of `frames` frames once, frame k at k / `rate`.
void verify_frames(const std::filesystem::path& file, const std::filesystem::path& reported_file, AVRational rate,
                   int frames);

}  // namespace weft::video
