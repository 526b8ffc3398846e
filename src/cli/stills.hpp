// Frames of a scene or of a cache, for commands that draw few of them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cache/manifest.hpp"
#include "cli/options.hpp"
#include "cli/path_ledger.hpp"
#include "cli/signals.hpp"
#include "core/progress.hpp"
#include "frame/frame_snapshot.hpp"
#include "render/renderer.hpp"

namespace weft::cli {

class Stills {
 public:
  virtual ~Stills() = default;

  /// What scene it is, and how it is drawn where the options say nothing.
  const cache::Manifest& scene() const { return scene_; }
  const render::Settings& settings() const { return settings_; }
  /// The frames that can be had, ascending; one at least.
  const std::vector<int>& frames() const { return frames_; }

  virtual void add_inputs(PathLedger& paths) const = 0;
  /// Frames to simulate before `last` can be had.
  virtual int cost(int last) const = 0;
  /// To be called with ascending numbers. Throws Error(interrupted) once SIGINT or the like asked for it.
  virtual frame::SnapshotPtr at(int frame, Progress& progress) = 0;
  /// The camera, once all frames that are wanted were had: it has seen those of the cache, or those that were
  /// simulated.
  render::CameraPath camera();
  /// Whether SIGINT or the like asked for an end.
  bool is_stopped() const { return signals_.requested(); }
  /// In place of that of the scene; before the first frame.
  void set_size(const PictureSize& size);

 protected:
  /// In their order.
  void show(const frame::FrameSnapshot& snapshot);

  const StopSignals signals_;
  cache::Manifest scene_;
  render::Settings settings_;
  std::vector<int> frames_;
  std::optional<render::CameraPath> camera_;  // where it is found
};

/// Reads what `options.scene` names: a scene, or the folder of a cache. Throws as load_scene() and cache::Reader do.
std::unique_ptr<Stills> open_stills(const SceneOptions& options);

/// The file that `-o` names, or output/<default_name>, checked before any work is done. Throws Error(usage) where it is
/// no PNG or one of the inputs, Error(output_failed) where it cannot be written.
std::filesystem::path still_file(const Stills& stills, const std::filesystem::path& output,
                                 const std::string& default_name, bool overwrite);

}  // namespace weft::cli
