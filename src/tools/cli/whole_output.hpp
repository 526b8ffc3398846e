// Finds complete or partial output of an earlier run.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "film/render/renderer.hpp"
#include "tools/cli/output_target.hpp"
#include "tools/cli/stages.hpp"

namespace weft::cli {

/// Whether the video or pictures contain all these frames with these settings and with the metadata `expected`, where
/// the OpenGL implementation may differ, and all meshes exist.
bool is_whole(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
              const Metadata& expected, const std::filesystem::path& meshes, const std::vector<std::string>& objects);

/// What an earlier run has drawn of the same film.
struct Drawn {
  std::set<int> frames;                 ///< complete frames, with their meshes
  std::set<std::filesystem::path> own;  ///< files of this film that may be replaced
};

/// Finds complete pictures of the film. For a video, Drawn::frames is empty unless the video is complete.
Drawn find_drawn(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
                 const Metadata& expected, const std::filesystem::path& meshes,
                 const std::vector<std::string>& objects);

}  // namespace weft::cli
