// Draws snapshots into images with OpenGL 4.5 core on the CPU.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "frame/frame_snapshot.hpp"
#include "image/exr.hpp"
#include "image/image.hpp"
#include "render/camera_path.hpp"

namespace weft::render {

enum class Quality { draft, preview, final };
enum class Backend { automatic, osmesa, egl };

struct Settings {
  int width = 1280, height = 720;  ///< pixels
  Quality quality = Quality::final;
  Backend backend = Backend::automatic;
  std::string camera;                      ///< by name; empty: the first, or one that shows the whole run
  int threads = 0;                         ///< of the software rasteriser; 0: its default
  bool layers = false;                     ///< whether layers() will be called
  bool deep = false;                       ///< whether deep() will be called
  std::optional<frame::Stage::Look> look;  ///< overrides that of the scene
  std::optional<double> motion_blur;       ///< shutter angle [degrees]; overrides that of the scene

  double aspect() const { return static_cast<double>(width) / height; }
};

/// Time that one picture took, without other work of the process.
struct DrawTimes {
  double wall_seconds = 0, cpu_seconds = 0;
};

/// Owns one context and the GPU-side copies of data that stays the same. Use from a single thread.
class Renderer {
 public:
  /// Throws Error(usage or internal) with the driver's message if make_context() fails, Error(usage) for a bad size.
  explicit Renderer(const Settings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Sets the computed cameras of a run. Without them, the first drawn frame determines all unplaced cameras.
  void set_camera_path(CameraPath path);
  /// `before`: the frame from which layers() computes motion.
  image::Image draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before = nullptr);
  /// The last picture for compositors, linear: R, G, B, A of the surfaces alone, premultiplied; picture.R, .G, .B with
  /// floor and backdrop; with a floor, caught.A: A plus the floor's shadow (black) where no surface is; and all layers
  /// of DataPasses.
  image::Layers layers();
  /// The last picture with 16 bits per channel.
  image::Image16 deep();
  DrawTimes last_times() const;

  /// Vendor, renderer and version of OpenGL, the backend loaded and the reason for it.
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::render
