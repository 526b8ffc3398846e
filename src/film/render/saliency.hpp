// Measures how much of its cloth a frame shows, to choose the most informative frame of a run.
#pragma once

#include <string>

#include "film/frame/frame_snapshot.hpp"

namespace weft::render {

/// What a picture of a frame would show of its cloth, computed without drawing it; each from 0 to 1.
struct Saliency {
  double coverage = 0;  ///< fraction of the picture that shows unoccluded cloth
  double folding = 0;   ///< 0: all cloth is flat; 1: the normals of the faces cancel each other
  /// v / (v + 1/2). v: mean over the cloths, weighted by area, of the mean speed of the vertices of
  /// a cloth relative to their mean velocity [√(area of this cloth) per second].
  double motion = 0;

  /// 0 if no cloth is visible in the picture. Folding and motion each add at most the coverage.
  double score() const { return coverage * (1 + folding + motion); }
};

/// Computes the saliency of `snapshot`. `previous`: the frame that is `seconds` earlier, with the same surfaces; null
/// for the first frame. `camera`: as in render::Settings. A computed camera is derived from `snapshot` alone.
Saliency saliency_of(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* previous, double seconds,
                     const std::string& camera, double aspect);

}  // namespace weft::render
