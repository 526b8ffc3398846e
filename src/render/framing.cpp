#include "render/framing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "render/transforms.hpp"

namespace weft::render {
namespace {

constexpr double kFieldOfView = 30;  // degrees, vertical: a portrait lens, little distortion
constexpr double kElevation = 17;    // degrees above the subject: the floor shows, and so does what hangs
constexpr double kAzimuth = 33;      // degrees to the right of the front: three-quarter view
constexpr double kMargin = 0.14;     // share of each half picture left free round the subject

template <class Visit>
void for_each_subject_vertex(const frame::FrameSnapshot& snapshot, const Visit& visit) {
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    if (!is_subject(*snapshot.surfaces[i])) continue;
    for (const Vec3& position : snapshot.states[i].positions) visit(position);
  }
}

/// Where a viewer with given axes stands so that all points fit. A point (x, y, z) in those axes (z forward) is within
/// the left and right edges of a viewer at (cx, cz) when |x - cx| <= t (z - cz). All points together leave
/// t cz - cx <= min(t z - x) = low and t cz + cx <= min(t z + x) = high: closest at t cz = (low + high) / 2, with equal
/// room on both sides at cx = (high - low) / 2. The same for y; the more distant of the two wins.
class FrustumFit {
 public:
  explicit FrustumFit(double tangent) : tangent_(tangent) {}
  void add(double across, double forward) {
    low_ = std::min(low_, tangent_ * forward - across);
    high_ = std::min(high_, tangent_ * forward + across);
  }
  double across() const { return 0.5 * (high_ - low_); }
  double forward() const { return 0.5 * (low_ + high_) / tangent_; }

 private:
  double tangent_;
  double low_ = std::numeric_limits<double>::max(), high_ = low_;
};

}  // namespace

bool is_subject(const frame::Surface& surface) {
  return surface.visible && !surface.infinite_floor;
}

Box3 subject_bounds(const frame::FrameSnapshot& snapshot) {
  Box3 bounds;
  for_each_subject_vertex(snapshot, [&](const Vec3& position) { bounds.extend(position); });
  return bounds.isEmpty() ? Box3(Vec3::Constant(-0.5), Vec3::Constant(0.5)) : bounds;
}

frame::Camera frame_subjects(const frame::FrameSnapshot& snapshot, const Vec3& up, double aspect) {
  const Box3 bounds = subject_bounds(snapshot);
  // The front is -y where z is up and +z where y is up, as in modelling programs; right is +x in both.
  const Vec3 front = view_axes(-up.cross(Vec3::UnitX()), up).forward;
  const Vec3 right = front.cross(-up);
  const double azimuth = radians(kAzimuth), elevation = radians(kElevation);
  const Vec3 toward_eye =
      std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * right) + std::sin(elevation) * up;
  const ViewAxes axes = view_axes(-toward_eye, up);

  const double tangent = std::tan(radians(kFieldOfView) / 2) * (1 - kMargin);
  FrustumFit horizontal(tangent * aspect), vertical(tangent);
  bool any = false;
  const auto add = [&](const Vec3& position) {
    const double forward = axes.forward.dot(position);
    horizontal.add(axes.right.dot(position), forward);
    vertical.add(axes.up.dot(position), forward);
    any = true;
  };
  for_each_subject_vertex(snapshot, add);
  if (!any) {
    add(bounds.min());
    add(bounds.max());
  }

  const double depth = axes.forward.dot(bounds.center());
  // A single point needs no distance at all; the near plane does.
  const double stand = std::min({horizontal.forward(), vertical.forward(), depth - 0.05});
  frame::Camera camera;
  camera.field_of_view = kFieldOfView;
  camera.position = horizontal.across() * axes.right + vertical.across() * axes.up + stand * axes.forward;
  camera.target = camera.position + (depth - stand) * axes.forward;
  return camera;
}

const frame::Camera* find_camera(const frame::FrameSnapshot& snapshot, const std::string& name) {
  if (snapshot.cameras.empty() && name.empty()) return nullptr;
  std::string known;
  for (const frame::Camera& camera : snapshot.cameras) {
    if (name.empty() || camera.name == name) return &camera;
    known += (known.empty() ? "" : ", ") + camera.name;
  }
  throw Error(ExitCode::usage, "--camera: expected one of the scene's cameras ({}), got '{}'",
              known.empty() ? "it names none: leave the option out" : known, name);
}

}  // namespace weft::render
