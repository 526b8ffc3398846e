// The stages of the pipeline as they are in a real run.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cache/manifest.hpp"
#include "cli/output_target.hpp"
#include "cli/run_report.hpp"
#include "frame/frame_snapshot.hpp"
#include "image/exr.hpp"
#include "image/image.hpp"
#include "render/renderer.hpp"
#include "video/encoder.hpp"

namespace weft::cli {

/// What is drawn of a frame.
struct Picture {
  image::Image image;
  image::Layers layers = {};  ///< where they are asked for
  image::Image16 deep = {};   ///< where it is asked for
};

/// Draws frames.
class FramePainter {
 public:
  virtual ~FramePainter() = default;
  /// Takes cameras that were found; without them, what is not placed is found from the first frame that is drawn.
  virtual void look_through(render::CameraPath) {}
  /// `before`: the frame drawn before, where motion is asked for and there is one.
  virtual Picture draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before) = 0;
  virtual StageTime last_time() const = 0;
  virtual std::string description() const = 0;
};

/// Takes pictures. Without finish() it must leave no half file.
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void write(const frame::FrameSnapshot& snapshot, const Picture& picture) = 0;
  virtual void finish() = 0;
};

/// Draws with OpenGL; warns of the first picture that shows a single colour.
std::unique_ptr<FramePainter> make_gl_painter(const render::Settings& settings);

using Metadata = std::map<std::string, std::string>;

/// What video and stills say about themselves: scene, scene_hash, weft_version, gl, fps and scene_frames (of the
/// scene), camera, quality.
Metadata describe_pictures(const cache::Manifest& scene, const render::Settings& settings, const std::string& gl);

/// Adds what holds for one still: frame and time_s.
Metadata describe_still(Metadata metadata, int frame, double time_s);

struct WriterSettings {
  OutputTarget target;
  FrameRange frames;
  int width = 0, height = 0;  ///< pixels
  double fps = 0;             ///< of the scene
  int depth = 8;              ///< bits a channel of PNG pictures
  video::Codec codec = video::Codec::automatic;
  std::optional<int> crf;
  Metadata metadata = {};
};

/// Writes the video or the pictures.
std::unique_ptr<FrameWriter> make_writer(const WriterSettings& settings);

/// `DIR/<object>_<frame:05>.ply`.
FramePattern mesh_files(const std::filesystem::path& folder, const std::string& object);

/// Writes each object of the snapshot. Throws Error(output_failed).
void write_meshes(const std::filesystem::path& folder, const frame::FrameSnapshot& snapshot);

}  // namespace weft::cli
