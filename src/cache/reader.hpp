// A frame cache on disk, read by any number of processes at once, also while it is written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cache/codec.hpp"
#include "cache/container.hpp"
#include "cache/manifest.hpp"

namespace weft::cache {

/// Bytes of Simulation::save.
struct SolverState {
  int frame = 0;  ///< it is that of; below 0 in the preroll
  std::string bytes;
};

/// Whose looks (colours, cameras, lights) the frames may have: those of the scene, or also those that it had before,
/// which a --resume has not come to yet.
enum class Looks { of_scene, any };

/// All functions may be called from several threads, and throw Error(asset_unreadable) with the name of the file and
/// what is wrong with it.
class Reader {
 public:
  /// Reads what all frames share. A cache that has no frame yet is none that is broken.
  explicit Reader(std::filesystem::path folder, Looks looks = Looks::of_scene);

  const std::filesystem::path& folder() const { return folder_; }
  const Manifest& manifest() const { return manifest_; }
  /// The effective scene as TOML, for people; drawing does not need it.
  std::string scene_text() const;

  /// Frames whose files are there now, ascending; looked up at each call.
  std::vector<int> frames() const;
  bool has(int frame) const;

  CachedFrame read(int frame) const;
  frame::SnapshotPtr snapshot(int frame) const { return read(frame).snapshot; }
  frame::FrameReport report(int frame) const { return read(frame).report; }

  /// Reads the file of a frame without unpacking it.
  void verify(int frame) const;

  /// Nothing where no state was kept.
  std::optional<SolverState> state() const;

 private:
  std::string read_part(const char* name, Kind kind, std::optional<int> frame, Label* label = nullptr) const;
  void check_objects() const;
  void check_scene(std::uint64_t hash) const;

  std::filesystem::path folder_;
  Looks looks_;
  Manifest manifest_;
  std::optional<Surfaces> surfaces_;  // absent before frame 0 is there
};

/// True for a folder with a manifest, whether it can be read or not.
bool is_cache(const std::filesystem::path& folder);

}  // namespace weft::cache
