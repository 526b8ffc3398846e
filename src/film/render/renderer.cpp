#include "film/render/renderer.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "film/frame/cords.hpp"
#include "film/image/color.hpp"
#include "film/render/data_passes.hpp"
#include "film/render/drawing_time.hpp"
#include "film/render/edges.hpp"
#include "film/render/framing.hpp"
#include "film/render/instants.hpp"
#include "film/render/mirror.hpp"
#include "film/render/outlines.hpp"
#include "film/render/pixels.hpp"
#include "film/render/reflected_light.hpp"
#include "film/render/shading.hpp"
#include "film/render/shadow_catcher.hpp"
#include "film/render/smear.hpp"
#include "film/render/traced_light.hpp"
#include "film/render/view.hpp"

namespace weft::render {
namespace {

// Cloth is refined if all cloths together have at most this number of triangles; finer meshes are smooth enough.
constexpr std::size_t kMaxRefinedTriangles = 20000;
constexpr std::size_t kMaxPeeledLayers = 4;  // maximum number of drawn layers of translucent cloth
// Motion that one sharp picture of motion blur may cover [pixels]; determines how many such pictures are averaged.
constexpr double kMaxMotionPerPicture = 5;
// Half side of the drawn floor / (radius of the run's surroundings + distance of the eye); there, the floor has faded.
constexpr double kFloorSizeRatio = 60;

Vec3 up_of(const frame::FrameSnapshot& snapshot) {
  const Vec3 up = snapshot.stage ? snapshot.stage->up : Vec3(0, 0, 1);
  return up.squaredNorm() > 0 ? Vec3(up.normalized()) : Vec3(0, 0, 1);
}

void check_states(const frame::FrameSnapshot& snapshot) {
  if (snapshot.surfaces.size() != snapshot.states.size())
    throw Error(ExitCode::internal, "frame {}: {} surfaces, but states of {}", snapshot.frame, snapshot.surfaces.size(),
                snapshot.states.size());
}

std::vector<TracedLight::Surface> traced_surfaces(std::span<const Shading::Material> materials) {
  std::vector<TracedLight::Surface> list;
  for (const auto& each : materials) list.push_back(TracedLight::Surface::of(each.appearance, each.cloth));
  return list;
}

/// One snapshot prepared for the passes.
struct Plan {
  frame::Stage stage;
  Vec3 up;
  Box3 subjects, surroundings;
  std::optional<Floor> floor;
  View view;
  std::vector<frame::Light> lights;
  Lighting lighting;
};

}  // namespace

struct Renderer::Impl {
  Settings settings;
  QualitySettings quality;
  std::unique_ptr<Context> context;
  const Gl& gl;
  std::optional<CameraPath> path;
  frame::Cords cords;
  StageTime time;

  // GL objects; the context must be current when they are created and deleted.
  struct Passes {
    RayScene rays;
    TracedLight traced;
    GeometryBuffer geometry;
    Shading shading;
    FloorBuffers floor;
    Buffer frame_block, light_block;
    std::vector<SurfaceBuffers> surfaces;

    Passes(const Gl& gl, const QualitySettings& quality, const Settings& settings)
        : traced(gl, quality, settings.width, settings.height),
          geometry(gl, settings.width, settings.height),
          shading(gl, quality, settings.width, settings.height, geometry),
          floor(gl),
          frame_block(gl),
          light_block(gl) {}
  };
  std::optional<Passes> passes;
  MeanColors colors;
  std::optional<Mirror> mirror;  // made once a floor is glossy
  std::optional<Outlines> outlines;
  std::optional<DataPasses> data;
  image::Layers layers;

  // The picture, and distance and surface of each pixel (`seen`), lowest row first. For layers, also the picture before
  // antialiasing (`unsmoothed`) and with unshadowed floor (`open_floor`). They are members to reuse their memory.
  std::vector<std::uint64_t> rgba, unsmoothed, open_floor;
  std::vector<Seen> seen;

  explicit Impl(const Settings& wanted);
  ~Impl();

  frame::Camera choose_camera(const frame::FrameSnapshot& snapshot);
  void update_surfaces(const frame::FrameSnapshot& snapshot, const View& view);
  void update_floor(const Plan& plan);
  void upload_frame(const Plan& plan);
  Shading::Features features(const Plan& plan) const;
  std::vector<Shading::Material> materials(const Plan& plan) const;
  bool reflects(const Plan& plan) const {
    return quality.mirrors && floor_roughness(plan.lighting.style, plan.floor) < kSubjectMirrorRoughness;
  }
  ReflectedLight reflected_light(const Plan& plan, double heat);
  void blend_translucent_cloth(const Plan& plan, std::span<const char> sheer, const ReflectedLight& light,
                               std::span<const DrawnMesh> opaque, const PixelArea& area);
  Plan plan_of(const frame::FrameSnapshot& snapshot, const frame::Camera& camera, const Vec3& upright) const;
  void draw_sharp(const frame::FrameSnapshot& snapshot, const Plan& plan);
  void draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before);
  void draw_layers(const Plan& plan, const std::optional<EarlierFrame>& earlier);
};

Renderer::Impl::Impl(const Settings& wanted)
    : settings(wanted),
      quality(quality_settings(wanted.quality)),
      context(make_context(wanted.backend, wanted.threads)),
      gl(context->gl()) {
  const CurrentContext current(*context);
  GLint largest = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (settings.width < 1 || settings.height < 1 || settings.width > largest || settings.height > largest)
    throw Error(ExitCode::usage, "--size: expected 1x1 to {}x{} pixels, got {}x{}", largest, largest, settings.width,
                settings.height);
  passes.emplace(gl, quality, settings);
  if (quality.smooth_outlines || settings.layers) outlines.emplace(settings.width, settings.height);
  if (settings.layers) data.emplace(settings.width, settings.height);
  check_errors(gl, "preparing to draw");
}

Renderer::Impl::~Impl() {
  context->make_current();
  mirror.reset();
  passes.reset();
  context->release();
}

/// Updates the buffers to the surfaces of the snapshot: keeps those of known surfaces, creates those of new ones.
void Renderer::Impl::update_surfaces(const frame::FrameSnapshot& snapshot, const View& view) {
  std::size_t cloth_triangles = 0;
  for (const auto& surface : snapshot.surfaces)
    if (surface->kind == frame::ObjectKind::cloth) cloth_triangles += surface->triangles.size();
  std::vector<SurfaceBuffers> next;
  for (std::size_t i = 0; i < snapshot.surfaces.size(); ++i) {
    const auto& surface = snapshot.surfaces[i];
    if (!is_subject(*surface)) continue;
    auto known = std::find_if(passes->surfaces.begin(), passes->surfaces.end(),
                              [&](const SurfaceBuffers& buffers) { return &buffers.surface() == surface.get(); });
    if (known != passes->surfaces.end()) {
      next.push_back(std::move(*known));
      passes->surfaces.erase(known);
    } else {
      // For layers for compositors, cloth is not refined and has no strips, because they show the simulated faces.
      const bool cloth = surface->kind == frame::ObjectKind::cloth;
      const bool free = cloth && !settings.layers;
      next.emplace_back(gl, surface,
                        Detail{.refines = quality.refines && free && cloth_triangles <= kMaxRefinedTriangles,
                               .rims = quality.trims && free && surface->appearance.thickness > 0,
                               .trims = quality.trims && cloth && surface->appearance.thickness > 0,
                               .closures = free});
    }
    next.back().update(snapshot.states[i],
                       rim_width(surface->appearance, snapshot.states[i].positions, view, settings.height));
  }
  passes->surfaces = std::move(next);
}

frame::Camera Renderer::Impl::choose_camera(const frame::FrameSnapshot& snapshot) {
  if (!CameraPath::is_computed(snapshot, settings.camera)) return *find_camera(snapshot, settings.camera);
  if (!path) {
    path.emplace(settings.camera, settings.aspect());
    path->add_frame(snapshot);
    path->compute_cameras();
  }
  return path->at(snapshot);
}

void Renderer::Impl::update_floor(const Plan& plan) {
  if (!plan.floor) return;
  passes->shading.set_floor(*plan.floor, plan.lighting.style.floor_tint);
  const Vec3 center = plan.subjects.center();
  const Vec3 under = center - plan.floor->normal.dot(center - plan.floor->point) * plan.floor->normal;
  const double radius = 0.5 * plan.surroundings.diagonal().norm();
  passes->floor.update(under, plan.floor->normal, kFloorSizeRatio * (radius + (plan.view.eye - under).norm()));
}

void Renderer::Impl::upload_frame(const Plan& plan) {
  const FrameUniform block =
      pack_frame(plan.view, plan.lighting, plan.surroundings, plan.floor, settings.width, settings.height);
  gl.NamedBufferData(passes->frame_block.name(), sizeof(block), &block, GL_STREAM_DRAW);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, passes->frame_block.name());
}

Shading::Features Renderer::Impl::features(const Plan& plan) const {
  return {.lights = light_set(plan.lights),
          .checker = plan.floor && plan.floor->look.checker,
          .tiled = plan.floor && plan.floor->look.paint.texture && !plan.lighting.style.plain,
          .painted = passes->geometry.painted() && !plan.lighting.style.plain,
          .trimmed = passes->geometry.trimmed(),
          .shiny = floor_roughness(plan.lighting.style, plan.floor) < kLampMirrorRoughness,
          .reflecting = reflects(plan),
          .steep = fades_steeply(plan.view, plan.floor, plan.surroundings, settings.height, Shading::kGridCell)};
}

std::vector<Shading::Material> Renderer::Impl::materials(const Plan& plan) const {
  std::vector<Shading::Material> list;
  for (const SurfaceBuffers& surface : passes->surfaces)
    list.push_back(material_of(surface.surface(), plan.lighting.style.plain));
  return list;
}

/// Uploads the light block, and collects the properties of lights and surfaces for tracing rays.
ReflectedLight Renderer::Impl::reflected_light(const Plan& plan, double heat) {
  std::vector<Lamp> lamps;
  LightsUniform block{};
  for (const frame::Light& light : plan.lights) {
    lamps.push_back(make_lamp(light, plan.lighting.exposure.direct));
    block.lights[lamps.size() - 1] = lamps.back().packed;
  }
  gl.NamedBufferData(passes->light_block.name(), sizeof(block), &block, GL_STREAM_DRAW);
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 1, passes->light_block.name());

  std::vector<ReflectingSurface> surfaces;
  const std::vector<Shading::Material> looks = materials(plan);
  for (std::size_t i = 0; i < looks.size(); ++i)
    surfaces.push_back(reflecting_surface(passes->surfaces[i], looks[i].appearance, plan.lighting.style.plain,
                                          heat > 0 && looks[i].has_heat, colors));  // heat colours reflect no light
  Eigen::Vector3f floor_color = Eigen::Vector3f::Zero();
  if (plan.floor)
    floor_color = (plan.lighting.style.floor_tint * image::linear_from_srgb(plan.floor->look.color)).cast<float>();
  return ReflectedLight(passes->rays, std::move(surfaces), std::move(lamps), irradiance_of(plan.lighting.around),
                        plan.floor, floor_color, plan.surroundings.diagonal().norm());
}

/// Draws one picture without blur: draws the geometry buffer, traces light, computes colours, antialiases outlines.
void Renderer::Impl::draw_sharp(const frame::FrameSnapshot& snapshot, const Plan& plan) {
  update_surfaces(snapshot, plan.view);
  update_floor(plan);
  gl.Disable(GL_DITHER);
  std::vector<DrawnMesh> meshes;
  std::deque<Holes> holes;
  std::vector<char> sheer;  // per surface: 1 if it is translucent; empty if none is
  for (const SurfaceBuffers& surface : passes->surfaces) {
    meshes.push_back({surface.positions(), surface.triangles()});
    const double opacity = quality.trims && !plan.lighting.style.plain ? opacity_of(surface.surface()) : 1;
    if (opacity < 1) {
      meshes.back().opacity = static_cast<float>(opacity);
      sheer.resize(passes->surfaces.size(), 0);
      sheer[meshes.size() - 1] = 1;
    }
    if (surface.painted() == nullptr) continue;
    holes.emplace_back(*surface.painted(), passes->geometry.opacity_of(*surface.painted()));
    if (holes.back().any()) meshes.back().holes = &holes.back();
  }
  std::vector<DrawnMesh> opaque = meshes;
  for (std::size_t i = 0; i < sheer.size(); ++i)
    if (sheer[i] != 0) opaque[i] = {};
  const FloorBuffers* floor = plan.floor ? &passes->floor : nullptr;

  passes->rays.build(meshes);
  const double heat = heat_scale(snapshot, plan.stage);
  const ReflectedLight light = reflected_light(plan, heat);
  const std::vector<TracedLight::Surface> traced = traced_surfaces(materials(plan));
  if (reflects(plan)) {
    if (!mirror) mirror.emplace(gl, quality, settings.width, settings.height);
    const View view = mirror_view(plan.view, *plan.floor);
    const FrameUniform block =
        pack_frame(view, plan.lighting, plan.surroundings, plan.floor, mirror->width(), mirror->height());
    const std::vector<Shading::Material> looks = materials(plan);
    mirror->draw(view, block, {passes->surfaces, looks, traced, light, heat, !plan.lighting.style.plain},
                 light_set(plan.lights));
  }
  upload_frame(plan);
  passes->geometry.draw(passes->surfaces, sheer, floor, plan.view.eye, plan.view.far);
  passes->geometry.read_seen(seen);
  passes->traced.draw(light, passes->geometry, seen, traced, plan.view, plan.floor);
  std::vector<Vec3> drawn;
  for (const DrawnMesh& mesh : meshes) drawn.insert(drawn.end(), mesh.positions.begin(), mesh.positions.end());
  const PixelArea area = visible_area(plan.view, drawn, settings.width, settings.height);
  passes->shading.draw(materials(plan), heat, features(plan), area, passes->traced.shaded_floor());
  passes->shading.read(rgba);
  if (!outlines && !plan.lighting.style.edges) return;
  if (!sheer.empty()) blend_translucent_cloth(plan, sheer, light, opaque, area);
  if (data) {
    unsmoothed = rgba;
    if (plan.floor && sheer.empty()) {
      passes->shading.draw_open_floor(features(plan));
      passes->shading.read(open_floor);
    } else {
      open_floor.clear();
    }
  }
  if (outlines) outlines->antialias(seen, meshes, plan.floor, plan.view, area, rgba);
  if (plan.lighting.style.edges) draw_edges(passes->surfaces, plan.view, settings.width, settings.height, seen, rgba);
}

/// Blends translucent cloth over the picture of everything else. Depth peeling draws the layers of this cloth, nearest
/// first (Everitt, "Interactive Order-Independent Transparency", 2001). Afterwards, `seen` also contains this cloth.
void Renderer::Impl::blend_translucent_cloth(const Plan& plan, std::span<const char> sheer, const ReflectedLight& light,
                                             std::span<const DrawnMesh> opaque, const PixelArea& area) {
  std::vector<std::uint64_t> behind = rgba;
  outlines->antialias(seen, opaque, plan.floor, plan.view, area, behind);
  const auto of_sheer = [&](const Seen& at) {
    return at.surface >= kFirstSurface && sheer[static_cast<std::size_t>(at.surface) - kFirstSurface] != 0;
  };
  const std::vector<TracedLight::Surface> traced = traced_surfaces(materials(plan));
  struct Layer {
    std::vector<std::uint64_t> rgba;
    std::vector<Seen> seen;
  };
  std::vector<Layer> peeled;
  while (peeled.size() < kMaxPeeledLayers) {
    passes->geometry.draw_layer(passes->surfaces, sheer, !peeled.empty());
    Layer layer;
    passes->geometry.read_seen(layer.seen);
    if (std::ranges::none_of(layer.seen, of_sheer)) break;
    passes->traced.draw(light, passes->geometry, layer.seen, traced, plan.view, plan.floor);
    passes->shading.draw_layer(features(plan), area);
    passes->shading.read(layer.rgba);
    peeled.push_back(std::move(layer));
  }
  if (peeled.empty()) return;
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (!of_sheer(peeled.front().seen[i])) continue;
    Eigen::Vector3f blended = linear_of(behind[i]);
    for (auto layer = peeled.rbegin(); layer != peeled.rend(); ++layer) {
      if (!of_sheer(layer->seen[i])) continue;
      const float opacity = static_cast<float>(layer->rgba[i] >> 48) / 65535.0f;
      blended += opacity * (linear_of(layer->rgba[i]) - blended);
    }
    rgba[i] = encode(blended);
    seen[i] = peeled.front().seen[i];
  }
}

/// Prepares a snapshot for the passes. `upright`: direction that is upright in the picture.
Plan Renderer::Impl::plan_of(const frame::FrameSnapshot& snapshot, const frame::Camera& camera,
                             const Vec3& upright) const {
  Plan plan;
  plan.stage = snapshot.stage ? *snapshot.stage : frame::Stage{};
  plan.stage.look = settings.look.value_or(plan.stage.look);
  plan.stage.heat = heat_shown(snapshot, plan.stage);
  plan.up = up_of(snapshot);
  plan.subjects = subject_bounds(snapshot);
  plan.surroundings = surroundings_bounds(snapshot);
  plan.floor = find_floor(snapshot, plan.up, style_of(plan.stage).plain);
  plan.view = make_view(camera, upright, settings.aspect(), plan.subjects, plan.floor);
  plan.lights = effective_lights(snapshot, plan.stage.look, plan.view.axes, plan.up);
  plan.lighting = make_lighting(plan.stage, plan.up, plan.floor, plan.lights);
  return plan;
}

void Renderer::Impl::draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before) {
  const frame::Camera camera = choose_camera(snapshot);
  const double scene_blur = snapshot.stage ? snapshot.stage->motion_blur : 0;
  const double shutter = before ? settings.motion_blur.value_or(scene_blur) : 0;
  const frame::Camera camera_before = before && (data || shutter > 0) ? choose_camera(*before) : camera;
  const auto view_at = [&](double back, const frame::FrameSnapshot& moved) {
    return make_view(interpolate_cameras(camera, camera_before, back), up_of(moved), settings.aspect(),
                     subject_bounds(moved), find_floor(moved, up_of(moved)));
  };
  // If layers are requested, the picture stays sharp: compositing programs blur it by the layers of motion and depth.
  if (data || (shutter <= 0 && camera.aperture <= 0)) {
    const Plan plan = plan_of(snapshot, camera, up_of(snapshot));
    draw_sharp(snapshot, plan);
    if (data) draw_layers(plan, before ? std::optional(EarlierFrame{*before, view_at(1, *before)}) : std::nullopt);
    return;
  }
  const auto snapshot_at = [&](double back) {
    return shutter > 0 ? interpolate_frames(snapshot, *before, back) : snapshot;
  };
  // Without depth of field, draws as few pictures as kMaxMotionPerPicture allows (at most `instants`), and smears each
  // of them along the motion.
  int count = quality.instants;
  const bool smears = camera.aperture <= 0;
  if (smears) {
    const frame::FrameSnapshot opening = snapshot_at(shutter / 360);
    const double motion = longest_motion(opening, view_at(shutter / 360, opening), snapshot, view_at(0, snapshot),
                                         find_floor(snapshot, up_of(snapshot)), settings.width, settings.height);
    count = std::clamp(static_cast<int>(std::ceil(motion / kMaxMotionPerPicture)), 1, quality.instants);
  }
  std::vector<Eigen::Vector3f> sums(static_cast<std::size_t>(settings.width) * settings.height,
                                    Eigen::Vector3f::Zero()),
      sharp(sums.size());
  Smear smear(settings.width, settings.height);
  for (const Instant& instant : make_instants(shutter, camera.aperture > 0, count)) {
    const frame::FrameSnapshot moved = snapshot_at(instant.back);
    const frame::Camera middle = interpolate_cameras(camera, camera_before, instant.back);
    const Vec3 up = up_of(moved);
    // The same direction is upright in the pictures from all points of the lens. If it were `up`, pictures of a camera
    // that looks steeply down would be rotated against each other.
    const Vec3 upright = smears ? up : view_axes(middle.target - middle.position, up).up;
    const Plan plan = plan_of(moved, through_lens(middle, up, instant.lens), upright);
    draw_sharp(moved, plan);
    for (std::size_t i = 0; i < sums.size(); ++i) sharp[i] = linear_of(rgba[i]);
    if (!smears) {
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += sharp[i];
      continue;
    }
    const double half = 0.5 * shutter / 360 / count;
    const frame::FrameSnapshot from = snapshot_at(instant.back + half), to = snapshot_at(instant.back - half);
    smear.add(passes->surfaces, plan.floor, plan.view, from, view_at(instant.back + half, from), to,
              view_at(instant.back - half, to), sharp, sums);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) rgba[i] = encode(Eigen::Vector3f(sums[i] / static_cast<float>(count)));
}

void Renderer::Impl::draw_layers(const Plan& plan, const std::optional<EarlierFrame>& earlier) {
  layers = {settings.width, settings.height, {}};
  std::vector<Eigen::Vector4f> surfaces;
  outlines->extract_surfaces(seen, unsmoothed, surfaces);
  const auto add = [&](const char* name) {
    layers.channels.push_back({name, std::vector<float>(surfaces.size()), true});
  };
  for (const char* name : {"R", "G", "B", "A", "picture.R", "picture.G", "picture.B"}) add(name);
  std::vector<float> shadows;
  if (!open_floor.empty()) {
    shadows = floor_shadows(seen, unsmoothed, open_floor, settings.width, settings.height);
    add("caught.A");
  }
  for (int y = 0; y < settings.height; ++y) {
    for (int x = 0; x < settings.width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * settings.width + x;
      const std::size_t from = static_cast<std::size_t>(settings.height - 1 - y) * settings.width + x;
      const Eigen::Vector3f picture = linear_of(rgba[from]);
      for (int k = 0; k < 4; ++k) layers.channels[k].values[at] = surfaces[from][k];
      for (int k = 0; k < 3; ++k) layers.channels[4 + k].values[at] = picture[k];
      const float covered = surfaces[from].w();
      if (!shadows.empty()) layers.channels[7].values[at] = covered + (1 - covered) * shadows[from];
    }
  }
  data->draw(passes->surfaces, plan.floor, plan.view, earlier, layers);
}

Renderer::Renderer(const Settings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Renderer::~Renderer() = default;

void Renderer::set_camera_path(CameraPath path) {
  impl_->path = std::move(path);
}

image::Image Renderer::draw(const frame::FrameSnapshot& snapshot, const frame::FrameSnapshot* before) {
  check_states(snapshot);
  const WallTimer wall;
  const DrawingTimer cpu;
  const CurrentContext current(*impl_->context);
  if (frame::Cords::has_chains(snapshot)) {
    const frame::FrameSnapshot swept = impl_->cords.sweep(snapshot);
    const std::optional<frame::FrameSnapshot> swept_before =
        before ? std::optional(impl_->cords.sweep(*before)) : std::nullopt;
    impl_->draw(swept, swept_before ? &*swept_before : nullptr);
  } else {
    impl_->draw(snapshot, before);
  }
  image::Image image = to_image(impl_->rgba, impl_->settings.width, impl_->settings.height);
  check_errors(impl_->gl, "drawing");
  impl_->time = {wall.seconds(), cpu.cpu_seconds()};
  return image;
}

image::Layers Renderer::layers() {
  return std::move(impl_->layers);
}

image::Image16 Renderer::image16() {
  return to_image16(impl_->rgba, impl_->settings.width, impl_->settings.height);
}

StageTime Renderer::last_time() const {
  return impl_->time;
}

std::string Renderer::description() const {
  return impl_->context->description();
}

}  // namespace weft::render
