#include <optional>
#include <utility>

#include "cache/reader.hpp"
#include "cli/cached_frames.hpp"
#include "cli/commands.hpp"
#include "cli/job.hpp"
#include "cli/scene_input.hpp"
#include "core/log.hpp"

namespace weft::cli {
namespace {

class CacheSource : public FrameSource {
 public:
  CacheSource(const cache::Reader& reader, const FrameRange& frames)
      : reader_(reader), first_frame_(reader.snapshot(0)), next_(frames.begin), step_(frames.step) {}

  SimulatedFrame next() override {
    cache::CachedFrame cached = reader_.read(next_);
    next_ += step_;
    for (const std::string& pinch : cached.report.pinches) log::warn(pinch);
    return {std::move(cached.snapshot), std::move(cached.report)};
  }

  frame::SnapshotPtr first_frame() const override { return first_frame_; }

 private:
  const cache::Reader& reader_;
  const frame::SnapshotPtr first_frame_;
  int next_, step_;
};

// Draws what a cache holds; several processes may, each its own frames.
class Render : public Job {
 public:
  using Job::Job;

 private:
  Plan prepare() override {
    reader_.emplace(options_.common.scene);
    Plan plan;
    plan.scene = reader_->manifest();
    plan.scene_text = reader_->scene_text();
    if (!options_.common.camera.empty()) check_camera(plan.scene.cameras, options_.common.camera);
    plan.settings = render_settings({plan.scene.width, plan.scene.height}, plan.scene.camera, options_.common);
    plan.wanted = cached_frames(*reader_, options_.frames);
    plan.made = plan.wanted;
    plan.target = parse_output(options_.output, plan.scene.scene);
    prepare_output(plan.target, plan.wanted, options_.common.overwrite);
    std::vector<std::string> names;
    for (const frame::ObjectInfo& object : plan.scene.objects) names.push_back(object.name);
    prepare_meshes(names, plan.wanted, options_.common.overwrite);
    return plan;
  }

  std::unique_ptr<FrameSource> make_source(std::function<bool()>) override {
    return std::make_unique<CacheSource>(*reader_, plan().made);
  }
  std::vector<frame::ObjectInfo> objects() const override { return plan().scene.objects; }

  std::optional<cache::Reader> reader_;
};

}  // namespace

ExitCode render(const RenderOptions& options) {
  return Render(options).execute();
}

}  // namespace weft::cli
