#include "tools/cli/stills.hpp"

#include <numeric>
#include <optional>

#include "core/error.hpp"
#include "film/cache/reader.hpp"
#include "film/production/scene_simulation.hpp"
#include "tools/cli/cached_frames.hpp"
#include "tools/cli/scene_input.hpp"

namespace weft::cli {
namespace {

/// Simulates the requested frames; each frame needs all earlier ones.
class SceneStills : public Stills {
 public:
  explicit SceneStills(const SceneOptions& options) : input_(load_scene(options)) {
    settings_ = render_settings(input_, options);
    scene_ = manifest_of(input_, settings_);
    frames_.resize(static_cast<std::size_t>(input_.frame_count()));
    std::iota(frames_.begin(), frames_.end(), 0);
  }

  void add_inputs(PathLedger& paths) const override { cli::add_inputs(paths, input_); }
  int cost(int last) const override { return input_.preroll_frames() + last + 1; }
  std::string camera_frames() const override {
    if (!camera_ || frame_ == frames_.back()) return "";
    return frames_text({frames_.begin(), frames_.begin() + frame_ + 1});
  }

  frame::SnapshotPtr at(int frame, Progress& progress) override {
    if (!simulation_) start(progress);
    for (; frame_ < frame; ++frame_) {
      check_signals();
      simulation_->advance();
      progress.advance(Stage::simulate);
      show(*simulation_->snapshot());
    }
    return simulation_->snapshot();
  }

 private:
  void start(Progress& progress) {
    simulation_.emplace(input_);
    const auto proceed = [&] {
      progress.advance(Stage::simulate);
      check_signals();
      return true;
    };
    simulation_->run_preroll(proceed);
    progress.advance(Stage::simulate);
    show(*simulation_->snapshot());
  }

  void check_signals() const {
    if (signals_.requested()) throw Error(ExitCode::interrupted, "interrupted at frame {}; no picture", frame_);
  }

  const scene::Scene input_;
  std::optional<production::SceneSimulation> simulation_;
  int frame_ = 0;  // current frame of the simulation
};

class CacheStills : public Stills {
 public:
  explicit CacheStills(const SceneOptions& options) : reader_(options.scene) {
    if (!options.overrides.empty() || options.fps)
      throw Error(ExitCode::usage, "--set, --fps: expected a scene, got the cache {}, which is simulated already",
                  options.scene.string());
    scene_ = reader_.manifest();
    if (!options.camera.empty()) check_camera(scene_.cameras, options.camera);
    settings_ = render_settings({scene_.width, scene_.height}, scene_.camera, options);
    frames_ = reader_.frames();
    if (frames_.empty()) throw Error(ExitCode::asset_unreadable, "{}: holds no frame yet", options.scene.string());
  }

  void add_inputs(PathLedger& paths) const override { paths.reads_folder(reader_.folder(), "the cache"); }
  int cost(int) const override { return 0; }
  std::string camera_frames() const override { return camera_frames_; }
  frame::SnapshotPtr at(int frame, Progress&) override {
    if (signals_.requested()) throw Error(ExitCode::interrupted, "interrupted at frame {}; no picture", frame);
    frame::SnapshotPtr snapshot = reader_.snapshot(frame);
    if (!camera_ && render::CameraPath::is_computed(*snapshot, settings_.camera))
      camera_frames_ = show_frames(reader_, camera_.emplace(settings_.camera, settings_.aspect()));
    return snapshot;
  }

 private:
  const cache::Reader reader_;
  std::string camera_frames_;
};

}  // namespace

void Stills::show(const frame::FrameSnapshot& snapshot) {
  if (!render::CameraPath::is_computed(snapshot, settings_.camera)) return;
  if (!camera_) camera_.emplace(settings_.camera, settings_.aspect());
  camera_->add_frame(snapshot);
}

render::CameraPath Stills::camera() {
  if (!camera_) return {settings_.camera, settings_.aspect()};
  camera_->compute_cameras();
  return *camera_;
}

void Stills::set_size(const PictureSize& size) {
  settings_.width = size.width;
  settings_.height = size.height;
}

std::unique_ptr<Stills> open_stills(const SceneOptions& options) {
  if (std::filesystem::is_directory(options.scene)) return std::make_unique<CacheStills>(options);
  return std::make_unique<SceneStills>(options);
}

std::filesystem::path still_file(const Stills& stills, const std::filesystem::path& output,
                                 const std::string& default_name, bool overwrite) {
  auto file = output.empty() ? std::filesystem::path("output") / default_name : output;
  if (file.extension() != ".png")
    throw Error(ExitCode::usage, "-o: expected a name ending in .png, got {}", file.string());
  PathLedger paths;
  stills.add_inputs(paths);
  paths.writes("-o", file);
  paths.check_absent(overwrite);
  paths.check_writable();
  return file;
}

}  // namespace weft::cli
