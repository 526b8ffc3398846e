// Finds the camera that a scene names, and places computed cameras so that the subjects are in view.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "film/frame/frame_snapshot.hpp"
#include "film/render/transforms.hpp"

namespace weft::render {

/// True for visible surfaces other than infinite floors.
bool is_subject(const frame::Surface& surface);

/// Smallest box around all subjects [m]; a cube of 1 m around the origin if there are none.
Box3 subject_bounds(const frame::FrameSnapshot& snapshot);

/// Box around Surface::run_bounds of all subjects [m]: the motion of bodies and the start of cloth. This box is the
/// same in all frames, so that backdrop and floor, which depend on it, do not change. If no subject has such bounds:
/// subject_bounds().
Box3 surroundings_bounds(const frame::FrameSnapshot& snapshot);

/// The camera of scenes that define none. Its kind is `whole`.
frame::Camera automatic_camera();

/// Distance of the eye of a computed camera from the centre of its subjects [m]. `fit`: smallest
/// distance at which all subjects are in the picture. For a single point this is 0; the eye is then
/// 0.05 m away.
inline double eye_distance(double fit) {
  constexpr double kMinFit = 1e-4, kFromPoint = 0.05;
  return fit < kMinFit ? kFromPoint : fit;
}

/// Axes of a computed camera, from its azimuth and elevation. `up`: up axis of the scene.
ViewAxes axes_from_angles(const frame::Camera& camera, const Vec3& up);

/// The positions from which an eye with given axes has all points in its picture, with at least a margin between the
/// points and the edges of the picture. Let t be (1 - margin) tan(half of the horizontal field of view), and use the
/// eye's axes (x right, y up, z forward). For an eye at (cx, cy, cz), a point (x, y, z) keeps the margin to the left
/// and right edges if |x - cx| <= t (z - cz). All points do so if t cz - cx <= low = min(t z - x) and t cz + cx <= high
/// = min(t z + x). The same holds for y with the vertical field of view.
class FrustumFit {
 public:
  FrustumFit() = default;
  /// Uses the field of view and margin of `camera`.
  FrustumFit(const ViewAxes& axes, const frame::Camera& camera, double aspect);

  void add(const Vec3& point);
  /// Adds all points of another fit with the same axes.
  void add(const FrustumFit& other);

  const ViewAxes& axes() const { return axes_; }
  /// Smallest distance from `center` [m] at which an eye that looks at `center` along the view axis
  /// has all points in its picture.
  double distance(const Vec3& center) const;
  /// Sets position and target of the camera. Depth is the coordinate along the view axis. The eye gets the largest
  /// depth at which all points are in the picture; if there is only one point, see eye_distance(). The target is on the
  /// view axis, at the depth of `center`. The points are centred in that direction of the picture (horizontal or
  /// vertical) that needs the larger distance.
  void place(frame::Camera& camera, const Vec3& center) const;

 private:
  /// One direction of the picture, with t, low and high as above. across() and forward(): coordinates of the nearest
  /// eye from which all points are in view.
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

/// The camera called `name`. If `name` is empty: the first camera, or null if the snapshot has none. Throws
/// Error(usage) with the names of all cameras if none matches.
const frame::Camera* find_camera(const frame::FrameSnapshot& snapshot, const std::string& name);

/// Positions of the surface with the name of `surface` in a snapshot [m]; null if the snapshot has no surface with this
/// name and `count` vertices.
const std::vector<Vec3>* find_positions(const frame::FrameSnapshot& snapshot, const frame::Surface& surface,
                                        std::size_t count);

}  // namespace weft::render
