// MP4, MOV and Matroska files with one video stream. The encoder first writes a file in fragments, then copies it to a
// file that can be played while it loads. In Matroska, both files have the same layout.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "film/video/libav.hpp"

namespace weft::video {

enum class Mp4Layout {
  fragmented,  ///< every frame is a fragment: the file can be played even if the process is killed
  fast_start,  ///< the index precedes the frames: browsers can start and seek before the whole file is loaded
};

/// Writes a video file, packet by packet.
class VideoFileWriter {
 public:
  /// Opens `file` and writes its header. The path must be absolute, because in a relative path, libav would read the
  /// text before a colon as a protocol. Packet times are in units of one frame, 1 / `rate` seconds. `reported_file`:
  /// the name that the user has given; its extension selects the container, and errors name it. Throws
  /// Error(output_failed).
  VideoFileWriter(const std::filesystem::path& file, std::filesystem::path reported_file, Mp4Layout layout,
                  const AVCodecParameters& codec, AVRational rate, const std::map<std::string, std::string>& metadata);

  /// Appends a packet, in decoding order; rescales its times to the unit of the file. Throws Error(output_failed).
  void write(AVPacket& packet);

  /// Writes the index and closes the file. Throws Error(output_failed).
  void close();

 private:
  std::filesystem::path reported_file_;
  AVRational frame_duration_;
  OutputPtr output_;
};

/// Copies the packets of all files `from`, in this order, into a new fast-start file, verifies the time of each of its
/// `frames` frames, and gives it the name `file`. The first frame is at time zero. Throws Error(output_failed), also if
/// the codec parameters of the files differ.
void join_packets(std::span<const std::filesystem::path> from, const std::filesystem::path& file, AVRational rate,
                  int frames, const std::map<std::string, std::string>& metadata);

}  // namespace weft::video
