#include "film/video/join.hpp"

#include "core/temporary_file.hpp"
#include "film/video/frame_rate.hpp"
#include "film/video/libav.hpp"
#include "film/video/mp4_file.hpp"

namespace weft::video {

void join_videos(std::span<const std::filesystem::path> parts, const std::filesystem::path& file, double fps,
                 int frames, const std::map<std::string, std::string>& metadata) {
  collect_log();
  const AVRational rate = frame_rate(fps);
  TemporaryFile whole(file);
  copy_to_fast_start(parts, std::filesystem::absolute(whole.path()), file, rate, metadata);
  verify_frames(whole.path(), file, rate, frames);
  whole.commit();
}

}  // namespace weft::video
