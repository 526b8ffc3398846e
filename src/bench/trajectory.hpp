// Whole motions of a scene, and how far two of them are apart.
#pragma once

#include <vector>

#include "bench/accuracy.hpp"
#include "scene/scene.hpp"

namespace weft::bench {

/// All that is kept of a run, frame by frame, the start not counted.
struct Trajectory {
  struct Frame {
    std::vector<Vec3> x, v;
    double energy = 0;  ///< kinetic, elastic and of height [J]
  };
  std::vector<Frame> frames;
  std::vector<double> masses;
  double energies_in_play = 0;  ///< [J]
  // Of the last frame.
  double shadow = 0;       ///< in shares of the area at the start
  double top = 0;          ///< [m]
  double rest_energy = 0;  ///< [J]
  Vec3 centre{0, 0, 0};    ///< [m]
};

/// Simulates all frames of the scene, at most `step_limit` steps. Counters and the CPU time go to `run`. Throws
/// Error(simulation_failed).
Trajectory follow(const scene::Scene& scene, int step_limit, Run& run);

/// Errors of a motion against a reference. Particle i of the one is particle same[i] of the other; an empty list: all
/// are the same.
Errors compare(const Trajectory& run, const Trajectory& reference, const std::vector<std::size_t>& same = {});

/// The scene with a mesh that has `refinement` times the cells along each side; whether its cells can be cut so.
bool can_refine(const scene::Scene& scene, double refinement);
void refine(scene::Scene& scene, double refinement);

/// Which particles of a scene with twice the cells lie where those of this scene are.
std::vector<std::size_t> same_in_twice_as_fine(const scene::Scene& scene);

}  // namespace weft::bench
