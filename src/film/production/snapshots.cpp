#include "film/production/snapshots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "film/assets/camera_file.hpp"
#include "film/environment/picture_places.hpp"
#include "film/image/color.hpp"
#include "film/image/picture.hpp"
#include "film/scene/fabrics.hpp"
#include "physics/mesh/geometry.hpp"

namespace weft::production {
namespace {

using CameraValue = motion::Spline<7>::Value;
using LightValue = motion::Spline<10>::Value;

// The edge between two faces of a character is drawn sharp if their normals differ by more than this [degrees].
constexpr double kCharacterCrease = 80;

// The roll of a camera from a file is ignored. If it is larger than this angle, there is a warning [degrees].
constexpr double kMaxIgnoredRoll = 0.1;

// The default colour of the back of a cloth is the colour of the front, mixed with this fraction of white.
constexpr double kBackPaleness = 0.35;

frame::Appearance appearance(const scene::Look& look) {
  frame::Appearance result;
  result.roughness = look.roughness;
  result.metal = look.metal;
  result.finish = {look.gloss.value_or(0), look.warp_fraction, look.fuzz.value_or(0), look.sheer.value_or(0),
                   look.threads};
  result.thread_spacing = look.thread_spacing;
  result.thickness = look.cloth_thickness;
  result.hem = look.hem.value_or(0);
  result.checker = look.checker;
  return result;
}

/// Default widths of the hems of garments, and of other cloth [m].
constexpr double kGarmentHem = 0.015, kHem = 0.010;
// kStrandTurnLength: length of a rope along which a strand turns once around the rope [diameters]. kMinTwistedDiameter:
// minimum diameter of ropes that are drawn with strands [m]; thinner strands would be finer than a pixel and flicker.
constexpr double kStrandTurnLength = 3.2, kMinTwistedDiameter = 0.009;

/// The look of a cloth or rope. The fabric determines the values of a cloth that the scene does not set; the width of
/// hems also depends on the shape.
scene::Look look_of(const scene::Cloth& cloth) {
  scene::Look look = cloth.look;
  if (cloth.rope) {
    look.cloth_thickness = cloth.rope->diameter;
    look.thread_spacing =
        look.strands && cloth.rope->diameter >= kMinTwistedDiameter ? kStrandTurnLength * cloth.rope->diameter : 0;
    return look;
  }
  const scene::Fabric* fabric = scene::find_fabric(cloth.material.fabric);
  const scene::Finish finish = fabric ? fabric->finish : scene::fabrics().front().finish;
  look.gloss = look.gloss.value_or(finish.gloss);
  look.fuzz = look.fuzz.value_or(finish.fuzz);
  look.sheer = look.sheer.value_or(finish.sheer);
  look.warp_fraction = finish.warp_fraction;
  look.threads = finish.threads;
  look.cloth_thickness =
      fabric ? fabric->measured.thickness.value : scene::kThicknessPerDensity * cloth.material.density;
  const double hem = cloth.shape == scene::ClothShape::pattern ? kGarmentHem : kHem;
  look.hem = look.hem.value_or(!fabric || fabric->frays ? hem : 0);
  return look;
}

std::shared_ptr<const frame::Texture> texture_of(image::Picture picture) {
  return std::make_shared<const frame::Texture>(frame::Texture{picture.width, picture.height, std::move(picture.rgba)});
}

/// Textures from picture files. Decodes each file once.
class Pictures {
 public:
  /// Throws Error(scene_invalid) if the file cannot be read. This happens if it has changed since the scene was
  /// checked.
  std::shared_ptr<const frame::Texture> of_file(const std::filesystem::path& file) {
    std::shared_ptr<const frame::Texture>& texture = known_[file];
    if (texture) return texture;
    try {
      return texture = texture_of(image::read_picture(file));
    } catch (const std::exception& error) {
      throw Error(ExitCode::scene_invalid, "{}: expected a picture (PNG, JPEG or TGA): {}", file.string(),
                  error.what());
    }
  }

 private:
  std::map<std::filesystem::path, std::shared_ptr<const frame::Texture>> known_;
};

/// Sets the colours of an appearance and, if there is a picture, maps it along weft and warp.
void apply_paint(frame::Appearance& look, const scene::Paint& paint, Pictures& pictures) {
  look.color = paint.color;
  look.back_color = paint.back_color.value_or(paint.color + kBackPaleness * (Vec3::Ones() - paint.color));
  look.back_painted = !paint.back_color;
  look.back_paleness = kBackPaleness;
  look.paint = {};
  if (!paint.image) return;
  look.paint.texture = pictures.of_file(*paint.image);
  const double height = paint.image_width * look.paint.texture->height / look.paint.texture->width;
  const Eigen::Matrix2d turned = Eigen::Rotation2Dd(-paint.image_rotation * std::numbers::pi / 180).toRotationMatrix();
  const Eigen::Matrix2d to_tiles = Vec2(1 / paint.image_width, 1 / height).asDiagonal() * turned;
  look.paint.texture_from_uv << to_tiles, -to_tiles * paint.image_offset;
  look.paint.wrap_u = look.paint.wrap_v = paint.image_repeat ? frame::Paint::Wrap::repeat : frame::Paint::Wrap::once;
  look.paint.alpha = paint.cutout ? frame::Paint::Alpha::cutout : frame::Paint::Alpha::over_color;
  if (paint.cutout) look.color.setOnes();
}

/// Makes the picture on a floor opaque: blends its transparent parts with the floor's colour. Then sets this colour,
/// with which the floor lights other objects, to the mean of the picture in linear light.
void make_opaque(frame::Appearance& look) {
  auto filled = std::make_shared<frame::Texture>(*look.paint.texture);
  const Vec3 below = image::linear_from_srgb(look.color);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < filled->rgba.size(); i += 4) {
    std::uint8_t* pixel = &filled->rgba[i];
    const double opacity = pixel[3] / 255.0;
    const Vec3 shown =
        opacity * image::linear_from_srgb(Vec3(pixel[0], pixel[1], pixel[2]) / 255) + (1 - opacity) * below;
    sum += shown;
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<std::uint8_t>(std::lround(255 * image::srgb_from_linear(shown[c])));
    pixel[3] = 255;
  }
  look.paint.texture = std::move(filled);
  look.color = image::srgb_from_linear(Vec3(sum * 4 / static_cast<double>(look.paint.texture->rgba.size())));
}

void apply_look(frame::Surface& surface, const scene::Look& look, Pictures& pictures) {
  surface.visible = look.visible;
  surface.appearance = appearance(look);
  apply_paint(surface.appearance, look, pictures);
  if (surface.kind != frame::ObjectKind::cloth && surface.kind != frame::ObjectKind::rope)
    surface.appearance.thread_spacing = 0;
  // The texture coordinates of obstacles already are coordinates of the picture (places_of()).
  if (surface.kind == frame::ObjectKind::obstacle) {
    surface.appearance.paint.texture_from_uv.setIdentity();
    surface.appearance.coat = look.gloss.value_or(0);
  }
  if (surface.infinite_floor && look.image) make_opaque(surface.appearance);
  // The parts of the surface already have the materials of the character's file. Keeps them.
  if (surface.kind == frame::ObjectKind::character && look.as_file) return;
  for (frame::SurfacePart& part : surface.parts) {
    const frame::Paint figure = part.appearance.paint;
    part.appearance = surface.appearance;
    // Keeps the texture of a part of a character, such as the mannequin's hair, face and shoes. The scene sets only the
    // colour.
    if (surface.kind == frame::ObjectKind::character) part.appearance.paint = figure;
    for (const scene::PanelPaint& panel : look.panels)
      if (panel.name == part.name) apply_paint(part.appearance, panel, pictures);
  }
}

std::shared_ptr<frame::Surface> make_surface(const std::string& name, frame::ObjectKind kind, const mesh::Mesh& mesh) {
  auto surface = std::make_shared<frame::Surface>();
  surface->name = name;
  surface->kind = kind;
  surface->triangles = mesh.topology.triangles;
  surface->quads = mesh.topology.quads;
  surface->uv = mesh.uv;
  if (kind == frame::ObjectKind::cloth) surface->crease_angle = 180;
  return surface;
}

std::shared_ptr<frame::Surface> make_cloth_surface(const model::Cloth& cloth, const environment::ClothDetails& details,
                                                   const scene::Look& look, Pictures& pictures) {
  auto surface = make_surface(cloth.name, cloth.rope ? frame::ObjectKind::rope : frame::ObjectKind::cloth, cloth.mesh);
  for (const std::string& panel : details.panels) surface->parts.push_back({panel, {}});
  surface->part_of_triangle = details.panel_of;
  surface->paint_uv = details.paint_uv;
  surface->closures = details.closures;
  surface->max_closed_gap = 2 * mesh::Tie::kRest;  // farther apart, a tie cannot hold its particles
  apply_look(*surface, look, pictures);
  return surface;
}

/// Surface part with a material of a character's file. If the picture of the material cannot be decoded, warns and
/// leaves the picture out.
frame::SurfacePart part_of(const character::Material& material, const std::string& body) {
  frame::SurfacePart part{material.name, {}};
  part.appearance.color = part.appearance.back_color = image::srgb_from_linear(material.color);
  frame::Paint& paint = part.appearance.paint;
  if (!material.pixels.empty()) {
    paint.texture = texture_of({material.width, material.height, material.pixels});
    paint.wrap_u = paint.wrap_v = frame::Paint::Wrap::clamp;
    paint.alpha = frame::Paint::Alpha::over_color;
    return part;
  }
  if (material.picture.empty()) return part;
  try {
    paint.texture = texture_of(image::decode_picture(material.picture));
  } catch (const std::exception& error) {
    log::warn(
        fmt::format("character.{}: material \"{}\": its picture is left out: {}", body, material.name, error.what()));
  }
  paint.wrap_u = static_cast<frame::Paint::Wrap>(material.wrap_u);
  paint.wrap_v = static_cast<frame::Paint::Wrap>(material.wrap_v);
  paint.alpha = material.cutout ? frame::Paint::Alpha::cutout : frame::Paint::Alpha::ignored;
  return part;
}

std::shared_ptr<frame::Surface> make_body_surface(const model::Body& body, const environment::BodyDetails& details,
                                                  Pictures& pictures) {
  auto surface =
      make_surface(body.name, body.deforms() ? frame::ObjectKind::character : frame::ObjectKind::obstacle, body.mesh);
  surface->infinite_floor = body.infinite_floor;
  surface->passed_through = details.passed_through;
  if (!body.collide) surface->passed_through.assign(surface->triangles.size(), 1);
  if (body.deforms()) surface->crease_angle = kCharacterCrease;
  scene::Look look = details.look;
  const bool covers_look = details.coloring && details.coloring->covers_look;
  if (covers_look) look.as_file = false;
  if (details.coloring && (look.as_file || covers_look)) {
    for (const character::Material& material : details.coloring->materials)
      surface->parts.push_back(part_of(material, body.name));
    surface->part_of_triangle = details.coloring->material_of_triangle;
    surface->paint_uv = details.coloring->uv;
  }
  apply_look(*surface, look, pictures);
  return surface;
}

/// Texture coordinates of the picture of an obstacle. The obstacle must have a picture.
environment::PicturePlaces places_of(const scene::Scene& scene, const scene::Obstacle& obstacle, Pictures& pictures) {
  std::optional<Vec2> tile;
  if (obstacle.look.tile_width) {
    const frame::Texture& texture = *pictures.of_file(*obstacle.look.image);
    tile = Vec2(1, static_cast<double>(texture.height) / texture.width) * *obstacle.look.tile_width;
  }
  return environment::picture_places(scene, obstacle, environment::mesh_of(scene, obstacle), tile);
}

std::shared_ptr<const frame::Stage> make_stage(const scene::Scene& scene) {
  auto stage = std::make_shared<frame::Stage>();
  stage->up = scene::up_vector(scene.up);
  stage->look = static_cast<frame::Stage::Look>(scene.render.look);
  stage->sky_color = scene.render.sky_color;
  stage->ground_color = scene.render.ground_color;
  stage->sky_intensity = scene.render.sky_intensity;
  stage->exposure = scene.render.exposure;
  stage->motion_blur = scene.render.motion_blur;
  stage->heat = static_cast<frame::Stage::Heat>(scene.render.heat);
  stage->heat_max = scene.render.heat_max;
  return stage;
}

/// Bounding box of a body over sampled times from 0 to `duration` [s].
Box3 bounds_over_run(const model::Model& model, std::size_t body, double duration) {
  constexpr int kSamples = 100;
  std::vector<Vec3> positions(model.bodies[body].mesh.positions.size());
  Box3 bounds;
  for (int k = 0; k <= (model.bodies[body].may_move ? kSamples : 0); ++k) {
    model.place(body, duration * k / kSamples, positions);
    bounds.extend(mesh::bounding_box(positions));
  }
  return bounds;
}

/// Sensor height of a camera [mm]; 0 if the camera has no focal length. The width of the sensor lies along the longer
/// side of the picture.
double sensor_height(const scene::Camera& camera, const scene::Render& render) {
  if (!scene::has_focal_length(camera)) return 0;
  return camera.sensor_width * std::min(1.0, static_cast<double>(render.height) / render.width);
}

/// Times of the cuts of a camera [s], each halfway through its jump. A jump is a change that lasts at most a frame and
/// is much faster than the changes before and after it: two close keys, a step of a file (assets::load_camera() makes
/// it a fast change), or a step in a file with a key for each frame. `duration`: of a frame [s].
std::vector<double> find_cuts(std::span<const double> times, std::span<const CameraValue> values, double duration) {
  // kMaxJump: longest jump [frames]; above 1, because files have times in single precision. kMinSpeedRatio: smallest
  // ratio of the speed of a jump to the speeds before and after it.
  constexpr double kMaxJump = 1.01, kMinSpeedRatio = 10;
  // Speed up to each key, of all values together; the camera stands still before the first key and after the last.
  std::vector<double> speeds(times.size() + 1, 0);
  for (std::size_t i = 1; i < times.size(); ++i)
    speeds[i] = (values[i] - values[i - 1]).norm() / (times[i] - times[i - 1]);
  std::vector<double> cuts;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    double slowest = speeds[i + 1];  // from key i to key `end`
    for (std::size_t end = i + 1; end < times.size() && times[end] - times[i] <= kMaxJump * duration; ++end) {
      slowest = std::min(slowest, speeds[end]);
      if (slowest <= kMinSpeedRatio * speeds[i]) break;
      if (slowest <= kMinSpeedRatio * speeds[end + 1]) continue;
      cuts.push_back(0.5 * (times[i] + times[end]));
      break;
    }
  }
  return cuts;
}

CameraTrack make_track(scene::Interpolation interpolation, std::vector<double> times, std::vector<CameraValue> values,
                       const scene::Scene& scene) {
  std::vector<double> cuts = find_cuts(times, values, 1 / scene.time.fps);
  return {{interpolation, std::move(times), std::move(values)}, std::move(cuts)};
}

CameraTrack placed_track(const scene::Scene& scene, const scene::Camera& camera) {
  std::vector<double> times;
  std::vector<CameraValue> values;
  for (const scene::CameraKey& key : camera.keys) {
    times.push_back(key.time);
    const double lens = scene::has_focal_length(camera) ? key.focal_length : key.field_of_view;
    values.push_back((CameraValue() << key.position, key.target, lens).finished());
  }
  return make_track(camera.interpolation, std::move(times), std::move(values), scene);
}

// Track of a camera from a file. In the file, y is up and z points toward the front of the scene.
CameraTrack file_track(const scene::Scene& scene, const scene::Camera& camera) {
  const std::string where =
      fmt::format("{}:{}:{}: camera.{}", scene.file.string(), camera.line, camera.column, camera.name);
  const assets::LoadedCamera loaded = assets::load_camera(camera.file, camera.object, where);
  if (loaded.roll > kMaxIgnoredRoll)
    log::warn(fmt::format("{}: it is tilted to a side by up to {:.3g} degrees, which is left out", where, loaded.roll));
  const auto turned = [&](const Vec3& x) { return scene.up == scene::UpAxis::z ? Vec3(x.x(), -x.z(), x.y()) : x; };
  const double target_distance = camera.focus > 0 ? camera.focus : 1;  // distance of the target [m]
  std::vector<double> times;
  std::vector<CameraValue> values;
  for (std::size_t i = 0; i < loaded.times.size(); ++i) {
    const Vec3 eye = camera.scale * turned(loaded.positions[i]);
    times.push_back(camera.start + loaded.times[i]);
    values.push_back(
        (CameraValue() << eye, eye + target_distance * turned(loaded.forward[i]), loaded.field_of_view).finished());
  }
  return make_track(scene::Interpolation::linear, std::move(times), std::move(values), scene);
}

motion::Spline<10> light_track(const scene::Light& light) {
  std::vector<double> times;
  std::vector<LightValue> values;
  for (const scene::LightKey& key : light.keys) {
    times.push_back(key.time);
    values.push_back((LightValue() << key.direction, key.position, key.target, key.intensity).finished());
  }
  return {light.interpolation, std::move(times), std::move(values)};
}

}  // namespace

SnapshotMaker::SnapshotMaker(const scene::Scene& scene, const environment::Environment& environment)
    : stage_(make_stage(scene)), mounts_(scene, environment) {
  for (const scene::Camera& camera : scene.cameras) {
    cameras_.push_back({.name = camera.name,
                        .aperture = camera.aperture,
                        .focus = camera.focus,
                        .kind = scene::is_computed(camera.kind) ? static_cast<frame::Camera::Kind>(camera.kind)
                                                                : frame::Camera::Kind::placed,
                        .subjects = camera.subjects,
                        .azimuth = camera.azimuth,
                        .elevation = camera.elevation,
                        .margin = camera.margin,
                        .smoothing = camera.smoothing});
    camera_tracks_.push_back(camera.kind == scene::CameraKind::file ? file_track(scene, camera)
                                                                    : placed_track(scene, camera));
    orbits_.push_back(camera.orbit);
    sensor_heights_.push_back(sensor_height(camera, scene.render));
    // The renderer assumes a film 24 mm high. Scales the f-number so that the aperture has the same diameter with it.
    constexpr double kFilmHeight = 24;  // [mm]
    if (sensor_heights_.back() > 0) cameras_.back().aperture *= kFilmHeight / sensor_heights_.back();
  }
  for (const scene::Light& light : scene.lights) {
    lights_.push_back({.name = light.name,
                       .kind = light.spot ? frame::Light::Kind::spot : frame::Light::Kind::sun,
                       .cone_angle = light.cone_angle,
                       .color = light.color,
                       .softness = light.softness});
    light_tracks_.push_back(light_track(light));
  }
  Pictures pictures;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const model::Cloth& cloth = environment.model.cloths[c];
    const auto surface = make_cloth_surface(cloth, environment.cloths[c], look_of(scene.cloths[c]), pictures);
    surface->run_bounds = mesh::bounding_box(cloth.start);
    surfaces_.push_back(surface);
  }
  for (std::size_t b = 0; b < environment.bodies.size(); ++b) {
    const auto surface = make_body_surface(environment.model.bodies[b], environment.bodies[b], pictures);
    // The first bodies are the obstacles.
    if (b < scene.obstacles.size() && scene.obstacles[b].look.image)
      surface->paint_uv = places_of(scene, scene.obstacles[b], pictures);
    surface->run_bounds = bounds_over_run(environment.model, b, scene.time.duration);
    surfaces_.push_back(surface);
  }
}

std::vector<frame::Camera> SnapshotMaker::cameras_at(double time) const {
  std::vector<frame::Camera> cameras = cameras_;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const auto& [spline, cuts] = camera_tracks_[c];
    const CameraValue value = spline.at(time).value;
    cameras[c].position = value.segment<3>(0);
    cameras[c].target = value.segment<3>(3);
    const double height = sensor_heights_[c];
    cameras[c].field_of_view =
        height > 0 ? 360 / std::numbers::pi * std::atan(height / (2 * value[6])) : static_cast<double>(value[6]);
    cameras[c].azimuth += orbits_[c] * time;
    cameras[c].shot = static_cast<std::int32_t>(std::ranges::upper_bound(cuts, time) - cuts.begin());
  }
  return cameras;
}

std::vector<frame::Light> SnapshotMaker::lights_at(double time) const {
  std::vector<frame::Light> lights = lights_;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const LightValue value = light_tracks_[l].at(time).value;
    lights[l].direction = value.segment<3>(0);
    lights[l].position = value.segment<3>(3);
    lights[l].target = value.segment<3>(6);
    lights[l].intensity = value[9];
  }
  return lights;
}

void SnapshotMaker::set_looks(frame::FrameSnapshot& snapshot) const {
  snapshot.surfaces = surfaces_;
  snapshot.stage = stage_;
  snapshot.cameras = cameras_at(snapshot.time);
  mounts_.move(snapshot);
  snapshot.lights = lights_at(snapshot.time);
}

frame::SnapshotPtr SnapshotMaker::make(int frame, double time, const model::Model& model,
                                       std::span<const Vec3> particles, std::vector<std::vector<float>> heat,
                                       std::vector<std::vector<Vec3>> moved) const {
  auto snapshot = std::make_shared<frame::FrameSnapshot>();
  snapshot->frame = frame;
  snapshot->time = time;
  for (const model::Cloth& cloth : model.cloths) {
    const auto of_cloth = particles.first(cloth.start.size());
    snapshot->states.push_back({{of_cloth.begin(), of_cloth.end()}, {}});
    particles = particles.subspan(of_cloth.size());
  }
  for (std::size_t c = 0; c < heat.size(); ++c) snapshot->states[c].heat = std::move(heat[c]);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (b < moved.size() && !moved[b].empty()) {
      snapshot->states.push_back({std::move(moved[b]), {}});
      continue;
    }
    snapshot->states.push_back({std::vector<Vec3>(model.bodies[b].mesh.positions.size()), {}});
    model.place(b, time, snapshot->states.back().positions);
  }
  set_looks(*snapshot);
  return snapshot;
}

frame::SnapshotPtr SnapshotMaker::with_looks(const frame::FrameSnapshot& snapshot) const {
  auto copy = std::make_shared<frame::FrameSnapshot>(snapshot);
  set_looks(*copy);
  return copy;
}

}  // namespace weft::production
