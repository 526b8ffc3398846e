#include "cli/stills.hpp"

#include <numeric>
#include <optional>
#include <utility>

#include "cli/output_target.hpp"
#include "cli/scene_input.hpp"
#include "cli/signals.hpp"
#include "core/error.hpp"
#include "simulation/simulation.hpp"

namespace weft::cli {
namespace {

/// Simulates what it is asked for: each frame needs all those before it.
class SceneStills : public Stills {
 public:
  explicit SceneStills(const SceneOptions& options)
      : scene_(load_scene(options)), settings_(render_settings(scene_, options)) {}

  std::string name() const override { return scene_.name; }
  double fps() const override { return scene_.time.fps; }
  std::vector<int> frames() const override {
    std::vector<int> all(static_cast<std::size_t>(scene_.frame_count()));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  render::Settings settings() const override { return settings_; }
  Metadata describe(const std::string& gl) const override { return describe_pictures(scene_, settings_, gl); }
  int cost(int last) const override { return scene_.preroll_frames() + last + 1; }

  frame::SnapshotPtr at(int frame, Progress& progress) override {
    if (!simulation_) start(progress);
    for (; frame_ < frame; ++frame_) {
      if (signals_.requested()) throw Error(ExitCode::interrupted, "interrupted at frame {}; no picture", frame_);
      simulation_->advance();
      progress.advance(Stage::simulate);
    }
    return simulation_->snapshot();
  }

 private:
  void start(Progress& progress) {
    simulation_.emplace(scene_);
    const auto proceed = [&] {
      progress.advance(Stage::simulate);
      return !signals_.requested();
    };
    if (!simulation_->run_preroll(proceed))
      throw Error(ExitCode::interrupted, "interrupted before frame 0; no picture");
    progress.advance(Stage::simulate);
  }

  const StopSignals signals_;
  const scene::Scene scene_;
  const render::Settings settings_;
  std::optional<simulation::Simulation> simulation_;
  int frame_ = 0;  // of the simulation
};

}  // namespace

std::unique_ptr<Stills> open_stills(const SceneOptions& options) {
  return std::make_unique<SceneStills>(options);
}

std::filesystem::path still_file(const std::filesystem::path& output, const std::string& default_name, bool overwrite) {
  const auto file = output.empty() ? std::filesystem::path("output") / default_name : output;
  if (file.extension() != ".png")
    throw Error(ExitCode::usage, "-o: expected a name ending in .png, got {}", file.string());
  check_absent(file, overwrite);
  check_writable(file);
  return file;
}

}  // namespace weft::cli
