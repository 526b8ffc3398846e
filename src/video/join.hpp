// Videos one after another as one, every picture as it is: nothing is encoded anew.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace weft::video {

/// Writes `file` from `parts`, of one encoder with the same settings, `frames` pictures in all, picture k shown at
/// k / `fps`. Nothing appears under the name before it is whole. Throws Error(output_failed).
void join_videos(std::span<const std::filesystem::path> parts, const std::filesystem::path& file, double fps,
                 int frames, const std::map<std::string, std::string>& metadata);

}  // namespace weft::video
