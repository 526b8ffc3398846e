// Ropes as they are seen: tubes in place of the chains of particles that are simulated.
#pragma once

#include <map>
#include <memory>

#include "frame/frame_snapshot.hpp"

namespace weft::frame {

/// Whether a surface is the chain of a rope. Its triangles (a, b, b) are its pieces, its appearance has the diameter as
/// thickness and the lay length of its strands as thread_spacing (0: a round cord without strands).
inline bool is_chain(const Surface& surface) {
  return surface.kind == ObjectKind::rope && surface.appearance.thickness > 0;
}

/// Sweeps tubes along the chains of snapshots, along a spline through the particles. Faces are the same in all frames
/// of a run. Not for several threads at a time.
class Cords {
 public:
  /// The snapshot with tubes for ropes; itself where it has none.
  SnapshotPtr sweep(const SnapshotPtr& snapshot);
  /// The same as a copy, of a snapshot with ropes.
  FrameSnapshot sweep(const FrameSnapshot& snapshot);
  static bool has_chains(const FrameSnapshot& snapshot);

 private:
  struct Tube {
    std::shared_ptr<const Surface> chain, surface;
    int rings_per_piece, sides;
    bool closed;
  };
  const Tube& tube_of(const std::shared_ptr<const Surface>& chain);
  static SurfaceState state_of(const Tube& tube, const SurfaceState& chain);

  std::map<const Surface*, Tube> tubes_;
};

}  // namespace weft::frame
