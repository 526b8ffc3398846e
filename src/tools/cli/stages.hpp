// The stages of the pipeline (film.hpp) that draw and write frames: interfaces and implementations.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "film/cache/manifest.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "film/image/exr.hpp"
#include "film/image/image.hpp"
#include "film/render/renderer.hpp"
#include "film/video/encoder.hpp"
#include "tools/cli/output_target.hpp"
#include "tools/cli/run_report.hpp"

namespace weft::cli {

/// A drawn frame.
struct Picture {
  image::Image image;
  image::Layers layers = {};    ///< if requested
  image::Image16 image16 = {};  ///< with 16 bits per channel, if requested
};

class FramePainter {
 public:
  virtual ~FramePainter() = default;
  /// Sets the camera path. Without it, a computed camera depends only on the first drawn frame.
  virtual void set_camera_path(render::CameraPath) {}
  /// `before`: the previous frame to draw, for motion blur and layers; null if it does not exist or is not needed.
  virtual Picture draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before) = 0;
  virtual StageTime last_time() const = 0;  ///< time that the last draw() took
  virtual std::string description() const = 0;
};

/// Writes pictures. If a writer is destroyed without finish(), it must leave no incomplete file.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void write(const frame::FrameSnapshot& snapshot, const Picture& picture) = 0;
  virtual void finish() = 0;
};

/// Draws with OpenGL; warns once if a picture has a single colour.
std::unique_ptr<FramePainter> make_gl_painter(const render::Settings& settings);

using Metadata = std::map<std::string, std::string>;

/// Metadata of videos and pictures: scene, scene_hash, weft_version, gl, fps, scene_frames, camera, quality and others.
Metadata describe_pictures(const cache::Manifest& scene, const render::Settings& settings, const std::string& gl);

/// Adds the metadata of a single picture: frame and time_s.
Metadata describe_still(Metadata metadata, int frame, double time_s);

struct WriterSettings {
  OutputTarget target;
  FrameRange frames;
  int width = 0, height = 0;  ///< [pixels]
  double fps = 0;             ///< of the scene
  int depth = 8;              ///< bits per channel of PNG pictures
  std::optional<int> crf;
  Metadata metadata = {};
};

std::unique_ptr<FrameWriter> make_writer(const WriterSettings& settings);

/// Names of the meshes of an object: `<folder>/<object>_<frame:05>.ply`.
FramePattern mesh_files(const std::filesystem::path& folder, const std::string& object);
/// The meshes of these objects and frames; none if `folder` is empty.
std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& folder,
                                              const std::vector<std::string>& objects, const FrameRange& frames);

/// Writes a PLY file for each object of the snapshot. Throws Error(output_failed).
void write_meshes(const std::filesystem::path& folder, const frame::FrameSnapshot& snapshot);

}  // namespace weft::cli
