// Selects the frames of a cache that a command uses.
#pragma once

#include <string>

#include "film/cache/reader.hpp"
#include "film/render/camera_path.hpp"
#include "tools/cli/frame_range.hpp"

namespace weft::cli {

/// Returns the selected frames: all frames of the scene if `selection` has no bounds and no step. Verifies each frame,
/// so that the command finds a damaged frame before it writes anything. If frames are missing or broken, throws
/// Error(frames_missing) with their numbers. With `partial`, warns instead, and returns the frames before the first
/// missing or broken one; throws only if no selected frame is before it. Throws Error(usage) if the selection is empty
/// or exceeds the scene.
FrameRange cached_frames(const cache::Reader& reader, const FrameSelection& selection, bool partial);

/// Verifies the frame one step before the first of `frames`, which motion blur and motion layers need. Does nothing if
/// its number would be below 0. Throws Error(frames_missing) if it is missing or broken.
void check_frame_before(const cache::Reader& reader, const FrameRange& frames);

/// Passes to `camera` all frames of the cache that have the scene's current looks (colours, cameras, lights). Skips
/// missing frames, and broken ones with a warning. If these are not all frames of the scene, warns and returns their
/// numbers (frames_text()), since the camera of all frames may be another one; otherwise returns an empty text.
std::string show_frames(const cache::Reader& reader, render::CameraPath& camera);

}  // namespace weft::cli
