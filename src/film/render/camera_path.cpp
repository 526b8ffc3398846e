#include "film/render/camera_path.hpp"

#include <algorithm>
#include <cmath>

#include "film/render/transforms.hpp"

namespace weft::render {
namespace {

using Kind = frame::Camera::Kind;

// A camera of kind `whole` shows cloth up to this distance from the bounding box of the subjects in the first frame
// [diagonals of this box]. Without this limit, falling cloth would move the camera very far away.
constexpr double kClothRange = 1.5;

// Number of standard deviations at which the smoothing kernel, a Gaussian, ends; 0.3 % of its weight is beyond.
constexpr double kKernelSigmas = 3;

constexpr double kMaxFieldOfView = 100;  // limit on computed fields of view [degrees]

Vec3 up_of(const frame::FrameSnapshot& snapshot) {
  return snapshot.stage ? snapshot.stage->up : Vec3(Vec3::UnitZ());
}

/// Flags the surfaces that the camera must show.
std::vector<bool> subjects_of(const frame::FrameSnapshot& snapshot, const frame::Camera& camera) {
  const auto chosen = [&](const auto& wanted) {
    std::vector<bool> which;
    for (const auto& surface : snapshot.surfaces) which.push_back(wanted(*surface));
    return which;
  };
  const auto some = [](const std::vector<bool>& of) { return std::ranges::find(of, true) != of.end(); };
  if (!camera.subjects.empty())
    return chosen([&](const frame::Surface& surface) {
      return std::ranges::find(camera.subjects, surface.name) != camera.subjects.end();
    });
  for (const frame::ObjectKind kind : {frame::ObjectKind::character, frame::ObjectKind::cloth}) {
    if (camera.kind == Kind::whole) break;
    auto of_kind = chosen([&](const frame::Surface& surface) { return is_subject(surface) && surface.kind == kind; });
    if (some(of_kind)) return of_kind;
  }
  return chosen(is_subject);
}

}  // namespace

bool CameraPath::is_computed(const frame::FrameSnapshot& snapshot, const std::string& camera) {
  const frame::Camera* named = find_camera(snapshot, camera);
  return named == nullptr || named->kind != Kind::placed;
}

void CameraPath::add_frame(const frame::FrameSnapshot& snapshot) {
  const frame::Camera* named = find_camera(snapshot, name_);
  Frame frame;
  frame.number = snapshot.frame;
  frame.time = snapshot.time;
  frame.camera = named ? *named : automatic_camera();
  up_ = up_of(snapshot);
  const ViewAxes axes = axes_from_angles(frame.camera, up_);
  frame.fit = FrustumFit(axes, frame.camera, aspect_);
  azimuth_changes_ = azimuth_changes_ || (!frames_.empty() && frames_.front().camera.azimuth != frame.camera.azimuth);
  const std::vector<bool> chosen = subjects_of(snapshot, frame.camera);
  Box3 all;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) continue;
    for (const Vec3& position : snapshot.states[i].positions) all.extend(position);
  }
  if (!cloth_box_ && !all.isEmpty()) {
    const Vec3 margin = Vec3::Constant(kClothRange * all.diagonal().norm());
    cloth_box_ = Box3(all.min() - margin, all.max() + margin);
  }
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) continue;
    const bool is_limited = frame.camera.kind == Kind::whole && snapshot.surfaces[i]->kind == frame::ObjectKind::cloth;
    for (const Vec3& position : snapshot.states[i].positions) {
      const Vec3 kept = is_limited ? Vec3(position.cwiseMax(cloth_box_->min()).cwiseMin(cloth_box_->max())) : position;
      frame.fit.add(kept);
      frame.subjects.extend(kept);
    }
  }
  if (frame.subjects.isEmpty()) {
    frame.subjects = Box3(Vec3::Constant(-0.5), Vec3::Constant(0.5));
    frame.fit.add(frame.subjects.min());
    frame.fit.add(frame.subjects.max());
  }
  subject_bounds_.extend(frame.subjects);
  frames_.push_back(std::move(frame));
}

void CameraPath::compute_cameras() {
  if (frames_.empty()) return;
  switch (frames_.front().camera.kind) {
    case Kind::placed:
      return;
    case Kind::whole:
      return azimuth_changes_ ? compute_orbit() : compute_fixed_camera();
    case Kind::follow:
    case Kind::close:
      return compute_following_camera();
    case Kind::track:
      return compute_tracking_camera();
  }
}

frame::Camera CameraPath::at(const frame::FrameSnapshot& snapshot) const {
  if (!is_computed(snapshot, name_)) return *find_camera(snapshot, name_);
  auto found = std::ranges::upper_bound(frames_, snapshot.frame, {}, &Frame::number);
  if (found != frames_.begin()) --found;
  return found->camera;
}

frame::Camera camera_of(const frame::FrameSnapshot& snapshot, const std::string& camera, double aspect) {
  CameraPath path(camera, aspect);
  if (CameraPath::is_computed(snapshot, camera)) {
    path.add_frame(snapshot);
    path.compute_cameras();
  }
  frame::Camera result = path.at(snapshot);
  result.kind = Kind::placed;
  return result;
}

/// Places one camera for all frames, at the smallest distance from which the subjects of every
/// frame are in view.
void CameraPath::compute_fixed_camera() {
  FrustumFit all = frames_.front().fit;
  for (const Frame& frame : frames_) all.add(frame.fit);
  for (Frame& frame : frames_) all.place(frame.camera, subject_bounds_.center());
}

/// Lets the camera orbit the centre of all subjects, at the smallest constant distance from which
/// the subjects of every frame are in view.
void CameraPath::compute_orbit() {
  const Vec3 center = subject_bounds_.center();
  double distance = 0;
  for (const Frame& frame : frames_) distance = std::max(distance, frame.fit.distance(center));
  distance = eye_distance(distance);
  for (Frame& frame : frames_) {
    frame.camera.target = center;
    frame.camera.position = center - distance * frame.fit.axes().forward;
  }
}

/// Weights of the smoothing kernel, a Gaussian, from its centre to one side. The sum of the centre and of both sides
/// is 1.
std::vector<double> CameraPath::kernel() const {
  const double length = frames_.back().time - frames_.front().time;
  const double smoothing = frames_.front().camera.smoothing;
  // Standard deviation [frames]; nearly 0 if the run has only one frame.
  const double width = std::max(1e-3, length > 0 ? smoothing * static_cast<double>(frames_.size() - 1) / length : 0);
  std::vector<double> weights{1};
  double sum = 1;
  for (int i = 1; i <= kKernelSigmas * width; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (width * width)));
    sum += 2 * weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Gaussian means of the subjects' centres over neighbouring frames. Beyond both ends of the run,
/// point reflection continues the trajectory of the centre. Thus, if the centre moves at a constant
/// velocity, the means do too, from the first frame on.
std::vector<Vec3> CameraPath::smooth_centers() const {
  const std::vector<double> weights = kernel();
  const auto last = static_cast<std::ptrdiff_t>(frames_.size()) - 1;
  const auto center = [&](std::ptrdiff_t i) -> Vec3 {
    const std::ptrdiff_t end = i < 0 ? 0 : last, inside = std::clamp<std::ptrdiff_t>(2 * end - i, 0, last);
    if (i >= 0 && i <= last) return frames_[i].subjects.center();
    return 2 * frames_[end].subjects.center() - frames_[inside].subjects.center();
  };
  std::vector<Vec3> smooth;
  for (std::ptrdiff_t k = 0; k <= last; ++k) {
    Vec3 sum = weights[0] * center(k);
    for (std::ptrdiff_t i = 1; i < static_cast<std::ptrdiff_t>(weights.size()); ++i)
      sum += weights[i] * (center(k - i) + center(k + i));
    smooth.push_back(sum);
  }
  return smooth;
}

/// Moves the camera with the centre of the subjects. Each frame needs a certain distance to show
/// its subjects. Kind `follow` keeps the largest of these distances. Kind `close` first takes, for
/// each frame, the largest of the distances of the frames that the kernel covers. It then smooths
/// these maxima with the kernel. Thus, no frame gets a smaller distance than it needs.
void CameraPath::compute_following_camera() {
  const std::vector<Vec3> centers = smooth_centers();
  const auto count = static_cast<std::ptrdiff_t>(frames_.size());
  std::vector<double> needed_distances;
  for (std::ptrdiff_t k = 0; k < count; ++k)
    needed_distances.push_back(eye_distance(frames_[k].fit.distance(centers[k])));
  std::vector<double> distances(needed_distances.size(), *std::ranges::max_element(needed_distances));
  if (frames_.front().camera.kind == Kind::close) {
    const std::vector<double> weights = kernel();
    const auto reach = static_cast<std::ptrdiff_t>(weights.size()) - 1;
    const auto largest_around = [&](std::ptrdiff_t k) {
      k = std::clamp<std::ptrdiff_t>(k, 0, count - 1);
      return *std::max_element(needed_distances.begin() + std::max<std::ptrdiff_t>(0, k - reach),
                               needed_distances.begin() + std::min(count, k + reach + 1));
    };
    std::vector<double> around;
    for (std::ptrdiff_t k = -reach; k < count + reach; ++k) around.push_back(largest_around(k));
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      distances[k] = weights[0] * around[k + reach];
      for (std::ptrdiff_t i = 1; i <= reach; ++i)
        distances[k] += weights[i] * (around[k + reach - i] + around[k + reach + i]);
    }
  }
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    frames_[k].camera.target = centers[k];
    frames_[k].camera.position = centers[k] - distances[k] * frames_[k].fit.axes().forward;
  }
}

/// Keeps the camera in place and turns it towards the centre of the subjects. If the scene gives no
/// field of view, chooses one that shows the subjects' boxes in all frames, but at least 1 degree
/// and at most kMaxFieldOfView.
void CameraPath::compute_tracking_camera() {
  const std::vector<Vec3> centers = smooth_centers();
  double tangent = 0;
  for (std::size_t k = 0; k < frames_.size(); ++k) {
    frame::Camera& camera = frames_[k].camera;
    camera.target = centers[k];
    const ViewAxes axes = view_axes(camera.target - camera.position, up_);
    for (int corner = 0; corner < 8; ++corner) {
      const auto which = static_cast<Box3::CornerType>(corner);
      const Vec3 to = frames_[k].subjects.corner(which) - camera.position;
      const double forward = std::max(1e-6, axes.forward.dot(to));
      tangent =
          std::max({tangent, std::abs(axes.up.dot(to)) / forward, std::abs(axes.right.dot(to)) / (forward * aspect_)});
    }
  }
  const double found = 2 * std::atan(tangent / (1 - frames_.front().camera.margin)) / radians(1);
  for (Frame& frame : frames_)
    if (frame.camera.field_of_view == 0) frame.camera.field_of_view = std::clamp(found, 1.0, kMaxFieldOfView);
}

}  // namespace weft::render
