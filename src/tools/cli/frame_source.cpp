#include "tools/cli/frame_source.hpp"

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "core/log.hpp"
#include "tools/cli/enclosed.hpp"

namespace weft::cli {
namespace {

/// Whether the angle of a camera depends on the size of the picture, which the hash of the scene does not contain.
bool has_lens(const scene::Scene& scene) {
  return std::ranges::any_of(scene.cameras,
                             [](const scene::Camera& camera) { return scene::has_focal_length(camera); });
}

bool has_same_lenses(const frame::FrameSnapshot& a, const frame::FrameSnapshot& b) {
  return std::ranges::equal(a.cameras, b.cameras, [](const frame::Camera& one, const frame::Camera& other) {
    return one.field_of_view == other.field_of_view && one.aperture == other.aperture;
  });
}

}  // namespace

SceneSource::SceneSource(const scene::Scene& scene, Store& store, const std::atomic<bool>& stop, Progress& progress)
    : scene_(scene), store_(store), stop_(stop), progress_(progress) {
  if (!store.resumes()) {
    prepare_simulation();
    store.open(simulation_->objects());
  } else {
    store.open(store.earlier().manifest().objects);
  }
}

MadeFrame SceneSource::next() {
  MadeFrame frame = store_.resumes() && next_ <= store_.start().frame ? read_stored() : simulate();
  ++next_;
  return frame;
}

MadeFrame SceneSource::read_stored() {
  cache::CachedFrame cached = store_.earlier().read(next_);
  bool needs_storing = cached.scene_hash != scene_.hash;
  if (needs_storing || has_lens(scene_)) {
    if (!simulation_) prepare_simulation();
    frame::SnapshotPtr now = simulation_->with_looks(*cached.snapshot);
    needs_storing = needs_storing || !has_same_lenses(*now, *cached.snapshot);
    if (needs_storing) cached.snapshot = std::move(now);
  }
  return {std::move(cached.snapshot), std::move(cached.report), needs_storing};
}

MadeFrame SceneSource::simulate() {
  if (!simulation_) prepare_simulation();
  simulation::FrameReport report;
  if (next_ == 0) {
    run_preroll();
    report = simulation_->initial_report();
    for (const std::string& warning : find_enclosed(scene_, *simulation_->snapshot())) log::warn(warning);
  } else {
    report = simulation_->advance();
  }
  return {simulation_->snapshot(), std::move(report), true, simulation_.get()};
}

void SceneSource::prepare_simulation() {
  simulation_ = std::make_unique<production::SceneSimulation>(scene_);
  if (!store_.resumes()) return;
  try {
    simulation_->restore(store_.start().bytes);
  } catch (const std::runtime_error& error) {
    throw Error(ExitCode::asset_unreadable, "{}: the state of the solver is broken: {}; omit --resume to start again",
                store_.folder().string(), error.what());
  }
}

void SceneSource::run_preroll() {
  int frame = store_.resumes() ? store_.start().frame : -scene_.preroll_frames();
  const bool whole = simulation_->run_preroll([&] {
    if (frame > -scene_.preroll_frames()) store_.save_if_cheap(*simulation_, frame);
    progress_.advance(Stage::simulate);
    // After a stop request, saves the state, so that --resume can continue although there is no frame yet.
    if (stop_) store_.save(*simulation_, frame);
    ++frame;
    return !stop_;
  });
  if (!whole) throw Error(ExitCode::interrupted, "interrupted before frame 0");
}

MadeFrame CacheSource::next() {
  cache::CachedFrame cached = reader_.read(next_);
  next_ += step_;
  return {std::move(cached.snapshot), std::move(cached.report)};
}

}  // namespace weft::cli
