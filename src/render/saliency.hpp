// Which frame of a run says most about it.
#pragma once

#include <string>

#include "frame/frame_snapshot.hpp"

namespace weft::render {

/// What a picture of a frame would show of its cloth, found without drawing it; each from 0 to 1.
struct Saliency {
  double coverage = 0;  ///< share of the picture that shows cloth, not hidden by anything
  double folding = 0;   ///< 0: all cloth is flat; 1: its front sides point everywhere alike
  double motion = 0;    ///< how fast the cloth changes shape: 0 not at all, 1/2 by its own size in two seconds

  /// Cloth that is not in the picture tells nothing; shape and motion each count at most as much as being there.
  double score() const { return coverage * (1 + folding + motion); }
};

/// `previous`: the frame before, `seconds` earlier; null at the first. Camera as in Settings; without one the frame is
/// framed by itself.
Saliency saliency_of(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* previous, double seconds,
                     const std::string& camera, double aspect);

}  // namespace weft::render
