// A made-up scene of two surfaces, one of them moving, with numbers that lossy coding would change.
#pragma once

#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "film/cache/manifest.hpp"
#include "film/frame/frame_snapshot.hpp"
#include "physics/simulation/frame_report.hpp"

namespace weft::cache {

inline constexpr std::uint64_t kSampleHash = 0xfedcba9876543210;

struct Sample {
  std::shared_ptr<const frame::Stage> stage;
  std::vector<std::shared_ptr<const frame::Surface>> surfaces;

  Sample() {
    frame::Stage a_stage;
    a_stage.up = {0, 1, 0};
    a_stage.sky_color = {0.1, 0.2, 0.9};
    a_stage.ground_color = {0.3, 0.2, 0.1};
    a_stage.sky_intensity = 0.7;
    a_stage.heat = frame::Stage::Heat::strain;
    a_stage.heat_max = 0.25;
    stage = std::make_shared<frame::Stage>(a_stage);
    frame::Surface cloth;
    cloth.name = "cloth";
    cloth.triangles = {{0, 1, 2}, {0, 2, 3}};
    cloth.quads = {{0, 1, 2, 3}};
    cloth.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    cloth.crease_angle = 180;
    cloth.run_bounds = Box3(Vec3(-1, -2, 0), Vec3(1, 2, 3.5));
    cloth.appearance.color = {0.1, 0.2, 0.3};
    cloth.appearance.back_color = {0.9, 0.7, 0.5};
    cloth.appearance.roughness = 0.25;
    cloth.appearance.thread_spacing = 1e-3;
    cloth.appearance.finish.threads = Threads::knit;
    const auto picture = std::make_shared<const frame::Texture>(frame::Texture{2, 1, {1, 2, 3, 4, 5, 6, 7, 8}});
    cloth.appearance.paint = {
        picture, {}, frame::Paint::Wrap::once, frame::Paint::Wrap::mirror, frame::Paint::Alpha::over_color};
    cloth.appearance.paint.texture_from_uv << 1, 2, 3, 4, 5, 6;
    cloth.appearance.back_painted = false;
    cloth.appearance.back_paleness = 0.125;
    cloth.parts = {{"front", cloth.appearance}, {"back", {}}};
    cloth.part_of_triangle = {1, 0};
    cloth.passed_through = {0, 1};
    cloth.paint_uv = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}, {Vec2(2, 0), Vec2(3, 1), Vec2(2, 1)}};
    cloth.closures = {{{0, 3}, {1, 2}}, {}};
    cloth.max_closed_gap = 0.006;
    frame::Surface floor;
    floor.name = "floor";
    floor.kind = frame::ObjectKind::obstacle;
    floor.infinite_floor = true;
    floor.visible = false;
    floor.triangles = {{2, 1, 0}};
    floor.appearance.checker = true;
    surfaces = {std::make_shared<frame::Surface>(cloth), std::make_shared<frame::Surface>(floor)};
  }

  frame::SnapshotPtr snapshot(int k) const {
    auto snapshot = std::make_shared<frame::FrameSnapshot>();
    snapshot->frame = k;
    snapshot->time = k / 25.0;
    snapshot->stage = stage;
    snapshot->surfaces = surfaces;
    std::mt19937_64 random(static_cast<std::uint64_t>(k));
    std::uniform_real_distribution<double> uniform(-1, 1);
    frame::SurfaceState cloth, floor;
    for (int i = 0; i < 4; ++i) cloth.positions.emplace_back(uniform(random), uniform(random), uniform(random));
    if (k == 1) cloth.positions[3] = {-0.0, 5e-324, 999'999'999.9999999};
    for (int i = 0; i < 4; ++i) cloth.heat.push_back(static_cast<float>(uniform(random)));
    floor.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    snapshot->states = {cloth, floor};
    frame::Camera camera{"front", {0.1 * k, -3, 1}, {0, 0, 1.0 / 3}, 40};
    camera.kind = frame::Camera::Kind::close;
    camera.subjects = {"cloth", "floor"};
    camera.azimuth = -10.5 * k;
    camera.elevation = 5;
    camera.margin = 0.25;
    camera.smoothing = 0.75;
    camera.shot = 3 * k;
    snapshot->cameras = {camera, frame::Camera{}};
    frame::Light light;
    light.name = "lamp";
    light.kind = frame::Light::Kind::spot;
    light.direction = {0.1, 0.2, -0.3};
    light.position = {1, 2, 3.0 / 7 + k};
    light.target = {0.5, 0.25, 0.125};
    light.cone_angle = 50;
    light.color = {1, 0.9, 0.8};
    light.intensity = 0.6;
    light.softness = 3;
    snapshot->lights = {light};
    return snapshot;
  }

  simulation::FrameReport report(int k) const {
    simulation::FrameReport report;
    report.frame = k;
    report.time = k / 25.0;
    report.simulate = {0.2, 0.1};
    report.collide = {0.04, 0.03};
    report.forces = {0.05, 0.045};
    report.preconditioner = {0.02, 0.015};
    report.linear = {0.06, 0.055};
    report.steps = 10 + k;
    report.rejected_steps = 2;
    report.inexact_steps = 1;
    report.error_estimate = 1e-4;
    report.solver_error = 2e-5;
    report.newton_iterations = 30;
    report.linear_iterations = 300;
    report.proximities = 40;
    report.constraints = 20;
    report.max_strain = 0.01;
    report.kinetic_energy = 0.7;
    report.potential_energy = -0.2;
    report.pin_work = 0.03;
    report.solver_work = -0.004;
    report.min_distance = std::numeric_limits<double>::infinity();
    report.elastic_energy = 1.0 / 3;
    report.pinched_pairs = 2;
    report.stretch_ratio = 1.25;
    report.lagging_particles = 5;
    report.warnings = {"frame 3: 'sheet' has no room", ""};
    return report;
  }

  Manifest manifest() const {
    Manifest manifest;
    manifest.scene = "sample";
    manifest.title = "A \"sample\" for tests: é";
    manifest.scene_hash = kSampleHash;
    manifest.fps = 25;
    manifest.frame_count = 10;
    manifest.preroll_frames = 3;
    manifest.width = 640;
    manifest.height = 360;
    manifest.camera = "front";
    manifest.cameras = {"front", ""};
    manifest.weft_version = "0.1.0";
    manifest.cpu_target = "x86-64-v3";
    manifest.program = "0123";
    manifest.objects = {{"cloth", frame::ObjectKind::cloth, 4, 1}, {"floor", frame::ObjectKind::obstacle, 3, 1}};
    return manifest;
  }
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace weft::cache
