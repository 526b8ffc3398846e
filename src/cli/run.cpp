#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "cli/commands.hpp"
#include "cli/event_log.hpp"
#include "cli/failure.hpp"
#include "cli/output_target.hpp"
#include "cli/pipeline.hpp"
#include "cli/run_report.hpp"
#include "cli/scene_input.hpp"
#include "cli/signals.hpp"
#include "cli/stages.hpp"
#include "cli/stats.hpp"
#include "cli/summary.hpp"
#include "cli/system_info.hpp"
#include "core/log.hpp"
#include "core/parallel.hpp"
#include "core/temporary_file.hpp"
#include "core/timer.hpp"
#include "scene/loader.hpp"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

class SimulationSource : public FrameSource {
 public:
  /// `proceed` is asked before each frame of the preroll.
  SimulationSource(const scene::Scene& scene, std::function<bool()> proceed)
      : simulation_(scene), proceed_(std::move(proceed)) {}

  SimulatedFrame next() override {
    if (first_ && !simulation_.run_preroll(proceed_))
      throw Error(ExitCode::interrupted, "interrupted before frame 0; no output");
    const simulation::FrameReport report = first_ ? simulation_.initial_report() : simulation_.advance();
    first_ = false;
    for (const std::string& pinch : report.pinches) log::warn(pinch);
    return {simulation_.snapshot(), report};
  }

  const simulation::Simulation& simulation() const { return simulation_; }

 private:
  simulation::Simulation simulation_;
  std::function<bool()> proceed_;
  bool first_ = true;
};

// One `weft run`, from the options to the exit code.
class Run {
 public:
  explicit Run(const RunOptions& options) : options_(options), log_(options.log_json) {}

  ExitCode execute() {
    prepare();
    const PipelineResult result = run_stages();
    conclude(result);
    publish();
    return report_.exit_code;
  }

 private:
  // Everything that can be refused is refused here, before any work is done.
  void prepare() {
    const double cpu = thread_cpu_seconds();
    set_thread_count(options_.common.threads);
    scene_ = load_scene(options_.common);
    settings_ = render_settings(scene_, options_.common);
    wanted_ = resolve_frames(options_.frames, scene_.frame_count());
    target_ = parse_output(options_.output, scene_.name);
    prepare_output(target_, wanted_, options_.common.overwrite);
    if (!options_.meshes.empty()) prepare_meshes();
    if (!options_.stats.empty()) check_writable(options_.stats);
    report_.setup = {wall_.seconds(), thread_cpu_seconds() - cpu};
    describe();
  }

  void prepare_meshes() const {
    const auto check_object = [&](const std::string& name) {
      for (int frame = wanted_.begin; frame < wanted_.end; frame += wanted_.step) {
        check_absent(mesh_file(options_.meshes, name, frame), options_.common.overwrite);
      }
    };
    for (const scene::Cloth& cloth : scene_.cloths) check_object(cloth.name);
    for (const scene::Obstacle& obstacle : scene_.obstacles) check_object(obstacle.name);
    for (const scene::Character& character : scene_.characters) check_object(character.name);
    check_writable(options_.meshes / "probe.ply");
  }

  void describe() {
    report_.scene = scene_.name;
    report_.scene_file = options_.common.scene.string();
    report_.scene_hash = scene_.hash;
    report_.threads = thread_count();
    report_.width = settings_.width;
    report_.height = settings_.height;
    report_.fps = scene_.time.fps;
    report_.output = target_.text;
    report_.wanted = wanted_;
    log_.write("scene_loaded", {{"scene", scene_.name},
                                {"scene_file", report_.scene_file},
                                {"scene_hash", fmt::format("{:016x}", scene_.hash)},
                                {"frames", scene_.frame_count()},
                                {"fps", scene_.time.fps}});
  }

  PipelineResult run_stages() {
    const int simulated = scene_.preroll_frames() + wanted_.last() + 1;
    Progress progress(options_.common.progress, {simulated, wanted_.count(), wanted_.count()});
    const PipelineParts parts{[&] { return make_source(progress); }, [this] { return make_gl_painter(settings_); },
                              [this](const std::string& gl) { return make_output_writer(gl); }};
    const PipelineObserver observer{
        [&](Stage stage) { progress.advance(stage); },
        [this](const FrameRecord& record) { log_.write("frame_done", frame_json(record)); }};
    return run_pipeline(parts, wanted_, signals_.requested(), observer);
  }

  std::unique_ptr<FrameSource> make_source(Progress& progress) {
    const WallTimer wall;
    const double cpu = thread_cpu_seconds();
    auto source = std::make_unique<SimulationSource>(scene_, [this, &progress] {
      progress.advance(Stage::simulate);
      return !signals_.requested();
    });
    report_.objects = source->simulation().objects();
    report_.particles = source->simulation().particles();
    report_.setup += {wall.seconds(), thread_cpu_seconds() - cpu};
    log_.write("simulation_ready", {{"objects", report_.objects.size()}, {"particles", report_.particles}});
    return source;
  }

  std::unique_ptr<FrameWriter> make_output_writer(const std::string& gl) const {
    return make_writer({target_, wanted_, settings_.width, settings_.height, scene_.time.fps, options_.meshes,
                        describe_pictures(scene_, settings_, gl)});
  }

  void conclude(const PipelineResult& result) {
    report_.frames = result.frames;
    report_.written = result.written;
    report_.gl = result.painter;
    const bool video = target_.kind == OutputTarget::Kind::video;
    // A video that could not be finished holds nothing; pictures are whole one by one.
    if (video && !result.finished_output) {
      report_.written = 0;
      for (FrameRecord& record : report_.frames) record.written = false;
    }
    if (video && result.finished_output) {
      std::error_code error;
      const std::uintmax_t bytes = fs::file_size(target_.file(0), error);
      report_.output_bytes = error ? 0 : bytes;
    }
    if (result.failure) {
      const Failure failure = describe_failure(result.failure);
      end_early(failure.code, failure.text);
    } else if (result.interrupted) {
      end_early(ExitCode::interrupted,
                fmt::format("interrupted after frame {} of {}", report_.frames.size() - 1, wanted_.last()));
    }
  }

  void end_early(ExitCode code, const std::string& reason) {
    report_.exit_code = code;
    const std::string text = code == ExitCode::simulation_failed ? "the simulation failed: " + reason : reason;
    const char* plural = report_.written == 1 ? " is" : "s are";
    report_.message = report_.written > 0
                          ? fmt::format("{}; {} frame{} kept in {}", text, report_.written, plural, report_.output)
                          : fmt::format("{}; no frame was written", text);
  }

  // Side files first: what they cannot take must show in the exit code. The message comes last, where it is seen.
  void publish() {
    report_.warnings = log::warnings();
    for (std::string& warning : find_warnings(report_.frames)) report_.warnings.push_back(std::move(warning));
    report_.wall_s = wall_.seconds();
    report_.cpu_s = process_cpu_seconds();
    report_.peak_memory = peak_memory_bytes();
    try_side_file([this] {
      if (report_.written > 0) write_file(effective_scene_file(), scene::effective_scene(scene_));
    });
    try_side_file([this] {
      if (!options_.stats.empty()) write_file(options_.stats, stats_json(report_).dump(2) + "\n");
    });
    log_.write("finished", {{"exit_code", static_cast<int>(report_.exit_code)},
                            {"message", report_.message},
                            {"output", report_.output},
                            {"frames_written", report_.written},
                            {"frames_simulated", report_.frames.size()},
                            {"wall_s", report_.wall_s},
                            {"cpu_s", report_.cpu_s}});
    try_side_file([this] { log_.check(); });
    if (!report_.frames.empty()) log::info(summary(report_));
    if (!report_.message.empty()) log::info("weft: " + report_.message);
  }

  template <class Write>
  void try_side_file(const Write& write) {
    try {
      write();
    } catch (...) {
      const Failure failure = describe_failure(std::current_exception());
      log::info("weft: " + failure.text);
      if (report_.exit_code == ExitCode::ok) report_.exit_code = failure.code;
    }
  }

  // Beside the output: the checked scene with every default filled in. A video's has its name, since a folder may hold
  // several of one scene.
  fs::path effective_scene_file() const {
    const fs::path file = target_.file(wanted_.begin);
    const bool video = target_.kind == OutputTarget::Kind::video;
    return file.parent_path() / ((video ? file.stem().string() : scene_.name) + ".effective.toml");
  }

  const RunOptions& options_;
  const WallTimer wall_;
  const StopSignals signals_;
  EventLog log_;
  scene::Scene scene_;
  render::Settings settings_;
  FrameRange wanted_;
  OutputTarget target_;
  RunReport report_;
};

}  // namespace

ExitCode run(const RunOptions& options) {
  return Run(options).execute();
}

}  // namespace weft::cli
