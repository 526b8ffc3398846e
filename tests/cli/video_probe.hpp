#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace weft::cli {

struct VideoFacts {
  int frames = 0;  ///< decoded frames; -1 if the file cannot be read to its end without an error
  int width = 0, height = 0;
  double duration = 0;  ///< of the stream [s]
  std::map<std::string, std::string> metadata;
};

/// Decodes a whole video.
VideoFacts probe_video(const std::filesystem::path& file);

}  // namespace weft::cli
