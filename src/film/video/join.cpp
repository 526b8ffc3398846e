#include "film/video/join.hpp"

#include "film/video/frame_rate.hpp"
#include "film/video/libav.hpp"
#include "film/video/mp4_file.hpp"

namespace weft::video {

void join_videos(std::span<const std::filesystem::path> parts, const std::filesystem::path& file, double fps,
                 int frames, const std::map<std::string, std::string>& metadata) {
  collect_log();
  join_packets(parts, file, frame_rate(fps), frames, metadata);
}

}  // namespace weft::video
