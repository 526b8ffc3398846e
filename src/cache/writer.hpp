// Fills a frame cache. Every file appears under its name only when it is whole.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "cache/codec.hpp"
#include "cache/manifest.hpp"

namespace weft::cache {

/// The right to write to a folder, which one process has at a time and loses with its life.
class Lock {
 public:
  /// Makes the folder if it is missing. Throws Error(output_failed) if another process has the right, if the folder
  /// cannot be written, or if it holds files that are none of a cache.
  explicit Lock(std::filesystem::path folder);
  ~Lock();
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// Takes all files of a cache away, the manifest before frames, so that what is left can never be taken for a cache.
  void clear() const;
  /// The same, and the folder.
  void remove() const;
  /// Files of the cache that are there, without that of the lock.
  bool empty() const;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

/// All functions throw Error(output_failed).
class Writer {
 public:
  /// Writes the manifest and the scene. The folder is empty, or a cache of the same scene to go on with.
  Writer(const Lock& lock, Manifest manifest, std::string_view scene_text);

  /// Frame 0 comes first, unless the folder has it already. A frame that was there at the beginning is replaced; one
  /// that somebody else has made since then is kept, with Error(output_failed).
  void add(const frame::FrameSnapshot& snapshot, const frame::FrameReport& report);

  /// The state of `frame`, in place of an earlier one. All frames up to it have been added.
  void save_state(int frame, std::string_view bytes);

  /// Size of all frames that were added, and of what they share.
  std::uintmax_t bytes_added() const { return bytes_added_; }

 private:
  void write(const std::string& name, const std::string& content);

  std::filesystem::path folder_;
  Manifest manifest_;
  std::optional<Surfaces> surfaces_;
  std::set<int> own_frames_;  // whose files may be replaced
  std::uintmax_t bytes_added_ = 0;
};

}  // namespace weft::cache
