// Predicts time and memory of a run from its first frames.
#pragma once

#include <cstdint>
#include <string>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/renderer.hpp"
#include "film/scene/scene.hpp"

namespace weft::cli {

/// What a trial has measured, and how many frames and pictures the whole run has.
struct Estimate {
  int trial_frames = 0;      ///< frames simulated for the estimate; 0 only if the run simulates none
  double setup = 0;          ///< set-up before the first frame [CPU s]
  double simulate = 0;       ///< simulation per frame, mean of these frames [CPU s]
  double draw = 0;           ///< drawing per picture [CPU s]
  int simulated = 0;         ///< frames that the run simulates: the preroll, and those after frame 0
  int drawn = 0;             ///< pictures of the whole run
  std::int64_t peak = 0;     ///< peak memory of this process since its start [bytes]
  frame::SnapshotPtr start;  ///< state before any simulated frame

  double simulate_total() const { return setup + simulate * simulated; }
  double draw_total() const { return draw * drawn; }
};

/// Simulates frames until 5 s of wall time have passed since the start of the set-up, but at
/// least one and at most ten, and never more than the run has. Then draws the
/// current frame or, if the preroll is not finished, the start of the scene; the picture has motion
/// blur only if frame 1 was simulated. Frames before the first contact take less time than later
/// ones, so the true cost may be two to three times the estimate. Throws the same errors as a run.
Estimate estimate_run(const scene::Scene& scene, const render::Settings& settings);

/// Describes the estimate in one line.
std::string describe(const Estimate& estimate);

}  // namespace weft::cli
