// Single frames of a scene or a cache, for commands that draw few of them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "film/cache/manifest.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/render/renderer.hpp"
#include "tools/cli/options.hpp"
#include "tools/cli/path_ledger.hpp"
#include "tools/cli/signals.hpp"

namespace weft::cli {

class Stills {
 public:
  virtual ~Stills() = default;

  /// Description of the scene.
  const cache::Manifest& scene() const { return scene_; }
  /// Settings for drawing. If the command line gives no size or camera, those of the scene.
  const render::Settings& settings() const { return settings_; }
  /// The available frames, ascending; at least one.
  const std::vector<int>& frames() const { return frames_; }

  virtual void add_inputs(PathLedger& paths) const = 0;
  /// Number of frames that at() counts as progress until frame `last` is available: those of the
  /// preroll and frames 0 to `last`; 0 for a cache.
  virtual int cost(int last) const = 0;
  /// Returns a frame. Call it with ascending frame numbers. Throws Error(interrupted) after a stop signal.
  virtual frame::SnapshotPtr at(int frame, Progress& progress) = 0;
  /// The camera path. A computed path uses the frames of the cache that have the current looks or,
  /// for a scene, the frames simulated so far. Call it after at() for all frames to draw.
  render::CameraPath camera();
  /// Numbers of the frames that a computed camera() uses (frames_text()); empty if it uses all frames of the scene, as
  /// the camera of the film does, or if the scene places the camera.
  virtual std::string camera_frames() const = 0;
  /// Whether a stop signal has arrived.
  bool is_stopped() const { return signals_.requested(); }
  /// Replaces the picture size in settings(). Call it before the first frame.
  void set_size(const PictureSize& size);

 protected:
  /// Passes a frame to the camera if the camera is computed. Call it in the order of frames.
  void show(const frame::FrameSnapshot& snapshot);

  const StopSignals signals_;
  cache::Manifest scene_;
  render::Settings settings_;
  std::vector<int> frames_;
  std::optional<render::CameraPath> camera_;  // set if the camera is a computed one
};

/// Opens `options.scene`: a scene, or the folder of a cache. Throws as load_scene() and cache::Reader do.
std::unique_ptr<Stills> open_stills(const SceneOptions& options);

/// Returns `output`; if it is empty, output/<default_name>. Throws Error(usage) if this name does not end in .png, or
/// if it is an input. Throws Error(output_failed) if the file cannot be written, or if it exists and `overwrite` is
/// false.
std::filesystem::path still_file(const Stills& stills, const std::filesystem::path& output,
                                 const std::string& default_name, bool overwrite);

}  // namespace weft::cli
