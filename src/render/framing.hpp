// Which part of the world a picture shows: the camera a scene names, or one that has everything in frame.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "frame/frame_snapshot.hpp"
#include "render/transforms.hpp"

namespace weft::render {

/// True for surfaces that a picture is about: visible, and no floor without end.
bool is_subject(const frame::Surface& surface);

/// Smallest box around all subjects [m]; a metre around the origin where there are none.
Box3 subject_bounds(const frame::FrameSnapshot& snapshot);

/// Box around the places that the subjects reach in the run [m], the same in all its frames: backdrop and floor, and
/// the cubes of bounced light, go by it. Where the snapshot does not say, around the subjects.
Box3 surroundings_bounds(const frame::FrameSnapshot& snapshot);

/// The camera of a scene that names none: one that has all of a run in view.
frame::Camera automatic_camera();

/// Axes of a found camera, from its azimuth and elevation.
ViewAxes looking_from(const frame::Camera& camera, const Vec3& up);

/// Where an eye with given axes may stand so that points are in its picture. A point (x, y, z) in those axes (z
/// forward) is within the left and right edges of an eye at (cx, cz) when |x - cx| <= t (z - cz). All points together
/// leave t cz - cx <= min(t z - x) = low and t cz + cx <= min(t z + x) = high; the same for y.
class FrustumFit {
 public:
  FrustumFit() = default;
  /// `camera`: field of view and margin.
  FrustumFit(const ViewAxes& axes, const frame::Camera& camera, double aspect);

  void add(const Vec3& point);
  /// What another one with the same axes was given.
  void add(const FrustumFit& other);

  const ViewAxes& axes() const { return axes_; }
  /// How far before `center` the eye has to stand that looks at it [m].
  double distance(const Vec3& center) const;
  /// As close as the points allow, with equal room on both sides of the direction that needs more; the target as deep
  /// as `center`.
  void place(frame::Camera& camera, const Vec3& center) const;

 private:
  struct Span {
    double tangent = 1;
    double low = std::numeric_limits<double>::max(), high = low;
    void add(double across, double forward) {
      low = std::min(low, tangent * forward - across);
      high = std::min(high, tangent * forward + across);
    }
    double across() const { return 0.5 * (high - low); }
    double forward() const { return 0.5 * (low + high) / tangent; }
  };
  ViewAxes axes_;
  Span horizontal_, vertical_;
};

/// The camera called `name`, or the first where `name` is empty; null where the snapshot names none at all.
/// Throws Error(usage) listing the names there are where none is called so.
const frame::Camera* find_camera(const frame::FrameSnapshot& snapshot, const std::string& name);

}  // namespace weft::render
