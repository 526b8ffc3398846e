// Draws snapshots into images with OpenGL 4.5 core on the CPU.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/timer.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/image/exr.hpp"
#include "film/image/image.hpp"
#include "film/render/camera_path.hpp"

namespace weft::render {

enum class Quality { draft, preview, final };
enum class Backend { automatic, osmesa, egl };

/// Settings of a Renderer.
struct Settings {
  int width = 1280, height = 720;  ///< [pixels]
  Quality quality = Quality::final;
  Backend backend = Backend::automatic;
  std::string camera;          ///< name; empty: the scene's first camera or, without cameras, automatic_camera()
  int threads = 0;             ///< number of threads of the software rasteriser; 0: its default
  bool layers = false;         ///< whether layers() will be called; pictures are then sharp, without blur
  bool needs_image16 = false;  ///< for the caller: whether to write image16(); ignored by Renderer
  std::optional<frame::Stage::Look> look;  ///< overrides the look of the scene
  std::optional<double> motion_blur;       ///< shutter angle [degrees]; overrides Stage::motion_blur

  double aspect() const { return static_cast<double>(width) / height; }
};

/// Owns an OpenGL context, and the OpenGL data that do not change during a run. Only one thread may use a renderer.
class Renderer {
 public:
  /// Throws as make_context() does, and Error(usage) if a side is below 1 or above the limit of OpenGL.
  explicit Renderer(const Settings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Sets the camera of a run. If this is not called, a computed camera is derived from the first drawn frame alone.
  void set_camera_path(CameraPath path);
  /// Draws a frame. `before`: the previous frame, for motion blur and for the motion in layers();
  /// null: no motion. Throws as find_camera() and heat_shown() do, and Error(internal) if OpenGL
  /// reports an error or `snapshot` is inconsistent.
  image::Image draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before = nullptr);
  /// Moves out the last picture as linear layers for compositing programs. The result has no channels without
  /// Settings::layers, and in a second call for the same picture. Channels R, G, B and A: the surfaces alone,
  /// premultiplied. Channels picture.R, picture.G and picture.B: the picture with floor and backdrop. Channel caught.A,
  /// only if there is a floor and no translucent cloth: A + (1 − A) s, where s is the fraction of light that the shadow
  /// on the floor blocks; this is the alpha of the surfaces over a black shadow. The channels of DataPasses follow.
  image::Layers layers();
  /// The last picture with 16 bits per channel, without dithering.
  image::Image16 image16();
  /// Time that the last picture took. The CPU time excludes other work of the process.
  StageTime last_time() const;

  /// See Context::description().
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::render
