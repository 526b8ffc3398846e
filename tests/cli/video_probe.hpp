#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace weft::cli {

struct VideoFacts {
  int frames = 0;  ///< decoded to the end without an error; -1 if the file cannot be read
  int width = 0, height = 0;
  double duration = 0;  ///< of the stream [s]
  std::map<std::string, std::string> metadata;
};

/// Decodes all of a video.
VideoFacts probe_video(const std::filesystem::path& file);

}  // namespace weft::cli
