#include "film/render/framing.hpp"

#include <cmath>
#include <utility>

#include "core/error.hpp"

namespace weft::render {
namespace {

constexpr double kFieldOfView = 30;  // vertical [degrees]; that of a portrait lens, which distorts little

}  // namespace

bool is_subject(const frame::Surface& surface) {
  return surface.visible && !surface.infinite_floor;
}

Box3 subject_bounds(const frame::FrameSnapshot& snapshot) {
  Box3 bounds;
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    if (!is_subject(*snapshot.surfaces[i])) continue;
    for (const Vec3& position : snapshot.states[i].positions) bounds.extend(position);
  }
  return bounds.isEmpty() ? Box3(Vec3::Constant(-0.5), Vec3::Constant(0.5)) : bounds;
}

Box3 surroundings_bounds(const frame::FrameSnapshot& snapshot) {
  Box3 bounds;
  for (const auto& surface : snapshot.surfaces)
    if (is_subject(*surface) && surface->run_bounds) bounds.extend(*surface->run_bounds);
  return bounds.isEmpty() ? subject_bounds(snapshot) : bounds;
}

frame::Camera automatic_camera() {
  frame::Camera camera;
  camera.kind = frame::Camera::Kind::whole;
  camera.field_of_view = kFieldOfView;
  return camera;
}

ViewAxes axes_from_angles(const frame::Camera& camera, const Vec3& up) {
  // The front is -y if z is up and +z if y is up, as in modelling programs; right is +x in both.
  const Vec3 front = view_axes(-up.cross(Vec3::UnitX()), up).forward;
  const Vec3 right = front.cross(-up);
  const double azimuth = radians(camera.azimuth), elevation = radians(camera.elevation);
  const Vec3 toward_eye =
      std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * right) + std::sin(elevation) * up;
  return view_axes(-toward_eye, up);
}

FrustumFit::FrustumFit(const ViewAxes& axes, const frame::Camera& camera, double aspect) : axes_(axes) {
  vertical_.tangent = std::tan(radians(camera.field_of_view) / 2) * (1 - camera.margin);
  horizontal_.tangent = vertical_.tangent * aspect;
}

void FrustumFit::add(const Vec3& point) {
  const double forward = axes_.forward.dot(point);
  horizontal_.add(axes_.right.dot(point), forward);
  vertical_.add(axes_.up.dot(point), forward);
}

void FrustumFit::add(const FrustumFit& other) {
  for (auto [own, its] : {std::pair(&horizontal_, &other.horizontal_), std::pair(&vertical_, &other.vertical_)}) {
    own->low = std::min(own->low, its->low);
    own->high = std::min(own->high, its->high);
  }
}

double FrustumFit::distance(const Vec3& center) const {
  const double forward = axes_.forward.dot(center);
  const auto behind = [&](const Span& span, double across) {
    return forward - std::min(span.low + across, span.high - across) / span.tangent;
  };
  return std::max(behind(horizontal_, axes_.right.dot(center)), behind(vertical_, axes_.up.dot(center)));
}

void FrustumFit::place(frame::Camera& camera, const Vec3& center) const {
  const double depth = axes_.forward.dot(center);
  const double nearest = std::min(horizontal_.forward(), vertical_.forward()), fit = depth - nearest;
  const double stand = eye_distance(fit) > fit ? depth - eye_distance(fit) : nearest;
  camera.position = horizontal_.across() * axes_.right + vertical_.across() * axes_.up + stand * axes_.forward;
  camera.target = camera.position + (depth - stand) * axes_.forward;
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

const std::vector<Vec3>* find_positions(const frame::FrameSnapshot& snapshot, const frame::Surface& surface,
                                        std::size_t count) {
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i)
    if (snapshot.surfaces[i]->name == surface.name && snapshot.states[i].positions.size() == count)
      return &snapshot.states[i].positions;
  return nullptr;
}

}  // namespace weft::render
