// Sources of the frames of a film: a simulation or a cache.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "core/progress.hpp"
#include "film/cache/reader.hpp"
#include "film/production/scene_simulation.hpp"
#include "film/scene/scene.hpp"
#include "tools/cli/frame_range.hpp"
#include "tools/cli/store.hpp"

namespace weft::cli {

/// Yields frames in order.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Makes or reads the next frame. Throws if it cannot.
  virtual MadeFrame next() = 0;
  virtual std::vector<frame::ObjectInfo> objects() const { return {}; }
  /// Returns a frame that next() does not yield, such as one before the first; null if it is not available.
  virtual frame::SnapshotPtr earlier(int) const { return nullptr; }
};

/// Frames of a scene: first those that the store has from an earlier run, drawn with the scene's current looks
/// (store.hpp); after them, simulated ones.
class SceneSource : public FrameSource {
 public:
  /// Opens `store` for new frames. `stop` interrupts the preroll, the frames before frame 0;
  /// `progress` counts the frames of the preroll.
  SceneSource(const scene::Scene& scene, Store& store, const std::atomic<bool>& stop, Progress& progress);

  MadeFrame next() override;
  std::vector<frame::ObjectInfo> objects() const override { return store_.objects(); }

 private:
  MadeFrame read_stored();
  MadeFrame simulate();
  void prepare_simulation();
  void run_preroll();

  const scene::Scene& scene_;
  Store& store_;
  const std::atomic<bool>& stop_;
  Progress& progress_;
  std::unique_ptr<production::SceneSimulation> simulation_;
  int next_ = 0;
};

/// Selected frames of a cache.
class CacheSource : public FrameSource {
 public:
  CacheSource(const cache::Reader& reader, const FrameRange& frames)
      : reader_(reader), next_(frames.begin), step_(frames.step) {}

  MadeFrame next() override;
  std::vector<frame::ObjectInfo> objects() const override { return reader_.manifest().objects; }
  frame::SnapshotPtr earlier(int frame) const override {
    return reader_.has(frame) ? reader_.snapshot(frame) : nullptr;
  }

 private:
  const cache::Reader& reader_;
  int next_, step_;
};

}  // namespace weft::cli
