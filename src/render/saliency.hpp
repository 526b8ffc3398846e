// Rates how much a frame shows, to choose the most informative frame of a run.
#pragma once

#include <string>

#include "frame/frame_snapshot.hpp"

namespace weft::render {

/// What a picture of a frame would show of its cloth, computed without drawing it; each from 0 to 1.
struct Saliency {
  double coverage = 0;  ///< fraction of the picture that shows unoccluded cloth
  double folding = 0;   ///< 0: all cloth is flat; 1: its front normals are evenly distributed
  double motion = 0;    ///< rate of change of shape: 0: none; 1/2: by its own size in two seconds

  /// Cloth outside the picture scores 0; shape and motion each weigh at most as much as presence.
  double score() const { return coverage * (1 + folding + motion); }
};

/// `previous`: the frame before, `seconds` earlier; null at the first. `camera`: as in Settings; without one, the frame
/// is framed on its own.
Saliency saliency_of(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* previous, double seconds,
                     const std::string& camera, double aspect);

}  // namespace weft::render
