// Frames of the public interface from snapshots.
#pragma once

#include "api/physics_library/data.hpp"
#include "film/frame/frame_snapshot.hpp"

namespace weft::library {

/// Objects that are views of the snapshot, which the data keep.
Frame::Data view(frame::SnapshotPtr snapshot);

}  // namespace weft::library
