// Which frames of a cache a command takes.
#pragma once

#include "cache/reader.hpp"
#include "cli/frame_range.hpp"
#include "render/camera_path.hpp"

namespace weft::cli {

/// Those that were asked for, which must be there; else all that are. Throws Error(usage, asset_unreadable).
FrameRange cached_frames(const cache::Reader& reader, FrameSelection selection);

/// Shows the camera all frames that are there with the looks of the scene.
void show_frames(const cache::Reader& reader, render::CameraPath& camera);

}  // namespace weft::cli
