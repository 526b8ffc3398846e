// Runs whole scenes without pictures; each frame is measured from its snapshot only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "film/production/scene_simulation.hpp"
#include "film/scene/scene.hpp"

namespace weft::support {

/// Measurements of a frame.
struct MeasuredFrame {
  simulation::FrameReport report;
  std::size_t pairs = 0;     ///< intersecting pairs, see find_intersections(); 0 if they are not counted
  std::string between;       ///< the objects of these pairs, "ball-sheet 3, sheet-sheet 1"
  double max_stretch = 1;    ///< largest length / rest length of weft and warp edges; without a grid 1 + max_strain
  std::string stretched_at;  ///< object and place of that edge, "sheet (0.1, 0, 0.3)"; empty if there is none
  double rms_speed = 0;      ///< of all particles, from their displacement since the previous frame [m/s]
  double largest_speed = 0;  ///< of one particle, computed likewise [m/s]
  std::vector<std::vector<Vec3>> cloths;  ///< positions [m], one list per cloth
};

/// The frames of a scene to simulate, to test and to keep.
struct RunPlan {
  int end = -1;                ///< frame after the last one; negative: the whole scene
  int intersections_from = 0;  ///< first frame whose intersections are counted
  bool counts_intersections = true;
  bool keep_positions = false;  ///< else only the last frame has `cloths`
};

using EachFrame = std::function<void(const MeasuredFrame&)>;

/// Simulates the scene and returns all frames, frame 0 first; calls `each` after each. Throws what Simulation throws.
std::vector<MeasuredFrame> run_scene(const scene::Scene& scene, const RunPlan& plan = {}, const EachFrame& each = {});

/// Reads a scene file or text with `overrides`. Throws std::invalid_argument with the mistakes.
scene::Scene scene_of(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
scene::Scene scene_of_text(const std::string& text, const std::vector<std::string>& overrides = {});

}  // namespace weft::support
