// Names of the files of a frame cache.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace weft::cache {

inline constexpr const char *kManifestFile = "manifest.json", *kSceneFile = "scene.effective.toml",
                            *kSurfacesFile = "surfaces.weft", *kStateFile = "state.weft", *kLockFile = "lock",
                            *kOutputsFile = "outputs.txt";  // list of the other outputs of the run

/// kMagic: first bytes of all .weft files. kManifestStart: first bytes of the manifest.
inline constexpr std::string_view kMagic = "\x89WEFT\r\n\x1A",
                                  kManifestStart = "{\n  \"format\": \"weft frame cache\",";

inline std::string frame_file(int frame) {
  return fmt::format("frame_{:05}.weft", frame);
}

/// The number of the frame whose file has the name `name`; nullopt if no frame has such a file.
inline std::optional<int> frame_of(std::string_view name) {
  constexpr std::string_view kBefore = "frame_", kAfter = ".weft";
  if (!name.starts_with(kBefore) || !name.ends_with(kAfter)) return std::nullopt;
  int frame = 0;
  const char* end = name.data() + name.size() - kAfter.size();
  const auto [stop, error] = std::from_chars(name.data() + kBefore.size(), end, frame);
  if (error != std::errc() || stop != end || frame < 0 || frame_file(frame) != name) return std::nullopt;
  return frame;
}

}  // namespace weft::cache
