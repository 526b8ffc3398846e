// Whether there is nothing left to do.
#pragma once

#include <filesystem>
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

}  // namespace weft::cli
