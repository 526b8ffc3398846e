// Compares runs that continue from saved states with the uninterrupted run.
#pragma once

#include <string>
#include <vector>

#include "film/scene/scene.hpp"

namespace weft::simulation::testing {

struct Interruptions {
  int frames = 16;            ///< of the whole run, including the preroll
  std::vector<int> saved_at;  ///< frames after which to save, counted from the first frame of the preroll, which is 0
  int threads_after = 0;      ///< threads of the resumed runs; 0: as many as before
};

/// Results of the comparison. The counts are those of the uninterrupted run. With them, a test checks that the
/// situation which it tests occurs.
struct ContinuationResult {
  std::string difference;  ///< the first difference, with its frames; empty if there is none
  int rejected_steps = 0, inexact_steps = 0, pinched_pairs = 0;
  int most_proximities = 0;
  std::size_t largest_state = 0;  ///< [byte]
};

/// Runs the scene, runs it again while saving, and continues from each saved state in a new simulation to the end.
/// Compares positions, velocities, contents of frames, and reports except for their times, bit by bit. Saving a
/// restored state must give the same bytes.
ContinuationResult continue_runs(const scene::Scene& scene, const Interruptions& interruptions);

}  // namespace weft::simulation::testing
