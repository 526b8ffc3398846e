// Whether runs that go on from saved states are the run that was never interrupted.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace weft::simulation::testing {

struct Interruptions {
  int frames = 16;            ///< of the whole run, those of the preroll included
  std::vector<int> saved_at;  ///< frames after which states are saved, counted from the very first one, at 0
  int threads_after = 0;      ///< of the runs that go on; 0: as before
};

/// What came of it, so that a test can tell that its scene had what it is about.
struct Continued {
  std::string difference;  ///< the first one found, with its frames; empty where there is none
  int rejected_steps = 0, inexact_steps = 0, pinched_pairs = 0;
  int most_proximities = 0;
  std::size_t largest_state = 0;  ///< [byte]
};

/// Runs the scene, and again with saving, and from each state in a new simulation to the end. Compared are positions,
/// velocities, what the frame shows, and reports but for their times, bit by bit; and each state once restored must be
/// saved as the same bytes.
Continued continue_runs(const scene::Scene& scene, const Interruptions& interruptions);

}  // namespace weft::simulation::testing
