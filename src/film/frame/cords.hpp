// Makes the drawn surfaces of ropes: tubes in place of the simulated chains of particles.
#pragma once

#include <map>
#include <memory>

#include "film/frame/frame_snapshot.hpp"

namespace weft::frame {

/// Whether a surface is the chain of a rope. Its triangles (a, b, b) are the pieces of the rope. Its appearance has the
/// diameter as thickness, and the lay length of the strands as thread_spacing (0: a round cord without strands).
inline bool is_chain(const Surface& surface) {
  return surface.kind == ObjectKind::rope && surface.appearance.thickness > 0;
}

/// Sweeps tubes along splines through the particles of chains. The faces of a tube stay the same over a run. Not thread
/// safe.
class Cords {
 public:
  /// The snapshot with tubes in place of chains; the same object if it has no chains.
  SnapshotPtr sweep(const SnapshotPtr& snapshot);
  /// A copy of the snapshot with tubes in place of chains.
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
