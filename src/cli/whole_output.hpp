// Whether there is nothing left to do.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "cache/manifest.hpp"
#include "cli/output_target.hpp"
#include "render/renderer.hpp"

namespace weft::cli {

/// True where video or pictures hold all these frames of this very scene, drawn so, and all meshes are there.
bool is_whole(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
              const cache::Manifest& scene, const std::filesystem::path& meshes,
              const std::vector<std::string>& objects);

/// What an earlier drawing of the same film has left.
struct Drawn {
  std::set<int> frames;                 ///< that are whole, with their meshes
  std::set<std::filesystem::path> own;  ///< files that may be replaced: nothing else is lost with them
};

/// Looks at pictures one by one; of a video that is not whole no frame counts.
Drawn find_drawn(const OutputTarget& target, const FrameRange& frames, const render::Settings& settings,
                 const cache::Manifest& scene, const std::filesystem::path& meshes,
                 const std::vector<std::string>& objects);

}  // namespace weft::cli
