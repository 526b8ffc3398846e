// Joins videos without encoding them again.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace weft::video {

/// Writes `file` from `parts`, which must come from one encoder with the same settings and have `frames` pictures in
/// total; picture k is shown at k / `fps`. The file gets its name when it is complete. Throws Error(output_failed).
void join_videos(std::span<const std::filesystem::path> parts, const std::filesystem::path& file, double fps,
                 int frames, const std::map<std::string, std::string>& metadata);

}  // namespace weft::video
