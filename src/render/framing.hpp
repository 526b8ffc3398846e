// Which part of the world a picture shows: the camera a scene names, or one that has everything in frame.
#pragma once

#include <span>
#include <string>

#include "frame/frame_snapshot.hpp"

namespace weft::render {

/// True for surfaces that a picture is about: visible, and no floor without end.
bool is_subject(const frame::Surface& surface);

/// Smallest box around all subjects [m]; a metre around the origin where there are none.
Box3 subject_bounds(const frame::FrameSnapshot& snapshot);

/// A camera from three quarters in front, a little above, that has every vertex of every subject in a picture of
/// `aspect` (width / height), with a margin. `up` is the unit vector that points up in the picture.
frame::Camera frame_subjects(const frame::FrameSnapshot& snapshot, const Vec3& up, double aspect);

/// The camera called `name`, or the first where `name` is empty; null where the snapshot names none at all.
/// Throws Error(usage) listing the names there are where none is called so.
const frame::Camera* find_camera(const frame::FrameSnapshot& snapshot, const std::string& name);

}  // namespace weft::render
