// Which frames of a cache a command takes.
#pragma once

#include "cache/reader.hpp"
#include "cli/frame_range.hpp"
#include "render/camera_path.hpp"

namespace weft::cli {

/// The frames that were asked for, all of the scene where none were. Each was read, so that a command that takes many
/// finds what is broken before it writes. Where some are missing or broken: Error(not_whole), which names them; with
/// `partial` those before the first of them, with a warning, and the error only where that is the first. Throws
/// Error(usage) too.
FrameRange cached_frames(const cache::Reader& reader, const FrameSelection& selection, bool partial);

/// Shows the camera all frames that are there with the looks of the scene.
void show_frames(const cache::Reader& reader, render::CameraPath& camera);

}  // namespace weft::cli
