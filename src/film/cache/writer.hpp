// Writes a frame cache. Each file gets its final name only when it is complete.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "film/cache/codec.hpp"
#include "film/cache/manifest.hpp"

namespace weft::cache {

/// Exclusive right of one process to write to a folder, until the Lock is destroyed or the process ends.
class Lock {
 public:
  /// Creates the folder if it is missing. Throws Error(output_failed) if another process holds the lock, if the folder
  /// cannot be written, or if it contains files that do not belong to a cache.
  explicit Lock(std::filesystem::path folder);
  ~Lock();
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  const std::filesystem::path& folder() const { return folder_; }

  /// Removes all files of a cache except the lock. Removes the manifest before the frames, so that an interrupted call
  /// leaves no cache.
  void clear() const;
  /// Removes all files of a cache and the folder.
  void remove() const;
  /// Whether the folder contains nothing but the lock and the list of outputs.
  bool empty() const;

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

/// Writes the files of a cache. If a file cannot be written, functions throw Error(output_failed). If add() cannot read
/// back frame 0, it throws Error(asset_unreadable).
class Writer {
 public:
  /// Writes the manifest and the scene. The folder must be empty, or a cache of the same simulation.
  Writer(const Lock& lock, Manifest manifest, std::string_view scene_text);

  /// Adds a frame. Frame 0 must come first, unless the folder already has it. Replaces a file of this frame that
  /// existed when the Writer was created. Throws Error(output_failed) if another program has created the file since.
  void add(const frame::FrameSnapshot& snapshot, const simulation::FrameReport& report);

  /// Replaces the stored state by the state of `frame`. All frames up to `frame` must be in the cache.
  void save_state(int frame, std::string_view bytes);

  /// Size of all added frames [bytes]; if frame 0 is one of them, with the data that all frames share.
  std::uintmax_t bytes_added() const { return bytes_added_; }

 private:
  void write(const std::string& name, const std::string& content);

  std::filesystem::path folder_;
  Manifest manifest_;
  std::optional<Surfaces> surfaces_;
  std::set<int> own_frames_;  // frames whose files belong to this cache and may be replaced
  std::uintmax_t bytes_added_ = 0;
};

}  // namespace weft::cache
