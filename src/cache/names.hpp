// What the files of a frame cache are called.
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
                            *kOutputsFile = "outputs.txt";  // of the run that fills it

inline std::string frame_file(int frame) {
  return fmt::format("frame_{:05}.weft", frame);
}

/// The frame whose file is called so.
inline std::optional<int> frame_of(std::string_view name) {
  constexpr std::string_view kBefore = "frame_", kAfter = ".weft";
  if (!name.starts_with(kBefore) || !name.ends_with(kAfter)) return std::nullopt;
  int frame = 0;
  const char* end = name.data() + name.size() - kAfter.size();
  const auto [stop, error] = std::from_chars(name.data() + kBefore.size(), end, frame);
  if (error != std::errc() || stop != end || frame < 0 || frame_file(frame) != name) return std::nullopt;
  return frame;
}

/// May become part of a file's name. What a broken file holds must not lead into other folders.
inline bool is_plain_name(std::string_view name) {
  if (name.empty() || name == "." || name == "..") return false;
  for (const char c : name)
    if (c == '/' || static_cast<unsigned char>(c) < 0x20) return false;
  return true;
}

}  // namespace weft::cache
