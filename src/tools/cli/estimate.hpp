// Cost of a run, predicted from its first frames.
#pragma once

#include <cstdint>
#include <string>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/renderer.hpp"
#include "film/scene/scene.hpp"

namespace weft::cli {

struct Estimate {
  int tried = 0;             ///< frames simulated for the estimate; at least one if the scene has one
  double setup = 0;          ///< before the first frame [CPU s]
  double simulate = 0;       ///< per frame, mean of those tried [CPU s]
  double draw = 0;           ///< per picture [CPU s]
  int simulated = 0;         ///< frames that the whole run simulates: those of the preroll, and all after frame 0
  int drawn = 0;             ///< pictures of the whole run
  std::int64_t peak = 0;     ///< peak memory of this process since its start [bytes]
  frame::SnapshotPtr start;  ///< before the first frame

  double simulate_total() const { return setup + simulate * simulated; }
  double draw_total() const { return draw * drawn; }
};

/// Simulates frames until `seconds` of wall time [s] have passed since the start of the set-up, but at least one and at
/// most ten (kMaxTrialFrames), and draws one, without motion blur if the time ends before frame 1. Frames before the
/// first contact take less time than later ones: the true cost may be two to three times the estimate. Throws what a
/// run throws.
Estimate estimate_run(const scene::Scene& scene, const render::Settings& settings, double seconds = 5);

/// One line, for people.
std::string describe(const Estimate& estimate);

}  // namespace weft::cli
