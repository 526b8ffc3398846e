// Description of a frame cache, readable by people and scripts: `manifest.json`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "film/frame/frame_snapshot.hpp"

namespace weft::cache {

struct Manifest {
  std::string scene;  ///< name of the scene
  std::string title;  ///< may be empty
  std::uint64_t scene_hash = 0;
  /// Hash of the inputs of the simulation. Two caches of the same program with the same hash contain the same motion.
  /// 0: unknown.
  std::uint64_t simulation_hash = 0;
  std::vector<std::uint64_t> former_hashes;  ///< scene hashes of earlier versions of the scene with the same simulation
  double fps = 25;
  int frame_count = 1;               ///< number of frames of the scene; the cache may contain fewer
  int preroll_frames = 0;            ///< number of frames that are simulated before frame 0 and not stored
  int width = 1280, height = 720;    ///< default size of pictures [pixels]
  std::string camera;                ///< default camera; may be empty
  std::vector<std::string> cameras;  ///< names
  std::string weft_version, cpu_target;
  std::string program;  ///< fingerprint of the build; only the identical program can resume the simulation
  std::vector<frame::ObjectInfo> objects;
};

std::string manifest_text(const Manifest& manifest);

/// Throws std::runtime_error that describes the defect. If the cache has another format version, throws
/// Error(asset_unreadable) that names `file`.
Manifest parse_manifest(std::string_view text, const std::string& file = "manifest.json");

}  // namespace weft::cache
