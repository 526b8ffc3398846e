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
  std::string camera;                      ///< by name; empty: the first, or one that has all of the run in view
  int threads = 0;                         ///< of the software rasteriser; 0: its own choice
  bool layers = false;                     ///< whether layers() are asked for
  bool deep = false;                       ///< whether deep() is asked for
  std::optional<frame::Stage::Look> look;  ///< else that of the scene
  std::optional<double> motion_blur;       ///< angle of the shutter [degrees], else that of the scene

  double aspect() const { return static_cast<double>(width) / height; }
};

/// Time one picture took, without what else the process does meanwhile.
struct DrawTimes {
  double wall_seconds = 0, cpu_seconds = 0;
};

/// One context and the GPU-side copies of what stays the same. Use from a single thread.
class Renderer {
 public:
  /// Throws Error(internal) with the driver's words where no context can be made.
  explicit Renderer(const Settings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Takes the cameras that were found of a run. Without them what is not placed is found from the first frame drawn.
  void set_camera_path(CameraPath path);
  /// Motion in layers() is that since `before`.
  image::Image draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before = nullptr);
  /// The last picture for compositors, linear: R, G, B, A of the surfaces alone, colours times coverage; picture.R, .G,
  /// .B with floor and backdrop; with a floor caught.A, which is A with the floor's shadow, black, where no surface
  /// is; and all of DataPasses.
  image::Layers layers();
  /// The last picture with 16 bits a channel.
  image::Image16 deep();
  DrawTimes last_times() const;

  /// Vendor, renderer and version of the GL in use, and which backend was loaded and why.
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::render
