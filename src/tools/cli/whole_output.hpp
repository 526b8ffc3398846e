// Finds complete or partial output of an earlier run.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "film/render/renderer.hpp"
#include "tools/cli/output_target.hpp"
#include "tools/cli/stages.hpp"

namespace weft::cli {

/// What an earlier run has drawn of the same film.
struct Drawn {
  std::set<int> frames;                 ///< complete frames, with their meshes
  std::set<std::filesystem::path> own;  ///< files of this film that may be replaced

  bool is_whole(const FrameRange& wanted) const { return std::cmp_equal(frames.size(), wanted.count()); }
};

/// Finds complete pictures of the film: those with these settings, with the metadata `expected`, where the OpenGL
/// implementation may differ, and with all meshes. For a video, Drawn::frames is empty unless the video is complete.
Drawn find_drawn(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
                 const Metadata& expected, const std::filesystem::path& meshes,
                 const std::vector<std::string>& objects);

}  // namespace weft::cli
