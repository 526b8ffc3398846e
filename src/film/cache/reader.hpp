// Reads a frame cache from disk. Any number of processes may read it at the same time, also while it is written.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "film/cache/codec.hpp"
#include "film/cache/container.hpp"
#include "film/cache/manifest.hpp"

namespace weft::cache {

/// A solver state: the bytes of Simulation::save.
struct SolverState {
  int frame = 0;  ///< number; negative in the preroll
  std::string bytes;
};

/// Which files the reader accepts. of_scene: only files with the looks (colours, cameras, lights) of the present scene.
/// any: also files with the looks of earlier versions of the scene (Manifest::former_hashes), which exist until a run
/// with --resume replaces them.
enum class AcceptedLooks { of_scene, any };

/// All functions are thread-safe. Functions that read files throw Error(asset_unreadable) with the file name and the
/// defect; folder(), manifest() and has() do not throw.
class Reader {
 public:
  /// Reads the data that all frames share. If the cache has no frame yet, read() reads these data once frame 0 exists.
  explicit Reader(std::filesystem::path folder, AcceptedLooks looks = AcceptedLooks::of_scene);

  const std::filesystem::path& folder() const { return folder_; }
  const Manifest& manifest() const { return manifest_; }
  /// The effective scene as TOML, for display.
  std::string scene_text() const;

  /// Frames below frame_count whose files exist now, ascending. Each call reads the folder again.
  std::vector<int> frames() const;
  bool has(int frame) const;

  CachedFrame read(int frame) const;
  frame::SnapshotPtr snapshot(int frame) const { return read(frame).snapshot; }
  simulation::FrameReport report(int frame) const { return read(frame).report; }

  /// Checks the file of a frame without decompressing it. Returns the hash of the scene whose looks the frame has.
  std::uint64_t verify(int frame) const;

  /// The stored solver state; nullopt if there is none.
  std::optional<SolverState> state() const;

 private:
  Content read_part(const char* name, Kind kind, std::optional<int> frame) const;
  const Surfaces& shared_surfaces() const;
  void check_objects(const Surfaces& surfaces) const;
  void check_scene(std::uint64_t hash) const;

  std::filesystem::path folder_;
  AcceptedLooks looks_;
  Manifest manifest_;
  mutable std::mutex mutex_;                  // protects surfaces_ until they are read; they do not change then
  mutable std::optional<Surfaces> surfaces_;  // absent if their file did not exist yet; it is written with frame 0
};

/// Whether the folder contains a manifest, readable or not.
bool is_cache(const std::filesystem::path& folder);

}  // namespace weft::cache
