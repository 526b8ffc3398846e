// The stages of the pipeline as they are in a real run.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cache/manifest.hpp"
#include "cli/output_target.hpp"
#include "cli/pipeline.hpp"
#include "image/image.hpp"
#include "render/renderer.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {

/// Draws with OpenGL; warns of the first picture that shows a single colour.
std::unique_ptr<FramePainter> make_gl_painter(const render::Settings& settings);

/// Draws nothing, for runs that keep frames and meshes only.
std::unique_ptr<FramePainter> make_idle_painter();

using Metadata = std::map<std::string, std::string>;

/// What video and stills say about themselves: scene, scene_hash, weft_version, gl, camera, quality.
Metadata describe_pictures(const cache::Manifest& scene, const render::Settings& settings, const std::string& gl);

/// Adds what holds for one still: frame and time_s.
Metadata describe_still(Metadata metadata, int frame, double time_s);

struct WriterSettings {
  OutputTarget target;
  FrameRange frames;
  int width = 0, height = 0;     ///< pixels
  double fps = 0;                ///< of the scene
  std::filesystem::path meshes;  ///< folder; empty: none
  Metadata metadata;
};

/// Writes the video or the pictures, if any, and the meshes.
std::unique_ptr<FrameWriter> make_writer(const WriterSettings& settings);

/// `DIR/<object>_<frame:05>.ply`.
std::filesystem::path mesh_file(const std::filesystem::path& folder, const std::string& object, int frame);

/// Writes each object of the snapshot. Throws Error(output_failed).
void write_meshes(const std::filesystem::path& folder, const frame::FrameSnapshot& snapshot);

}  // namespace weft::cli
