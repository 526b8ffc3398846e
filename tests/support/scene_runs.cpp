#include "support/scene_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "film/environment/environment.hpp"
#include "film/scene/loader.hpp"
#include "support/intersections.hpp"

namespace weft::support {
namespace {

scene::Scene checked(scene::LoadResult loaded) {
  if (!loaded.ok()) throw std::invalid_argument(loaded.describe());
  return std::move(loaded.scene);
}

void measure_stretch(MeasuredFrame& frame, const scene::Cloth& cloth, const std::vector<Vec3>& x) {
  if (rectangle_particles(cloth) == 0) {  // no rectangular grid: uses the simulation's value
    frame.max_stretch = std::max(frame.max_stretch, 1 + frame.report.max_strain);
    return;
  }
  const mesh::Grid grid = environment::grid_of(cloth);
  const auto at = [&](int i, int j) -> const Vec3& { return x[grid.index(i, j)]; };
  const auto measure = [&](const Vec3& a, const Vec3& b, double rest) {
    const double stretch = (b - a).norm() / rest;
    if (stretch <= frame.max_stretch) return;
    frame.max_stretch = stretch;
    frame.stretched_at = fmt::format("{} ({:.3f}, {:.3f}, {:.3f})", cloth.name, a.x(), a.y(), a.z());
  };
  for (int j = 0; j < grid.nv; ++j) {
    for (int i = 0; i < grid.nu; ++i) {
      if (i + 1 < grid.nu) measure(at(i, j), at(i + 1, j), grid.du(i));
      if (j + 1 < grid.nv) measure(at(i, j), at(i, j + 1), grid.dv(j));
    }
  }
}

// Snapshots list the cloths first, in the order of the scene.
std::vector<std::vector<Vec3>> cloths_of(const frame::FrameSnapshot& snapshot, std::size_t count) {
  std::vector<std::vector<Vec3>> cloths;
  for (std::size_t c = 0; c < count; ++c) cloths.push_back(snapshot.states[c].positions);
  return cloths;
}

void measure_speeds(MeasuredFrame& frame, const std::vector<std::vector<Vec3>>& before, double fps) {
  double sum_sq = 0;
  std::size_t count = 0;
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    for (std::size_t i = 0; i < frame.cloths[c].size(); ++i, ++count) {
      const double speed = fps * (frame.cloths[c][i] - before[c][i]).norm();
      sum_sq += speed * speed;
      frame.largest_speed = std::max(frame.largest_speed, speed);
    }
  }
  if (count > 0) frame.rms_speed = std::sqrt(sum_sq / static_cast<double>(count));
}

void count_intersections(MeasuredFrame& frame, const frame::FrameSnapshot& snapshot) {
  const auto objects = objects_of(snapshot);
  const Intersections intersections = find_intersections(objects);
  frame.pairs = intersections.pairs.size();
  for (const auto& [a, b, count] : count_by_objects(intersections, objects))
    frame.between += (frame.between.empty() ? "" : ", ") + a + "-" + b + " " + std::to_string(count);
}

}  // namespace

std::vector<MeasuredFrame> run_scene(const scene::Scene& scene, const RunPlan& plan, const EachFrame& each) {
  production::SceneSimulation simulation(scene);
  simulation.run_preroll();
  std::vector<MeasuredFrame> frames;
  const int end = plan.end < 0 ? scene.frame_count() : plan.end;
  for (int k = 0; k < end; ++k) {
    MeasuredFrame frame;
    frame.report = k == 0 ? simulation.initial_report() : simulation.advance();
    const frame::SnapshotPtr snapshot = simulation.snapshot();
    frame.cloths = cloths_of(*snapshot, scene.cloths.size());
    for (std::size_t c = 0; c < frame.cloths.size(); ++c) measure_stretch(frame, scene.cloths[c], frame.cloths[c]);
    if (k > 0) {
      measure_speeds(frame, frames.back().cloths, scene.time.fps);
      if (!plan.keep_positions) frames.back().cloths.clear();
    }
    if (plan.counts_intersections && k >= plan.intersections_from) count_intersections(frame, *snapshot);
    if (each) each(frame);
    frames.push_back(std::move(frame));
  }
  return frames;
}

scene::Scene scene_of(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return checked(scene::load(file, overrides));
}

scene::Scene scene_of_text(const std::string& text, const std::vector<std::string>& overrides) {
  return checked(scene::load_text(text, "test.toml", overrides));
}

}  // namespace weft::support
