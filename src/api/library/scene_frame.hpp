// Converts snapshots to frames of the public interface.
#pragma once

#include "api/physics_library/data.hpp"
#include "film/frame/frame_snapshot.hpp"

namespace weft::library {

/// Returns data whose objects are views of the snapshot. The data own the snapshot.
Frame::Data view(frame::SnapshotPtr snapshot);

}  // namespace weft::library
