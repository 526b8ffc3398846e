// Makes the drawn surfaces of ropes: tubes in place of the simulated chains of particles.
#pragma once

#include <map>
#include <memory>

#include "film/frame/frame_snapshot.hpp"

namespace weft::frame {

/// Whether a surface is a chain: the particles of a rope, with one triangle (a, b, b) for each piece of the rope, from
/// particle a to particle b. In the appearance of a chain, `thickness` is the diameter of the rope, and
/// `thread_spacing` is the length along which a strand turns once around the rope (0: a rope without strands) [m].
inline bool is_chain(const Surface& surface) {
  return surface.kind == ObjectKind::rope && surface.appearance.thickness > 0;
}

/// Sweeps a tube along the Catmull-Rom spline through the particles of each chain (see is_chain()).
/// A tube has the same triangles in all frames. Not thread-safe.
class Cords {
 public:
  /// Returns the snapshot with tubes in place of chains, or `snapshot` itself if it has no chains.
  SnapshotPtr sweep(const SnapshotPtr& snapshot);
  /// Returns a copy of the snapshot with tubes in place of chains.
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
