// What a run will take, from its first frames.
#pragma once

#include <cstdint>
#include <string>

#include "render/renderer.hpp"
#include "scene/scene.hpp"

namespace weft::cli {

struct Estimate {
  int tried = 0;          ///< frames that were simulated, at least one where there is one
  double setup = 0;       ///< before the first frame [CPU s]
  double simulate = 0;    ///< of a frame, the mean of those tried [CPU s]
  double draw = 0;        ///< of a picture [CPU s]
  int simulated = 0;      ///< frames of the whole run, those before frame 0 too
  int drawn = 0;          ///< pictures of the whole run
  std::int64_t peak = 0;  ///< memory of this process, with all that it did before [bytes]

  double simulate_total() const { return setup + simulate * simulated; }
  double draw_total() const { return draw * drawn; }
};

/// Simulates frames for some seconds, at least one, and draws one. Cloth that is not in contact yet is quicker than
/// later: expect two or three times of it. Throws as a run does.
Estimate estimate_run(const scene::Scene& scene, const render::Settings& settings, double seconds = 5);

/// For people, one line.
std::string describe(const Estimate& estimate);

}  // namespace weft::cli
