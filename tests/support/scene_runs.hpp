// Runs of whole scenes without a picture, each frame measured from its snapshot alone.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "simulation/simulation.hpp"

namespace weft::support {

/// A frame, as seen from outside.
struct MeasuredFrame {
  simulation::FrameReport report;
  std::size_t pairs = 0;     ///< intersecting, see judge(); 0 where the run is not judged
  std::string between;       ///< their objects, "ball-sheet 3, sheet-sheet 1"
  double max_stretch = 1;    ///< largest length over rest length of a weft or warp edge
  std::string stretched_at;  ///< whose edge that is and where, "sheet (0.1, 0, 0.3)"; empty where none is longer
  double rms_speed = 0;      ///< of all particles, from their way since the frame before [m/s]
  double largest_speed = 0;  ///< of one particle, likewise [m/s]
  std::vector<std::vector<Vec3>> cloths;  ///< positions [m], one list per cloth
};

struct RunPlan {
  int end = -1;        ///< frame after the last one; negative: all of the scene
  int judge_from = 0;  ///< first frame that is judged
  bool judged = true;
  bool keep_positions = false;  ///< else `cloths` is empty but for the last frame
};

using EachFrame = std::function<void(const MeasuredFrame&)>;

/// Simulates the scene and returns all of its frames, frame 0 first; `each` is told of each as it is done. Throws
/// what Simulation throws.
std::vector<MeasuredFrame> run_scene(const scene::Scene& scene, const RunPlan& plan = {}, const EachFrame& each = {});

/// A scene file or text with the values of `overrides`. Throws std::invalid_argument with the mistakes.
scene::Scene scene_of(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
scene::Scene scene_of_text(const std::string& text, const std::vector<std::string>& overrides = {});

}  // namespace weft::support
